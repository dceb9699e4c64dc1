"""Plans of nodes, seen along the axis from outside: slotted drums as they are cut, hubs with their fins."""

import numpy as np

from isomould.arrays import Floats, round_um
from isomould.documents.cut_sheets import part_drawing
from isomould.documents.drawing import CutDrawing, Polyline
from isomould.parts.details.finned import FinnedJoint
from isomould.parts.details.joint import Joint
from isomould.parts.details.slotted import SlottedJoint


def node_plan(mark: str, joint: Joint) -> CutDrawing | None:
    """Draw a node in plan, +x in the direction of arm 1; None for drums that no plan describes."""
    if isinstance(joint, SlottedJoint):
        return part_drawing(mark, *_contour(joint), _bore(joint), f"drum, height {joint.height:.3f}")
    if isinstance(joint, FinnedJoint):
        hub = part_drawing(mark, *_circle(joint.radius), _bore(joint), f"hub, height {joint.height:.3f}")
        return CutDrawing((*hub.entities, *_fins(joint)))
    return None


def _circle(radius: float) -> tuple[Floats, Floats]:
    return np.array([[radius, 0.0], [-radius, 0.0]]), np.ones(2)


def _bore(joint: Joint) -> list[Polyline]:
    points, bulges = _circle(joint.bore / 2)
    return [Polyline("CUT_INNER", points, True, bulges)] if joint.bore else []


def _fins(joint: FinnedJoint) -> list[Polyline]:
    """Where the fins stand around the hub: their outlines from above, for information."""
    arms = zip(joint.forks, joint.fins, joint.arms.azimuth.tolist(), joint.arms.elevation.tolist(), strict=True)
    found = list[Polyline]()
    for fork, fin, azimuth, elevation in arms:
        corners = np.array(fin.corners)
        out = corners[:, 0] * np.cos(elevation) - corners[:, 1] * abs(np.sin(elevation))
        for low, high in ((fork.gap / 2, fork.half), (-fork.half, -fork.gap / 2)):
            foot, end = float(out.min()), float(out.max())
            box = np.array([[foot, low], [end, low], [end, high], [foot, high]])
            found.append(Polyline("INFO", round_um(_turned(box, azimuth)), True))
    return found


def _contour(joint: SlottedJoint) -> tuple[Floats, Floats]:
    """Corners (n, 2) and bulges (n,), counter-clockwise: a slot, the arc to the next one, and so on."""
    arms, widths = joint.arms, joint.slot_widths
    if not len(widths):  # a corner where sills meet and nothing ends
        return _circle(joint.radius)
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
