"""V37d, V38d, V38e: bolts of finned nodes go through members and fins, and keep from edges and from each other."""

from collections.abc import Iterator

import numpy as np
import shapely

from isomould.verify.checks.details import PLACE, Arm, arm_frame, held_arms
from isomould.verify.delivery import Delivery
from isomould.verify.joints import Joint, different_joints
from isomould.verify.read.dxf import Drawing, one_outline
from isomould.verify.read.solid import Solid
from isomould.verify.read.tables import numbers, texts
from isomould.verify.read.text import Json
from isomould.verify.rules import Floats, Measured, NotApplicable, Rule, worst_of

EDGE, PITCH = 1.2, 2.4
"""Of hole diameters, EN 1993-1-8, Table 3.3."""
BOLT = 0.01
"""mm: how far the holes of a member and its fins may be apart."""


def edges(delivery: Delivery) -> Measured:
    """By how much a drilled hole of a fin, an end plate or a member in a fork is too near to an edge or to another."""
    bolted = delivery.design.raw["node"]["detail"] == "finned"
    drawings = delivery.fitting_drawings | (delivery.members if bolted else {})
    off = [(short, mark) for mark, drawing in drawings.items() for short in _short(drawing)]
    return worst_of([short for short, _ in off], [mark for _, mark in off], none="nothing is bolted through a plate")


def _short(drawing: Drawing) -> Iterator[float]:
    """Give what is missing at every hole; nothing of a part that has none."""
    rim = shapely.LinearRing(_rounded(drawing))
    holes = _holes(drawing)
    for k, (x, y, diameter) in enumerate(holes):
        yield EDGE * diameter - float(shapely.distance(shapely.Point(x, y), rim))
        yield from (PITCH * diameter - float(np.hypot(x - u, y - v)) for u, v, _ in holes[:k])


def _rounded(drawing: Drawing) -> Floats:
    """Corners of an outline, and the middles of its arcs."""
    outline = one_outline(drawing)
    here, there, bulge = outline.points, np.roll(outline.points, -1, axis=0), outline.bulges[:, None]
    middles = (here + there) / 2 + bulge / 2 * (there - here)[:, ::-1] * [1.0, -1.0]
    return np.stack([here, middles], axis=1).reshape(-1, 2)


def _holes(drawing: Drawing) -> list[tuple[float, float, float]]:
    """Centres and diameters of what is drilled."""
    circles = [entity for entity in drawing.entities if entity.kind == "CIRCLE" and entity.layer == "DRILL"]
    return [(*circle.points[0][:2], 2 * circle.radius) for circle in circles]


def _asked(delivery: Delivery) -> Json:
    node: Json = delivery.design.raw["node"]
    if node["detail"] != "finned":
        raise NotApplicable(f"nodes are {node['detail']}")
    return node


def bolts(delivery: Delivery) -> Measured:
    """How far the holes of members, where they stand, are off those in the fins of the nodes' solids.

    What a member and a node are allowed to be off their classes is no fault of the holes.
    """
    _asked(delivery)
    ends = delivery.table("member_instances"), delivery.table("node_instances")
    free = dict(zip(texts(ends[0], "location"), numbers(ends[0], "deviation_mm").tolist(), strict=True))
    turned = dict(zip(texts(ends[1], "location"), np.radians(numbers(ends[1], "deviation_deg")).tolist(), strict=True))
    found = [row for joint in different_joints(delivery.mesh, delivery.model) for row in _at(delivery, joint)]
    off = [gap - free[member] - turned[node] * reach for gap, reach, member, node in found]
    return worst_of(off, [f"{member} at {node}" for _, _, member, node in found])


def _at(delivery: Delivery, joint: Joint) -> Iterator[tuple[float, float, str, str]]:
    """Give how far the holes of every member at a node are off, and from the node; members and node by location."""
    marks = {part.mark for part in joint.parts if part.location == joint.location}
    solid = next((delivery.solids[mark] for mark in marks if mark in delivery.solids), None)
    for part in joint.parts:
        if part.mark not in delivery.members or solid is None:
            continue
        for x, y, diameter in _holes(delivery.members[part.mark]):
            centre = part.matrix[:3, :3] @ [x, y, 0.0] + part.matrix[:3, 3]
            away = float(np.linalg.norm(centre))
            if away < _reach(delivery):
                yield _hole_off(solid, centre, part.matrix[:3, 2], diameter / 2), away, part.location, joint.location


def _reach(delivery: Delivery) -> float:
    """How far from a node its own bolts can be, mm."""
    node = delivery.design.raw["node"]
    along = float(node["bolt_distance_mm"]) + float(node["bolt_columns_mm"][-1])
    return float(np.hypot(along, max(node["bolt_levels_mm"]))) + 5.0


def _hole_off(solid: Solid, centre: Floats, axis: Floats, radius: float) -> float:
    """Compare the corners of a solid around an axis with a circle about it; there must be four rims of some corners."""
    arm = solid.vertices - centre
    along = arm @ axis
    away = np.linalg.norm(arm - along[:, None] * axis, axis=1)
    near = away < radius * EDGE
    rims = len(np.unique(np.round(along[near], 1)))
    return float(np.abs(away[near] - radius).max()) if near.sum() >= 64 and rims >= 4 else np.inf


def fins(delivery: Delivery) -> Measured:
    """How far the fins' part files are off the node solids that they are welded into, and their feet off the hub."""
    node, table = _asked(delivery), delivery.table("node_fittings")
    drawings, arms = delivery.fitting_drawings, held_arms(delivery, sills=True)
    rows = zip(texts(table, "mark"), numbers(table, "arm").astype(int).tolist(), texts(table, "fitting"), strict=True)
    off, names = list[float](), list[str]()
    for mark, number, fitting in rows:
        if mark in delivery.solids:
            arm = arms[mark][number - 1]
            off.append(
                max(
                    _fin_off(delivery.solids[mark], drawings[fitting], arm, node),
                    _foot_off(drawings[fitting], arm, node),
                )
            )
            names.append(f"{fitting} on {mark}")
    return worst_of(off, names, none="no solids are delivered")


def _fin_off(solid: Solid, drawing: Drawing, arm: Arm, node: Json) -> float:
    """In the frame of an arm: a fin is drawn for one that rises, and turned over for one that falls."""
    azimuth, elevation, section = arm
    turned = Solid(solid.vertices @ arm_frame(azimuth, elevation), solid.triangles)
    over = np.array([1.0, -1.0 if elevation < 0 else 1.0])
    inner = float(node["fork_gaps_mm"][section]) / 2
    levels = [side * level for side in (-1, 1) for level in (inner, inner + float(node["fin_thickness_mm"]))]
    free = _by_distance(drawing)[2:] * over
    corners = [np.array([x, level, y]) for x, y in free for level in levels]
    off = [float(np.linalg.norm(turned.vertices - corner, axis=1).min()) for corner in corners]
    across = np.array([0.0, 1.0, 0.0])
    return max(off + [_hole_off(turned, np.array([x, 0.0, over[1] * y]), across, d / 2) for x, y, d in _holes(drawing)])


def _foot_off(drawing: Drawing, arm: Arm, node: Json) -> float:
    """The inner edge of a fin's foot lies on the hub, over its whole height."""
    _, elevation, section = arm
    hub = float(np.sqrt(float(node["drum_diameter_mm"]) ** 2 - float(node["fork_gaps_mm"][section]) ** 2)) / 2
    foot = _by_distance(drawing)[:2]
    return float(np.abs(foot[:, 0] * np.cos(elevation) - foot[:, 1] * np.sin(abs(elevation)) - hub).max())


def _by_distance(drawing: Drawing) -> Floats:
    """Corners of an outline, the nearest to the work point first."""
    outline = one_outline(drawing).points
    return outline[np.argsort(outline[:, 0])]


RULES = (
    Rule("V37d", "bolt holes keep from edges and from each other", 2e-3, "mm", edges),
    Rule("V38d", "holes of members meet those of the fins", BOLT, "mm", bolts),
    Rule("V38e", "fins' part files fit the node solids", PLACE, "mm", fins),
)
