"""V28: base plates lie where supports stand, parallel to the trimming plane, with the holes that were asked for."""

import numpy as np

from isomould.verify.delivery import Delivery
from isomould.verify.read.dxf import Drawing, one_outline
from isomould.verify.read.tables import half_unit, number, pairs, texts
from isomould.verify.rules import Floats, Measured, NotApplicable, Rule, faults, worst_of

LENGTH = 0.002


def _asked(delivery: Delivery) -> dict[str, float]:
    asked = delivery.design.raw["node"].get("base_plate")
    if asked is None:
        raise NotApplicable("the project asks for no base plates")
    if "support" not in delivery.node_kinds.values():
        raise NotApplicable("the surface has no supports")
    return asked


def places(delivery: Delivery) -> Measured:
    """Corners of every placed plate: how far off the plane parallel to the trim at the scheduled level."""
    _asked(delivery)
    mesh, kinds = delivery.mesh, delivery.node_kinds
    nodes = {str(name): k for k, name in enumerate(mesh.node_location) if kinds[str(mesh.node_mark[k])] == "support"}
    plates = {part.location: part for part in delivery.model.parts if part.mark.endswith("-plate")}
    levels = pairs(delivery.table("nodes"), "mark", "base_level_mm")
    off = [_off_level(delivery, nodes[name], part.matrix, levels[part.mark.removesuffix("-plate")], part.mark)
           for name, part in plates.items() if name in nodes]  # fmt: skip
    missing = sorted(nodes.keys() ^ plates.keys())
    reach = max((abs(delivery.model.shapes[part.mark].vertices).max() for part in plates.values()), default=0.0)
    limit = LENGTH + 2 * float(np.radians(delivery.design.raw["tolerances"]["angle_deg"]) * reach)
    return worst_of([*off, *[np.inf] * len(missing)], [*plates, *missing], limit=limit)


def _off_level(delivery: Delivery, node: int, matrix: Floats, level: str, mark: str) -> float:
    """Largest distance of a corner of the plate's top from its plane, under the work point by the level."""
    mesh, planes = delivery.mesh, delivery.design.raw["trim"]
    point = mesh.nodes[node]
    normals, origins = (np.array([plane[key] for plane in planes]) for key in ("normal", "origin"))
    normal = normals[abs(((point - origins) * normals).sum(axis=1)).argmin()]
    corners = delivery.model.shapes[mark].vertices
    top = corners[corners[:, 2] > corners[:, 2].mean()] @ matrix[:3, :3].T + matrix[:3, 3]
    return float(abs((top - point) @ normal + number(level)).max())


def holes(delivery: Delivery) -> Measured:
    """Holes of every base plate: as many and as large as asked for, and as far from the edges and from each other."""
    asked, drawings = _asked(delivery), delivery.node_drawings
    claimed = pairs(delivery.table("nodes"), "mark", "base_holes")
    marks = [mark for mark, kind in delivery.node_kinds.items() if kind == "support"]
    problems = [
        f"{mark}: {fault}"
        for mark in marks
        for fault in (_hole_faults(drawings[mark], asked, claimed[mark]) if mark in drawings else ["no part file"])
    ]
    return faults(len(marks), problems)


def _hole_faults(plate: Drawing, asked: dict[str, float], claimed: str) -> list[str]:
    circles = [entity for entity in plate.entities if entity.layer == "DRILL"]
    centres = np.array([entity.points[0][:2] for entity in circles]).reshape(-1, 2)
    low, high = one_outline(plate).points.min(axis=0), one_outline(plate).points.max(axis=0)
    edges = np.minimum(centres - low, high - centres)
    apart = np.linalg.norm(centres[:, None] - centres, axis=2) + np.eye(len(centres)) * 1e9
    count, diameter = int(asked["holes"]), float(asked["hole_diameter_mm"])
    found = {
        f"{len(circles)} holes, {claimed} in the schedule, {count} asked for": not len(circles)
        == count
        == number(claimed),
        "a hole of another diameter": any(abs(2 * entity.radius - diameter) > LENGTH for entity in circles),
        "a hole too near to an edge": bool((edges < float(asked["edge_distance_mm"]) - LENGTH).any()),
        "holes too near to each other": bool((apart < 2.4 * diameter - LENGTH).any()),
    }
    return [fault for fault, present in found.items() if present]


def sizes(delivery: Delivery) -> Measured:
    """Length and width of the plates' part files against the schedule."""
    _asked(delivery)
    table, drawings = delivery.table("nodes"), delivery.node_drawings
    off, names = list[float](), list[str]()
    for axis, column in enumerate(("base_length_mm", "base_width_mm")):
        for mark, claimed in zip(texts(table, "mark"), texts(table, column), strict=True):
            if claimed:
                extent = float(np.ptp(one_outline(drawings[mark]).points[:, axis]))
                off.append(abs(extent - number(claimed)))
                names.append(f"{mark} {column}")
    return worst_of(off, names)


RULES = (
    Rule("V28", "base plates lie parallel to the trim under their supports", LENGTH, "mm", places),
    Rule("V28b", "base plates have the holes asked for", 0, "faults", holes),
    Rule("V28c", "sizes of base plates = schedule", half_unit("length_mm"), "mm", sizes),
)
