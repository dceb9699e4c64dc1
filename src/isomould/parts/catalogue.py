"""Sections of members, and the catalogue in which they are found by their designation (fabrication)."""

import csv
import difflib
import math
import re
from functools import cache
from pathlib import Path
from typing import Annotated, Literal, Self

from pydantic import BeforeValidator, Field, model_validator

from isomould.settings import Settings
from isomould.units import NonNegativeLength, PositiveLength

CATALOGUE = Path(__file__).with_name("sections.csv")
"""One section a line; `area_cm2` and `mass_kg_m` are for readers, parts are weighed by their exact area."""


class PlateSection(Settings):
    """A plate on edge: `depth` in the plane of the member, `thickness` across it."""

    kind: Literal["plate"] = "plate"
    depth: PositiveLength
    thickness: PositiveLength

    @property
    def name(self) -> str:
        """Designation in schedules, as shops write flat bars.

        >>> PlateSection(depth=200, thickness=12).name
        'FL200*12'
        """
        return f"FL{self.depth:g}*{self.thickness:g}"

    @property
    def width(self) -> float:
        """Extent across the member's plane, mm."""
        return self.thickness

    @property
    def area(self) -> float:
        """Area of the cross-section, mm²."""
        return self.depth * self.thickness

    @property
    def girth(self) -> float:
        """Length of the outer contour of the cross-section, mm."""
        return 2 * (self.depth + self.thickness)


class RhsSection(Settings):
    """A square or rectangular hollow section: `depth` in the plane of the member, `width` across it.

    Corner radii that are not given are those of EN 10219-2 (cold-formed), by the wall T: outside 2 T up to 6 mm,
    2.5 T up to 10 mm, 3 T beyond; inside T less.
    """

    kind: Literal["rhs"] = "rhs"
    depth: PositiveLength
    width: PositiveLength
    wall: PositiveLength
    outer_radius: NonNegativeLength | None = None
    inner_radius: NonNegativeLength | None = None

    @model_validator(mode="after")
    def _fits(self) -> Self:
        outer, inner = self.radii
        least = 2 * max(outer, self.wall + inner)
        if min(self.depth, self.width) <= least:
            message = f"walls and corners of {self.wall:g} mm need a depth and a width of more than {least:g} mm"
            raise ValueError(message)
        return self

    @property
    def name(self) -> str:
        """Designation in schedules.

        >>> RhsSection(depth=100, width=50, wall=4).name, RhsSection(depth=80, width=80, wall=5).name
        ('RHS100*50*4', 'SHS80*80*5')
        """
        return f"{'SHS' if self.depth == self.width else 'RHS'}{self.depth:g}*{self.width:g}*{self.wall:g}"

    @property
    def radii(self) -> tuple[float, float]:
        """Outer and inner corner radius, mm."""
        steps = ((6.0, 2.0), (10.0, 2.5), (math.inf, 3.0))
        factor = next(factor for limit, factor in steps if self.wall <= limit)
        outer, inner = factor * self.wall, (factor - 1) * self.wall
        given = self.outer_radius, self.inner_radius
        return outer if given[0] is None else given[0], inner if given[1] is None else given[1]

    @property
    def area(self) -> float:
        """Area of the cross-section, mm².

        >>> print(f"{RhsSection(depth=100, width=50, wall=4).area * 7850e-6:.2f} kg/m")
        8.59 kg/m
        """
        return _rounded_box(self.depth, self.width, self.radii[0]) - self.void

    @property
    def void(self) -> float:
        """Area of the hole in the cross-section, mm²."""
        return _rounded_box(self.depth - 2 * self.wall, self.width - 2 * self.wall, self.radii[1])

    @property
    def girth(self) -> float:
        """Length of the outer contour of the cross-section, mm."""
        return 2 * (self.depth + self.width) - (8 - 2 * math.pi) * self.radii[0]


def _rounded_box(a: float, b: float, radius: float) -> float:
    return a * b - (4 - math.pi) * radius**2


AnySection = PlateSection | RhsSection


def find_section(designation: str) -> AnySection:
    """Look a section up in the catalogue: exactly, never the nearest.

    Spaces, lower case and `x` or `×` in the place of `*` do not matter.

    Raises
    ------
    ValueError
        If the catalogue has no such section; names the nearest ones.

    Examples
    --------
    >>> find_section("RHS 100 x 50 x 4").area > find_section("FL100*10").area
    True
    """
    name = _canonical(designation)
    if name not in catalogue():
        near = ", ".join(difflib.get_close_matches(name, catalogue(), 4, 0.6)) or "FL200*12, RHS100*50*4"
        message = (
            f"{designation!r} is not in the catalogue; one of it, the nearest are {near}, or a table of dimensions"
        )
        raise ValueError(message)
    return catalogue()[name]


def _canonical(designation: str) -> str:
    """Write a designation as the catalogue does."""
    text = re.sub(r"[X×]", "*", re.sub(r"\s", "", designation.upper()))
    return re.sub(r"\d+(\.\d+)?", lambda number: f"{float(number[0]):g}", text)


@cache
def catalogue() -> dict[str, AnySection]:
    """Give all sections of the catalogue by name."""
    with CATALOGUE.open(encoding="utf-8", newline="") as file:
        sections = [_section(row) for row in csv.DictReader(file)]
    return {section.name: section for section in sections}


def _section(row: dict[str, str]) -> AnySection:
    depth, width = float(row["depth_mm"]), float(row["width_mm"])
    if row["kind"] == "plate":
        return PlateSection(depth=depth, thickness=width)
    wall, outer, inner = (float(row[f"{key}_mm"]) for key in ("wall", "outer_radius", "inner_radius"))
    return RhsSection(depth=depth, width=width, wall=wall, outer_radius=outer, inner_radius=inner)


def _by_name(value: object) -> object:
    return find_section(value) if isinstance(value, str) else value


Section = Annotated[Annotated[AnySection, Field(discriminator="kind")], BeforeValidator(_by_name)]
"""A section in the project file: a table with its dimensions, or its designation in the catalogue."""
