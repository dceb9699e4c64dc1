"""V39: caps, end plates, fins and hardware are as many as nodes and members need, and weigh what they should."""

import numpy as np

from isomould.verify.checks.solids import components, genus, leaks, volume
from isomould.verify.delivery import Delivery
from isomould.verify.read.dxf import net_area
from isomould.verify.read.solid import read_3mf
from isomould.verify.read.tables import half_unit, number, numbers, pairs, texts
from isomould.verify.rules import Measured, NotApplicable, Rule, faults, worst_of


def _need_fittings(delivery: Delivery) -> None:
    if delivery.design.raw["node"].get("retention") == "weld":
        raise NotApplicable("plates are welded: there are no caps and no bolts")


def masses(delivery: Delivery) -> Measured:
    """Mass of caps from their solids, of flat fittings from their outlines and the thickness that the design gives."""
    _need_fittings(delivery)
    table = delivery.table("fittings")
    claimed = dict(zip(texts(table, "mark"), numbers(table, "mass_kg").tolist(), strict=True))
    off = [abs(mass - claimed[mark]) for mark, mass in _own_masses(delivery).items()]
    return worst_of(off, list(_own_masses(delivery)), limit=half_unit("mass_kg") + 1e-9)


def _own_masses(delivery: Delivery) -> dict[str, float]:
    density = float(delivery.design.raw["member"]["density_kg_m3"]) * 1e-9
    caps = {path.stem: volume(read_3mf(path)) for path in delivery.files("fittings", "3mf")}
    drawings, files = delivery.fitting_drawings, texts(delivery.table("fittings"), "file")
    plates = {mark: net_area(drawing) * _thickness(delivery, mark) for mark, drawing in drawings.items()}
    found = {mark: size * density for mark, size in (caps | plates).items()}
    lost = [name for name in files if name.split("/")[-1].split(".")[0] not in found]
    return found | dict.fromkeys(lost, np.inf)


def _thickness(delivery: Delivery, mark: str) -> float:
    """Last number of the size of a fitting, held to the design's end plates and fins."""
    node = delivery.design.raw["node"]
    size = number(pairs(delivery.table("fittings"), "mark", "size")[mark].split("x")[-1])
    known = {float(end["thickness_mm"]) for end in node.get("ends", {}).values()} | {node.get("fin_thickness_mm")}
    return size if size in known else np.nan


def caps(delivery: Delivery) -> Measured:
    """Solids of caps are watertight, of one piece, with one hole."""
    _need_fittings(delivery)
    solids = {path.stem: read_3mf(path) for path in delivery.files("fittings", "3mf")}
    if not solids:
        raise NotApplicable("there are no caps")
    problems = [f"{mark}: {fault}" for mark, solid in solids.items() for fault in leaks(solid)]
    shapes = {mark: (components(solid), genus(solid)) for mark, solid in solids.items()}
    problems += [f"{mark}: components and genus are {shape}" for mark, shape in shapes.items() if shape != (1, 1)]
    return faults(len(solids), problems)


def quantities(delivery: Delivery) -> Measured:
    """Two caps, a bolt, a nut and two washers per node; or what the holes of end plates or of members need."""
    _need_fittings(delivery)
    problems = [fault for check in (_per_node, _per_class, _per_arm) for fault in check(delivery)]
    return faults(delivery.table("hardware").rows, problems)


def _total(delivery: Delivery, item: str) -> float:
    table = delivery.table("hardware")
    chosen = np.array([name == item for name in texts(table, "item")])
    return float((numbers(table, "quantity") * numbers(table, "pieces"))[chosen].sum())


def _per_node(delivery: Delivery) -> list[str]:
    """Compare what is bought and made in all with nodes and members."""
    needs = {"slotted": _from_caps, "faceted": _from_plates, "finned": _from_forks}
    wanted = needs[delivery.design.raw["node"]["detail"]](delivery)
    fittings = delivery.table("fittings")
    made = float(numbers(fittings, "quantity").sum())
    found = {"bolt": _total(delivery, "bolt"), "washer": _total(delivery, "washer"), "nut": _total(delivery, "nut")}
    found["fitting"] = made
    return [f"{found[key]:g} of {key}, not {wanted[key]:g}" for key in wanted if found[key] != wanted[key]]


def _from_caps(delivery: Delivery) -> dict[str, float]:
    count = float(delivery.table("node_instances").rows)
    return {"bolt": count, "nut": count, "washer": 2 * count, "fitting": 2 * count}


def _from_plates(delivery: Delivery) -> dict[str, float]:
    """Two end plates per member but sills, a bolt with its washer in each of their holes."""
    table, ends = delivery.table("members"), delivery.design.raw["node"]["ends"]
    rows = zip(texts(table, "section"), texts(table, "family"), numbers(table, "quantity").tolist(), strict=True)
    held = [(section, quantity) for section, family, quantity in rows if family != "sill"]
    bolts = float(sum(2 * quantity * len(ends[section]["bolts_mm"]) for section, quantity in held))
    return {"bolt": bolts, "washer": bolts, "nut": 0.0, "fitting": float(2 * sum(q for _, q in held))}


def _from_forks(delivery: Delivery) -> dict[str, float]:
    """Two fins per end of a member but sills, and a bolt with its nut and two washers in each hole of a member."""
    table = delivery.table("members")
    count, holes = numbers(table, "quantity"), numbers(table, "holes")
    held = np.array([family != "sill" for family in texts(table, "family")])
    bolts = float((count * holes).sum())
    return {"bolt": bolts, "nut": bolts, "washer": 2 * bolts, "fitting": float(4 * count[held].sum())}


def _per_arm(delivery: Delivery) -> list[str]:
    """Compare the fins that the arms of the nodes have with the list of fittings, mark by mark."""
    if delivery.design.raw["node"]["detail"] != "finned":
        return []
    table, nodes = delivery.table("node_fittings"), pairs(delivery.table("nodes"), "mark", "quantity")
    marks, fitted = texts(table, "mark"), texts(table, "fitting")
    pieces, total = numbers(table, "pieces"), numbers(table, "total_pieces")
    wrong = [m for m, q, p, t in zip(marks, texts(table, "quantity"), pieces, total, strict=True)
             if nodes.get(m) != q or p != 2 or number(q) * p != t]  # fmt: skip
    made = pairs(delivery.table("fittings"), "mark", "quantity")
    sums = {mark: float(total[[name == mark for name in fitted]].sum()) for mark in made}
    problems = [f"{mark}: fins of an arm are not those of its nodes" for mark in wrong]
    return problems + [f"{mark}: {made[mark]} made, {count:g} on nodes" for mark, count in sums.items()
                       if number(made[mark]) != count]  # fmt: skip


def _per_class(delivery: Delivery) -> list[str]:
    """Compare the number of nodes of every class, and totals, in the hardware list with the nodes."""
    table, nodes = delivery.table("hardware"), pairs(delivery.table("nodes"), "mark", "quantity")
    rows = zip(*(texts(table, name) for name in ("mark", "quantity", "pieces", "total_pieces")), strict=True)
    return [
        f"{mark}: {quantity} x {pieces} = {total}"
        for mark, quantity, pieces, total in rows
        if nodes.get(mark) != quantity or number(quantity) * number(pieces) != number(total)
    ]


RULES = (
    Rule("V39", "fittings weigh volume × density", half_unit("mass_kg"), "kg", masses),
    Rule("V39b", "caps are watertight, of one piece, with one hole", 0, "faults", caps),
    Rule("V39c", "hardware and fittings are as many as nodes and members need", 0, "faults", quantities),
)
