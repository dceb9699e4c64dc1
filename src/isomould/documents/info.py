"""Who and what a delivery is for: the `[project]` table."""

import datetime
from dataclasses import dataclass
from typing import Annotated

from pydantic import BeforeValidator, Field

from isomould.settings import Name, Settings, Text
from isomould.units import Coordinate, Number


def _drawn_up(value: object) -> object:
    """Numbers are no dates: read as seconds since 1970, they would pass for one."""
    if isinstance(value, int | float):
        message = f"{value!r} is not a date; a day such as 2026-11-02"
        raise ValueError(message)
    return value


class DatumSettings(Settings):
    """The datum of the site: where the project's origin lies in it, and how its x axis is turned there."""

    origin: tuple[Coordinate, Coordinate, Coordinate] = (0.0, 0.0, 0.0)
    """Easting, northing and height of the project's origin."""
    rotation_deg: Number = 0.0
    """From the site's x axis (east) to the project's, counter-clockwise seen from above."""


class ProjectInfo(Settings):
    """The `[project]` table."""

    name: Name
    number: Text = ""
    client: Text = ""
    revision: Text = ""
    author: Text = ""
    logo: Text = ""
    """A PNG file beside the project file."""
    drawing: Text = ""
    """Drawing number of the parts, for the machine files."""
    phase: Text = ""
    datum: DatumSettings = Field(default_factory=DatumSettings)
    date: Annotated[datetime.date | None, BeforeValidator(_drawn_up)] = None


@dataclass(frozen=True)
class Logo:
    """A picture (PNG) and its size in pixels."""

    content: bytes
    width: int
    height: int
