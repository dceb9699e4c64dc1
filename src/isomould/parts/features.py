"""What is worked into a part beside its outline."""

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
