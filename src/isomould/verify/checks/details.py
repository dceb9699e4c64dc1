"""V37, V38: nodes keep their limits, hold their arms where the schedule says, and members fit them."""

from collections.abc import Iterator
from itertools import combinations

import numpy as np
import shapely

from isomould.verify.delivery import Delivery
from isomould.verify.read.dxf import Drawing, one_outline, outlines_on
from isomould.verify.read.solid import Solid
from isomould.verify.read.tables import number, numbers, pairs, texts
from isomould.verify.read.text import Json
from isomould.verify.rules import Floats, Measured, NotApplicable, Rule, worst_of

ROUNDING = 2e-3
"""Sums and differences of numbers that are printed to 0.001 mm."""
PLACE = 5e-3
"""What azimuths and elevations printed to 0.0001° leave open at the rim of a drum, mm."""


def limits(delivery: Delivery) -> Measured:
    """How far a limit of a node is broken, or its margin is not value less required."""
    table = delivery.table("node_limits")
    value, required, margin = (numbers(table, f"{name}_mm") for name in ("value", "required", "margin"))
    short = np.maximum(required - value, abs(value - required - margin))
    names = [f"{mark} {what}" for mark, what in zip(texts(table, "mark"), texts(table, "what"), strict=True)]
    absent = sorted(set(texts(delivery.table("nodes"), "mark")) - set(texts(table, "mark")))
    return worst_of([*short, *([np.inf] * len(absent))], [*names, *absent])


Arm = tuple[float, float, str]
"""Azimuth and elevation (rad) and section of an arm that a node holds."""


def held_arms(delivery: Delivery, *, sills: bool = False) -> dict[str, list[Arm]]:
    """Give the arms that are held, all but sills (or those too), by mark."""
    table = delivery.table("nodes")
    found: dict[str, list[Arm]] = {mark: [] for mark in texts(table, "mark")}
    count = sum(name.startswith("azimuth_") for name in table.columns)
    for k in range(1, count + 1):
        azimuth, elevation = (np.radians(numbers(table, f"{n}_{k}_deg", blank=True)) for n in ("azimuth", "elevation"))
        rows = zip(found, azimuth.tolist(), elevation.tolist(), _words(delivery, k), strict=True)
        for mark, turn, rise, (family, section) in rows:
            if family and (sills or family != "sill"):
                found[mark].append((turn, rise, section))
    return found


def _words(delivery: Delivery, arm: int) -> Iterator[tuple[str, str]]:
    table = delivery.table("nodes")
    return zip(texts(table, f"family_{arm}"), texts(table, f"section_{arm}"), strict=True)


def _asked(delivery: Delivery, detail: str) -> Json:
    node: Json = delivery.design.raw["node"]
    if node["detail"] != detail:
        raise NotApplicable(f"nodes are {node['detail']}")
    return node


def slot_webs(delivery: Delivery) -> Measured:
    """By how much the web between two slots, drawn in the plane, is less than asked for."""
    node = _asked(delivery, "slotted")
    short = {mark: float(node["min_web_mm"]) - _web(delivery, arms) for mark, arms in held_arms(delivery).items()}
    return worst_of(list(short.values()), list(short))


def _web(delivery: Delivery, arms: list[Arm]) -> float:
    node, sections = delivery.design.raw["node"], delivery.design.raw["member"]["sections"]
    floor, rim = float(node["slot_floor_mm"]), float(node["drum_diameter_mm"]) / 2
    slots = list[shapely.Geometry]()
    for azimuth, _, section in arms:
        half = (float(sections[section]["thickness"]) + float(node["slot_clearance_mm"])) / 2
        corners = np.array([[floor, -half, 0.0], [rim, -half, 0.0], [rim, half, 0.0], [floor, half, 0.0]])
        slot = shapely.Polygon((corners @ arm_frame(azimuth, 0.0).T)[:, :2])
        nose = shapely.Point(floor * np.cos(azimuth), floor * np.sin(azimuth)).buffer(half)
        slots.append(shapely.union(slot, nose) if node["slot_end"] == "round" else slot)
    return min((float(shapely.distance(a, b)) for a, b in combinations(slots, 2)), default=np.inf)


def slots(delivery: Delivery) -> Measured:
    """How far corners of a node's solid stand inside a slot or its walls are away from where they should be."""
    _asked(delivery, "slotted")
    arms = held_arms(delivery)
    off = {mark: _slots_off(delivery, solid, arms[mark]) for mark, solid in delivery.solids.items()}
    return worst_of(list(off.values()), list(off), none="no solids are delivered")


def _slots_off(delivery: Delivery, solid: Solid, arms: list[Arm]) -> float:
    node, sections = delivery.design.raw["node"], delivery.design.raw["member"]["sections"]
    off = [
        _slot_off(
            solid.vertices @ arm_frame(azimuth, 0.0),
            float(node["slot_floor_mm"]),
            (float(sections[section]["thickness"]) + float(node["slot_clearance_mm"])) / 2,
        )
        for azimuth, _, section in arms
    ]
    return max(off, default=0.0)


def _slot_off(points: Floats, floor: float, half: float) -> float:
    """Corners (n, 3) in the frame of an arm: none between the walls of its slot, at least four on each of them."""
    ahead = points[points[:, 0] > floor - PLACE]
    inside = float(np.max(half - abs(ahead[:, 1]), initial=0.0, where=ahead[:, 0] > floor + half))
    walls = [np.sort(abs(ahead[:, 1] - side * half))[3] if len(ahead) > 3 else np.inf for side in (1, -1)]
    return max(inside, *map(float, walls))


def arm_frame(azimuth: float, elevation: float) -> Floats:
    """Give the axes of an arm as columns: along, across, along the depth."""
    s, c, up, level = np.sin(azimuth), np.cos(azimuth), np.sin(elevation), np.cos(elevation)
    return np.array([[level * c, level * s, up], [-s, c, 0.0], [-up * c, -up * s, level]]).T


def facets(delivery: Delivery) -> Measured:
    """How far a facet is from its place, or short of the member's end with its border (as a length)."""
    node = _asked(delivery, "faceted")
    distance, arms = float(node["facet_distance_mm"]), held_arms(delivery)
    off, names = list[float](), list[str]()
    for mark, solid in delivery.solids.items():
        for azimuth, elevation, section in arms[mark]:
            points, face = solid.vertices @ arm_frame(azimuth, elevation), _face(delivery, section)
            off.append(_facet_off(points, solid, distance, face))
            names.append(mark)
    return worst_of(off, names, none="no solids are delivered")


def _face(delivery: Delivery, section: str) -> shapely.Geometry:
    """What a facet must cover: the member's end and the border beside it, without the holes."""
    raw = delivery.design.raw
    size, node, end = raw["member"]["sections"][section], raw["node"], raw["node"]["ends"][section]
    x, y = float(size["width"]) / 2 + float(node["border_mm"]), float(size["depth"]) / 2
    holes = [shapely.Point(0.0, level).buffer(float(end["thread_mm"]) / 2 + 0.01, 64) for level in end["bolts_mm"]]
    return shapely.difference(shapely.box(-x, -y, x, y), shapely.union_all(holes))


def _facet_off(points: Floats, solid: Solid, distance: float, face: shapely.Geometry) -> float:
    """Points (n, 3) in the frame of an arm: none beyond the facet, and its triangles cover the face."""
    on = (abs(points[:, 0] - distance) < PLACE)[solid.triangles].all(axis=1)
    plane = shapely.union_all([shapely.Polygon(points[corners, 1:]) for corners in solid.triangles[on]])
    bare = float(shapely.area(shapely.difference(face, shapely.buffer(plane, PLACE))))
    return max(float(points[:, 0].max()) - distance, float(np.sqrt(bare)))


def threaded_holes(delivery: Delivery) -> Measured:
    """By how much two threaded holes of a node, or one and the bore, are nearer than asked for."""
    node = _asked(delivery, "faceted")
    off, names = list[float](), list[str]()
    for mark, arms in held_arms(delivery).items():
        short = [float(node["min_web_mm"]) - clear for clear in _hole_distances(node, arms)]
        off.append(max(short, default=0.0))
        names.append(mark)
    return worst_of(off, names)


def _hole_distances(node: Json, arms: list[Arm]) -> Iterator[float]:
    """Give the clear distances of holes of different arms, from their axes as segments."""
    holes = [[*_segments(node, arm)] for arm in arms]
    for one, other in combinations(holes, 2):
        for (a, radius), (b, second) in ((x, y) for x in one for y in other):
            yield _segment_distance(a, b) - radius - second


def _segments(node: Json, arm: Arm) -> Iterator[tuple[Floats, float]]:
    azimuth, elevation, section = arm
    frame, end, distance = arm_frame(azimuth, elevation), node["ends"][section], float(node["facet_distance_mm"])
    for level in end["bolts_mm"]:
        ends = np.array([[distance - float(end["hole_depth_mm"]), 0.0, level], [distance, 0.0, level]])
        yield ends @ frame.T, float(end["thread_mm"]) / 2


def _segment_distance(a: Floats, b: Floats) -> float:
    """Smallest distance of two segments (2, 3): it lies at an end of one of them, or where their lines are nearest."""
    u, v, w = a[1] - a[0], b[1] - b[0], a[0] - b[0]
    uu, uv, vv, uw, vw = u @ u, u @ v, v @ v, u @ w, v @ w
    ends = [_point_distance(p, b) for p in a] + [_point_distance(p, a) for p in b]
    bent = uu * vv - uv * uv
    if bent > 1e-12 * uu * vv:
        s, t = (uv * vw - vv * uw) / bent, (uu * vw - uv * uw) / bent
        if 0 <= s <= 1 and 0 <= t <= 1:
            ends.append(float(np.linalg.norm(w + s * u - t * v)))
    return min(ends)


def _point_distance(point: Floats, segment: Floats) -> float:
    along = segment[1] - segment[0]
    t = np.clip((point - segment[0]) @ along / (along @ along), 0.0, 1.0)
    return float(np.linalg.norm(point - segment[0] - t * along))


def member_ends(delivery: Delivery) -> Measured:
    """How far the ends of the members' outlines are from what the nodes there hold."""
    table = delivery.table("members")
    measure = {"slotted": _tongue_off, "faceted": _bolted_off, "finned": _forked_off}[
        delivery.design.raw["node"]["detail"]
    ]
    marks = [m for m, family in zip(texts(table, "mark"), texts(table, "family"), strict=True) if family != "sill"]
    off = [measure(delivery, mark, side) for mark in marks for side in ("start", "end")]
    return worst_of(off, [f"{mark} {side}" for mark in marks for side in ("start", "end")])


def _contour(delivery: Delivery, mark: str, side: str) -> Floats:
    """Points (n, 2) of a member's outline with x from the work point at one of its ends."""
    return _from(delivery, mark, side, one_outline(delivery.members[mark]).points)


def _from(delivery: Delivery, mark: str, side: str, points: Floats) -> Floats:
    length = number(pairs(delivery.table("members"), "mark", "system_length_mm")[mark])
    return points if side == "start" else points * [-1.0, 1.0] + [length, 0.0]


def _value(delivery: Delivery, mark: str, column: str) -> float:
    return number(pairs(delivery.table("members"), "mark", column)[mark])


def _tongue_off(delivery: Delivery, mark: str, side: str) -> float:
    """In the half-plane of the node: the plate starts at its place, within the drum's height, clear of lips."""
    node, height = delivery.design.raw["node"], _drum_height(delivery, mark, side)
    plate = _in_node(_contour(delivery, mark, side), np.radians(_value(delivery, mark, f"end_angle_{side}_deg")))
    near = shapely.intersection(plate, shapely.box(0.0, -1e4, float(node["shoulder_mm"]) - PLACE, 1e4))
    left, low, _, high = shapely.bounds(near)
    off = [abs(left - float(node["plate_end_mm"])), high - height / 2, -height / 2 - low]
    return float(max(off + ([_in_lips(near, node["cap"], height / 2)] if node["cap"] else [])))


def _in_node(points: Floats, angle: float) -> shapely.Polygon:
    """Turn an outline into the frame (r, z) of the node; the end cut is upright there."""
    sine, cosine = np.sin(angle), np.cos(angle)
    return shapely.Polygon(points @ np.array([[cosine, -sine], [sine, cosine]]))


def _in_lips(plate: shapely.Geometry, cap: Json, half: float) -> float:
    """How much of the plate (as a length) is where the lips of the caps are, and whether it has no hook behind them."""
    inner, outer, deep = (float(cap[key]) for key in ("lip_inner", "lip_outer", "lip_height"))
    lips = [shapely.box(inner, side * half - deep, outer, side * half + deep) for side in (1, -1)]
    shared = float(sum(shapely.area(shapely.intersection(plate, lip)) for lip in lips))
    hook = shapely.intersection(plate, shapely.box(0.0, half - deep / 2, inner, half))
    return np.inf if shapely.area(hook) == 0 else float(np.sqrt(shared))


def _drum_height(delivery: Delivery, mark: str, side: str) -> float:
    """Height of the drum at one end of a class, as its first instance lies."""
    table = delivery.table("member_instances")
    row = texts(table, "mark").index(mark)
    swapped = texts(table, "turned")[row] in {"end_for_end", "both"}
    location = texts(table, "node_start" if (side == "start") != swapped else "node_end")[row]
    node = pairs(delivery.table("node_instances"), "location", "mark")[location]
    return number(pairs(delivery.table("nodes"), "mark", "drum_height_mm")[node])


def _bolted_off(delivery: Delivery, mark: str, side: str) -> float:
    """A square cut at the facet, and behind its end plate an access hole on every bolt."""
    node, section = delivery.design.raw["node"], pairs(delivery.table("members"), "mark", "section")[mark]
    end, distance = node["ends"][section], float(node["facet_distance_mm"])
    cut = abs(_contour(delivery, mark, side)[:, 0].min() - distance)
    inside = distance + float(end["thickness_mm"])
    holes = [_from(delivery, mark, side, box) for box in _openings(delivery.members[mark])]
    there = [box for box in holes if box[:, 0].min() < inside + 1.0]
    starts = [abs(box[:, 0].min() - inside) for box in there]
    levels = sorted(float(box[:, 1].mean()) for box in there)
    same = len(levels) == len(end["bolts_mm"])
    off = np.abs(np.subtract(levels, sorted(end["bolts_mm"]))).max() if same else np.inf
    return float(max(cut, off, *starts))


def _forked_off(delivery: Delivery, mark: str, side: str) -> float:
    """In the half-plane of the node: the plate ends upright beside the hub; in the plate: the bolts' holes."""
    node, points = delivery.design.raw["node"], _contour(delivery, mark, side)
    plate = _in_node(points, np.radians(_value(delivery, mark, f"end_angle_{side}_deg")))
    cut = np.sort(np.array(plate.exterior.coords)[:-1, 0])[:2]
    holes = [_from(delivery, mark, side, box).mean(axis=0) for box in _openings(delivery.members[mark])]
    wanted = [(float(node["bolt_distance_mm"]) + x, y) for x in node["bolt_columns_mm"] for y in node["bolt_levels_mm"]]
    there = sorted(tuple(hole) for hole in np.round(holes, 6).tolist() if hole[0] < max(wanted)[0] + 1.0)
    off = np.abs(np.subtract(there, sorted(wanted))).max() if len(there) == len(wanted) else np.inf
    return float(max(np.abs(cut - float(node["shoulder_mm"])).max(), off))


def _openings(drawing: Drawing) -> list[Floats]:
    """Corners (2, 2) of the boxes around slots whose round ends stand out along x, and around drilled holes."""
    found = list[Floats]()
    for slot in outlines_on(drawing, "CUT_INNER"):
        low, high = slot.points.min(axis=0), slot.points.max(axis=0)
        round_end = np.array([(high[1] - low[1]) / 2, 0.0])
        found.append(np.array([low - round_end, high + round_end]))
    circles = [e for e in drawing.entities if e.kind == "CIRCLE" and e.layer == "DRILL"]
    return found + [np.array(e.points[0][:2]) + e.radius * np.array([[-1.0, -1.0], [1.0, 1.0]]) for e in circles]


RULES = (
    Rule("V37", "nodes keep their limits", ROUNDING, "mm", limits),
    Rule("V37b", "webs between slots are as asked for", ROUNDING, "mm", slot_webs),
    Rule("V37c", "threaded holes are a web apart", ROUNDING, "mm", threaded_holes),
    Rule("V38", "slots are where the arms are", PLACE, "mm", slots),
    Rule("V38b", "facets are where the arms are, as large as members", PLACE, "mm", facets),
    Rule("V38c", "ends of members fit their nodes", PLACE, "mm", member_ends),
)
