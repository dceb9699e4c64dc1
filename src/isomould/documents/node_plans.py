"""Plans of slotted drums, cut from a plate or milled from a disc: the drum seen along its axis from outside."""

import numpy as np

from isomould.arrays import Floats, round_um
from isomould.documents.cut_sheets import part_drawing
from isomould.documents.drawing import CutDrawing, Polyline
from isomould.parts.drum import Drum
from isomould.parts.nodes import NodeArms


def drum_plan(mark: str, arms: NodeArms, drum: Drum, slot_end: str, height: float) -> CutDrawing:
    """Draw the outline of a drum with its slots and its bore; +x is the direction of arm 1."""
    points, bulges = _contour(arms, drum, slot_end)
    radius = drum.bore / 2
    circle = Polyline("CUT_INNER", np.array([[radius, 0.0], [-radius, 0.0]]), True, np.array([1.0, 1.0]))
    inner = [circle] if radius else []
    return part_drawing(mark, points, bulges, inner, f"drum, height {height:.3f}")


def _contour(arms: NodeArms, drum: Drum, slot_end: str) -> tuple[Floats, Floats]:
    """Corners (n, 2) and bulges (n,), counter-clockwise: a slot, the arc to the next one, and so on."""
    if not len(arms.slotted.azimuth):  # a corner where sills meet and nothing ends
        return np.array([[drum.radius, 0.0], [-drum.radius, 0.0]]), np.ones(2)
    rim = arms.slot_gap - 2 * np.arcsin(drum.slot_width / 2 / drum.radius)
    slots = [_turned(_slot(drum), angle) for angle in arms.slotted.azimuth]
    floor = -1.0 if slot_end == "round" else 0.0
    points, bulges = list[Floats](), list[float]()
    for slot, angle in zip(slots, rim, strict=True):
        halves = 2 if angle > np.pi else 1  # a bulge is of less than a full turn
        points += [slot, *(_turned(slot[-1:], angle / halves) for _ in range(halves - 1))]
        bulges += [0.0, floor, 0.0, *[float(np.tan(angle / halves / 4))] * halves]
    return round_um(np.concatenate(points)), np.array(bulges)


def _slot(drum: Drum) -> Floats:
    """Corners (4, 2) of the slot towards +x: mouth, floor, floor, mouth."""
    half = drum.slot_width / 2
    mouth = np.sqrt(drum.radius**2 - half**2)
    return np.array([[mouth, -half], [drum.slot_floor, -half], [drum.slot_floor, half], [mouth, half]])


def _turned(points: Floats, angle: float) -> Floats:
    c, s = np.cos(angle), np.sin(angle)
    return points @ np.array([[c, s], [-s, c]])
