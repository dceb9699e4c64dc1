"""How a design is to be drawn: known before anything is computed."""

from dataclasses import dataclass
from typing import Literal

SpaceView = Literal["axonometry", "plan", "front", "elevation", "side", "section"]
"""`front` looks along +y ("elevation" is its former name), `side` along -x; `section` is the front half way in."""

View = SpaceView | Literal["developed", "curvature"]
Style = Literal["classes", "building"]


@dataclass(frozen=True)
class Seen:
    """How a design is drawn; the angles are those of axonometries, and None takes the usual ones."""

    view: View = "axonometry"
    style: Style = "classes"
    azimuth_deg: float | None = None
    elevation_deg: float | None = None
