"""Plans of slotted drums, cut from a plate or milled from a disc: the drum seen along its axis from outside."""

import numpy as np

from isomould.arrays import Floats, round_um
from isomould.documents.cut_sheets import part_drawing
from isomould.documents.drawing import CutDrawing, Polyline
from isomould.parts.details.slotted import SlottedJoint


def drum_plan(mark: str, joint: SlottedJoint) -> CutDrawing:
    """Draw the outline of a drum with its slots and its bore; +x is the direction of arm 1."""
    points, bulges = _contour(joint)
    radius = joint.bore / 2
    circle = Polyline("CUT_INNER", np.array([[radius, 0.0], [-radius, 0.0]]), True, np.array([1.0, 1.0]))
    inner = [circle] if radius else []
    return part_drawing(mark, points, bulges, inner, f"drum, height {joint.height:.3f}")


def _contour(joint: SlottedJoint) -> tuple[Floats, Floats]:
    """Corners (n, 2) and bulges (n,), counter-clockwise: a slot, the arc to the next one, and so on."""
    arms, widths = joint.arms, joint.slot_widths
    if not len(widths):  # a corner where sills meet and nothing ends
        return np.array([[joint.radius, 0.0], [-joint.radius, 0.0]]), np.ones(2)
    taken = np.arcsin(widths / 2 / joint.radius)
    rim = arms.held_gap - taken - np.roll(taken, -1)
    slots = [_turned(_slot(joint, w), angle) for w, angle in zip(widths.tolist(), arms.azimuth.tolist(), strict=True)]
    floor = -1.0 if joint.nose else 0.0
    points, bulges = list[Floats](), list[float]()
    for slot, angle in zip(slots, rim, strict=True):
        halves = 2 if angle > np.pi else 1  # a bulge is of less than a full turn
        points += [slot, *(_turned(slot[-1:], angle / halves) for _ in range(halves - 1))]
        bulges += [0.0, floor, 0.0, *[float(np.tan(angle / halves / 4))] * halves]
    return round_um(np.concatenate(points)), np.array(bulges)


def _slot(joint: SlottedJoint, width: float) -> Floats:
    """Corners (4, 2) of the slot towards +x: mouth, floor, floor, mouth."""
    half = width / 2
    mouth = np.sqrt(joint.radius**2 - half**2)
    return np.array([[mouth, -half], [joint.slot_floor, -half], [joint.slot_floor, half], [mouth, half]])


def _turned(points: Floats, angle: float) -> Floats:
    c, s = np.cos(angle), np.sin(angle)
    return points @ np.array([[c, s], [-s, c]])
