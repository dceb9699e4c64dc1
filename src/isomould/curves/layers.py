"""What is said of a layer: what lies on it, and what is drawn there."""

from dataclasses import dataclass
from typing import NamedTuple

from isomould.curves.spatial import Traced
from isomould.errors import Note


@dataclass(frozen=True)
class LayerContent:
    """A layer of a drawing or model."""

    name: str
    kinds: dict[str, int]
    """How many entities of each type the model shows on it, blocks opened."""
    state: str
    """"", "off" or "frozen"."""
    elsewhere: tuple[str, ...]
    """What is on the layer without being in the model: on paper, in blocks that are never inserted."""


class LayerDrawing(NamedTuple):
    """What is drawn on a layer."""

    traced: list[Traced]
    notes: tuple[Note, ...]
    printed: float
    """What the file's printing loses of a coordinate, mm; 0 where it prints more than six digits."""
