"""V20-V23, V25: node solids are sound, weigh what the schedule says, and so do the members."""

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from isomould.verify.delivery import Delivery
from isomould.verify.read.dxf import Drawing, area, net_area, one_outline
from isomould.verify.read.solid import Solid, read_stl
from isomould.verify.read.tables import half_unit, numbers, pairs, texts
from isomould.verify.read.text import Json
from isomould.verify.rules import Floats, Ints, Measured, NotApplicable, Rule, Unreadable, faults, worst_of

RELATIVE = 1e-9


def soundness(delivery: Delivery) -> Measured:
    """Every class has a solid: NoError, one component, the genus of its bore, as recorded and counted."""
    _require_solids(delivery)
    solids, records = delivery.solids, delivery.solid_records
    problems = [f"{mark} has no solid" for mark in _expected(delivery) - solids.keys()]
    problems += [f"{mark} has no record or no solid" for mark in solids.keys() ^ records.keys()]
    for mark in sorted(solids.keys() & records.keys()):
        problems += [f"{mark}: {fault}" for fault in _unsound(delivery, mark)]
    return faults(len(solids), problems)


def _expected(delivery: Delivery) -> set[str]:
    files = pairs(delivery.table("nodes"), "mark", "solid_file")
    return {mark for mark, file in files.items() if file or delivery.node_kinds[mark] != "support"}


def _unsound(delivery: Delivery, mark: str) -> list[str]:
    solid, record = delivery.solids[mark], delivery.solid_records[mark]
    found = {"genus": genus(solid), "components": components(solid)}
    wanted = {"genus": _holes_through(delivery, mark), "components": 1}
    problems = [] if record["status"] == "NoError" else [f"status {record['status']}"]
    for key, value in found.items():
        if not (value == record[key] == wanted[key]):
            problems.append(f"{key} {value}, recorded {record[key]}, expected {wanted[key]}")
    return problems


def _holes_through(delivery: Delivery, mark: str) -> int:
    """Give 1 for a drum with a bore, 0 without, and one more for every hole of a fin, which goes through it."""
    node = delivery.design.raw["node"]
    if node["detail"] == "finned":
        return int(pairs(delivery.table("nodes"), "mark", "holes")[mark])
    return int((node.get("bore_mm") or 0) > 0)


def components(solid: Solid) -> int:
    """Count the connected pieces of the surface."""
    a, b = solid.triangles[:, [0, 1]].ravel(), solid.triangles[:, [1, 2]].ravel()
    size = len(solid.vertices)
    return int(connected_components(coo_array((np.ones(len(a)), (a, b)), shape=(size, size)), directed=False)[0])


def genus(solid: Solid) -> float:
    """Give the number of handles from Euler's formula of a surface of one piece."""
    edges = len(np.unique(np.sort(_sides(solid), axis=1), axis=0))
    return 1 - (len(solid.vertices) - edges + len(solid.triangles)) / 2


def _sides(solid: Solid) -> Ints:
    return np.vstack([solid.triangles[:, [k, (k + 1) % 3]] for k in range(3)])


def recorded(delivery: Delivery, key: str) -> Measured:
    """Give the worst of the maker's relative residuals of one kind."""
    _require_solids(delivery)
    records = delivery.solid_records
    return worst_of([abs(float(record[key])) for record in records.values()], list(records))


def _require_solids(delivery: Delivery) -> None:
    if not delivery.solids and not any(texts(delivery.table("nodes"), "solid_file")):
        raise NotApplicable("the schedule names no solid files: none were to be delivered")


def inclusion_exclusion(delivery: Delivery) -> Measured:
    """Check |vol(A∪B) + vol(A∩B) − vol A − vol B| / vol, from the record."""
    return recorded(delivery, "inclusion_exclusion")


def commutativity(delivery: Delivery) -> Measured:
    """Volume and area of A∪B against B∪A, relative, from the record."""
    return recorded(delivery, "commutativity")


def volumes(delivery: Delivery) -> Measured:
    """Divergence volume of the file against the record and the record's analytic value, relative."""
    off, names = list[float](), list[str]()
    _require_solids(delivery)
    for mark, record in delivery.solid_records.items():
        own = volume(delivery.solids[mark])
        claims = [record[key] for key in ("volume_mm3", "analytic_volume_mm3") if record[key] is not None]
        off.append(max(abs(own - claim) / own for claim in claims) if own > 0 else np.inf)
        names.append(mark)
    return worst_of(off, names)


def volume(solid: Solid) -> float:
    """Give the volume by the divergence theorem, mm³; negative if the surface is inside out."""
    a, b, c = np.moveaxis(solid.vertices[solid.triangles] - solid.vertices.mean(axis=0), 1, 0)
    return float((a * np.cross(b, c)).sum() / 6)


def watertight(delivery: Delivery) -> Measured:
    """Every side of a triangle is run once each way; no triangle is repeated or without area."""
    _require_solids(delivery)
    problems = [f"{mark}: {fault}" for mark, solid in delivery.solids.items() for fault in leaks(solid)]
    return faults(sum(len(solid.triangles) for solid in delivery.solids.values()), problems)


def leaks(solid: Solid) -> list[str]:
    """Name what keeps a surface from being closed, consistently oriented and free of null triangles."""
    sides, times = np.unique(_sides(solid), axis=0, return_counts=True)
    back = np.unique(sides[:, ::-1], axis=0)
    found = {
        "not watertight or not consistently oriented": not (np.array_equal(sides, back) and (times == 1).all()),
        "triangle repeated": len(np.unique(np.sort(solid.triangles, axis=1), axis=0)) < len(solid.triangles),
        "triangle without area": bool((_heights(solid) < 1e-9).any()),
        "vertex used by no triangle": len(np.unique(solid.triangles)) < len(solid.vertices),
    }
    return [fault for fault, present in found.items() if present]


def _heights(solid: Solid) -> Floats:
    """Give the smallest height of every triangle, mm."""
    a, b, c = np.moveaxis(solid.vertices[solid.triangles], 1, 0)
    longest = np.max([np.linalg.norm(side, axis=1) for side in (b - a, c - b, a - c)], axis=0)
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / longest


def stl_twins(delivery: Delivery) -> Measured:
    """Corners of the STL triangles against the 3MF's, relative to the size (STL holds 32-bit floats)."""
    _require_solids(delivery)
    found = {path.stem: read_stl(path) for path in delivery.files("nodes", "stl")}
    off = [_twin_off(delivery.solids[mark], corners) for mark, corners in found.items()]
    return worst_of(off, list(found), none="no STL files are delivered")


def _twin_off(solid: Solid, corners: Floats) -> float:
    own = solid.vertices[solid.triangles]
    return float(abs(own - corners).max() / abs(own).max()) if own.shape == corners.shape else np.inf


def scheduled_volume(delivery: Delivery) -> Measured:
    """Volume of every solid against volume_cm3 of the schedule, at its rounding."""
    _require_solids(delivery)
    claimed = _column(delivery, "nodes", "volume_cm3")
    off = [abs(volume(solid) / 1000 - claimed[mark]) for mark, solid in delivery.solids.items()]
    return worst_of(off, list(delivery.solids), limit=_rounding("volume_cm3"))


def _column(delivery: Delivery, table: str, column: str) -> dict[str, float]:
    found = delivery.table(table)
    return dict(zip(texts(found, "mark"), numbers(found, column).tolist(), strict=True))


def _rounding(column: str) -> float:
    return half_unit(column) * (1 + 1e-9) + 1e-12


def masses(delivery: Delivery) -> Measured:
    """Mass of every class against volume × density: solids of nodes, cut outlines × thickness of members."""
    nodes, members = _column(delivery, "nodes", "mass_kg"), _column(delivery, "members", "mass_kg")
    steel = {mark: volume(solid) + base_volume(delivery, mark) for mark, solid in delivery.solids.items()}
    own = {mark: found * _node_density(delivery) for mark, found in steel.items()}
    density = float(delivery.design.raw["member"]["density_kg_m3"]) * 1e-9
    own |= {mark: member_volume(delivery, mark) * density for mark in members}
    claimed = nodes | members
    off = [abs(mass - claimed[mark]) for mark, mass in own.items()]
    return worst_of(off, list(own), limit=_rounding("mass_kg"))


def base_volume(delivery: Delivery, mark: str) -> float:
    """Steel of the base under a support, from its part files, mm³; 0 for all other nodes."""
    asked, drawings = delivery.design.raw["node"].get("base_plate"), delivery.node_drawings
    if asked is None or delivery.node_kinds[mark] != "support":
        return 0.0
    plates = {mark: asked["thickness_mm"], f"{mark}-stem": asked["stem_thickness_mm"]}
    return sum(net_area(drawings[name]) * float(thickness) for name, thickness in plates.items())


def panel_masses(delivery: Delivery) -> Measured:
    """Mass of every panel class against the area of its part file × thickness × density."""
    panel, claimed = delivery.design.raw["panel"], _column(delivery, "panels", "mass_kg")
    weight = float(panel["thickness_mm"]) * float(panel["density_kg_m3"]) * 1e-9
    off = [abs(net_area(drawing) * weight - claimed[mark]) for mark, drawing in delivery.panels.items()]
    return worst_of(off, list(delivery.panels), limit=_rounding("mass_kg"))


def _node_density(delivery: Delivery) -> float:
    design = delivery.design.raw
    return float(design["node"].get("density_kg_m3", design["member"]["density_kg_m3"])) * 1e-9


def member_volume(delivery: Delivery, mark: str) -> float:
    """Give the volume of a member from its part file, its section and its end plates, mm³."""
    member = delivery.design.raw["member"]
    name = pairs(delivery.table("members"), "mark", "section")[mark]
    section = member["sections"][name]
    if mark not in delivery.members:
        message = f"members/{mark}.dxf is missing"
        raise Unreadable(message)
    measure = _plate_volume if section["kind"] == "plate" else _tube_volume
    return measure(delivery.members[mark], section) + _end_plates(delivery, mark, name)


def _end_plates(delivery: Delivery, mark: str, name: str) -> float:
    """Give the volume of the plates in both ends of a hollow section that is no sill."""
    end = delivery.design.raw["node"].get("ends", {}).get(name)
    if end is None or pairs(delivery.table("members"), "mark", "family")[mark] == "sill":
        return 0.0
    size = delivery.design.raw["member"]["sections"][name]
    depth, width = (float(size[key]) - 2 * float(size["wall"]) for key in ("depth", "width"))
    holes = len(end["bolts_mm"]) * np.pi / 4 * float(end["hole_mm"]) ** 2
    area = depth * width - (4 - np.pi) * float(size["inner_radius"]) ** 2 - holes
    return 2 * float(end["thickness_mm"]) * area


def _plate_volume(drawing: Drawing, section: Json) -> float:
    return net_area(drawing) * float(section["thickness"])


def _tube_volume(drawing: Drawing, section: Json) -> float:
    """Give the volume of a hollow section cut square: walls and corners, less what is cut into its front."""
    face = one_outline(drawing)
    openings = abs(area(face)) - net_area(drawing)
    return _tube_area(section) * float(np.ptp(face.points[:, 0])) - openings * float(section["wall"])


def _tube_area(section: Json) -> float:
    """Give four straight walls and four quarters of a ring, mm²."""
    keys = ("depth", "width", "wall", "outer_radius", "inner_radius")
    depth, width, wall, outer, inner = (float(section[key]) for key in keys)
    full = depth * width - (depth - 2 * wall) * (width - 2 * wall)
    return full - (4 - np.pi) * (outer**2 - inner**2)


RULES = (
    Rule("V20", "node solids: status, one component, genus", 0, "faults", soundness),
    Rule("V21", "unions keep inclusion and exclusion", RELATIVE, "relative", inclusion_exclusion),
    Rule("V22", "unions do not depend on the order", RELATIVE, "relative", commutativity),
    Rule("V23", "node solids are watertight and consistently oriented", 0, "faults", watertight),
    Rule("V23b", "volume of the files = recorded = analytic volume", RELATIVE, "relative", volumes),
    Rule("V23c", "volume of the files = schedule", half_unit("volume_cm3"), "cm³", scheduled_volume),
    Rule("V23d", "STL files show the same triangles", 1e-6, "relative", stl_twins),
    Rule("V25", "scheduled mass = volume × density", half_unit("mass_kg"), "kg", masses),
    Rule("V25b", "panel mass = area × thickness × density", half_unit("mass_kg"), "kg", panel_masses),
)
