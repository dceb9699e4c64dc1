"""What is worked into a part beside its outline."""

import math
from dataclasses import dataclass
from typing import Literal

Face = Literal["front", "back", "top", "bottom"]
"""Faces of a member seen with the start node on the left and the outside up; a plate has its front only."""


@dataclass(frozen=True)
class Hole:
    """A round hole through one wall, or a slot, in the frame of its face. Lengths in mm.

    Attributes
    ----------
    x, y : float
        Centre: x along the part as in its outline, y across the face from its middle line; on the front it is the y of
        the outline, on top and bottom it is positive towards the back.
    diameter : float
    face : Face
    lengthening : float
        Distance along x of the centres of a slot's two round ends; 0 for a round hole.
    thread : str
        Such as `M16` where the hole is tapped; empty for a plain hole.
    """

    x: float
    y: float
    diameter: float
    face: Face = "front"
    lengthening: float = 0.0
    thread: str = ""

    @property
    def area(self) -> float:
        """Area of the opening, mm²."""
        return math.pi / 4 * self.diameter**2 + self.diameter * self.lengthening

    @property
    def perimeter(self) -> float:
        """Length of its contour, mm."""
        return math.pi * self.diameter + 2 * self.lengthening


@dataclass(frozen=True)
class EndPlate:
    """A plate inside the end of a hollow section, flush with its cut. Lengths in mm.

    Attributes
    ----------
    thickness, diameter : float
        Of the plate, and of its bolt holes.
    bolts : tuple of float
        Where they are, on the middle line of the plate: the y of the member's outline.
    """

    thickness: float
    diameter: float
    bolts: tuple[float, ...]

    @property
    def hole_area(self) -> float:
        """Area of all bolt holes, mm²."""
        return len(self.bolts) * math.pi / 4 * self.diameter**2
