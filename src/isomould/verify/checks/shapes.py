"""V60 to V63: the shapes of one project are made of one kit of nodes (geometry §7; paper §3.5)."""

from collections import defaultdict

import numpy as np

from isomould.verify.checks.classes import arms_of, reference_directions
from isomould.verify.delivery import Delivery
from isomould.verify.read.tables import Table, number, pairs, texts
from isomould.verify.rules import Floats, Measured, NotApplicable, Rule, faults, worst_of

MAIN = "main"
NOISE = 1e-9
HALF_DEGREE = 0.5
"""Keeps the azimuth of arm 1 away from the jump between 360° and 0°."""
_PER_SHAPE = ("mark", "quantity", "max_deviation_mm", "max_deviation_deg")
"""Columns of the nodes that a mark may have differently in every shape, and the mark itself; totals apart."""


def _shapes(delivery: Delivery) -> dict[str, Delivery]:
    """Give the deliveries of all shapes by name, the folder's own first."""
    if not delivery.shapes:
        raise NotApplicable("the project has one shape")
    return {MAIN: delivery, **delivery.shapes}


def congruence(delivery: Delivery) -> Measured:
    """Spread (max − min) of azimuths and elevations over all nodes of one mark in all shapes, in degrees."""
    found: dict[str, list[Floats]] = defaultdict(list)
    for shape in _shapes(delivery).values():
        for mark, angles in zip(shape.mesh.node_mark, _angles(shape), strict=True):
            found[str(mark)].append(angles)
    limit = float(delivery.design.raw["tolerances"]["angle_deg"]) + NOISE
    return worst_of([_spread(rows) for rows in found.values()], list(found), limit=limit)


def _angles(delivery: Delivery) -> list[Floats]:
    """Give azimuths from arm 1 and elevations (2 v) of the arms of every node, in degrees."""
    mesh = delivery.mesh
    arms = arms_of(mesh, reference_directions(delivery))
    order = np.lexsort((np.round(arms.azimuth, 6) % (2 * np.pi), arms.owner))
    ends = np.searchsorted(arms.owner[order], np.arange(1, len(mesh.nodes)))
    azimuth, elevation = (np.split(np.degrees(values[order]), ends) for values in (arms.azimuth, arms.elevation))
    return [
        np.concatenate([np.remainder(a - a[:1] + HALF_DEGREE, 360.0), e])
        for a, e in zip(azimuth, elevation, strict=True)
    ]


def _spread(rows: list[Floats]) -> float:
    return float(np.ptp(rows, axis=0).max()) if len({len(row) for row in rows}) == 1 else np.inf


def one_kit(delivery: Delivery) -> Measured:
    """Rows of the schedules and files of the solids: of one mark, the same in all shapes."""
    seen: dict[str, tuple[str, tuple[str, ...]]] = {}
    problems, count = list[str](), 0
    for name, shape in _shapes(delivery).items():
        for mark, row in _descriptions(shape).items():
            other, known = seen.setdefault(mark, (name, row))
            problems += [f"{mark} of {name} is another part than in {other}"] * (row != known)
            count += 1
    return faults(count, problems)


def _descriptions(delivery: Delivery) -> dict[str, tuple[str, ...]]:
    """Give of every mark what its row says of the part, arms that it does not have apart, and its solid's hash."""
    table = delivery.table("nodes")
    own = [name for name in sorted(table.columns) if name not in _PER_SHAPE and not name.startswith("total_")]
    columns = [texts(table, name) for name in own]
    rows = [tuple(cell for cell in row if cell) for row in zip(*columns, strict=True)]
    solids = [delivery.hashes[file][0] for file in texts(table, "solid_file")]
    return {mark: (*row, solid) for mark, row, solid in zip(texts(table, "mark"), rows, solids, strict=True)}


def quantities(delivery: Delivery) -> Measured:
    """The table of the kit counts the nodes of all shapes, and knows which marks all of them have."""
    counted = {name: pairs(shape.table("nodes"), "mark", "quantity") for name, shape in _shapes(delivery).items()}
    kit, problems = delivery.table("kit"), list[str]()
    listed = pairs(kit, "mark", "shared")
    problems += [f"{mark} is missing" for of in counted.values() for mark in of if mark not in listed]
    for mark, shared in listed.items():
        numbers = [number(of.get(mark, "0")) for of in counted.values()]
        claimed = [number(_quantity(kit, name)[mark]) for name in counted]
        total = number(pairs(kit, "mark", "quantity")[mark])
        problems += [f"{mark}: {claimed} in the kit, {numbers} in the shapes"] * (claimed != numbers)
        problems += [f"{mark}: {total:g} in all, not {sum(numbers):g}"] * (total != sum(numbers))
        problems += [f"{mark}: shared is {shared}"] * ((shared == "yes") != all(numbers))
    return faults(len(listed), problems)


def _quantity(kit: Table, shape: str) -> dict[str, str]:
    return pairs(kit, "mark", f"quantity_{shape.replace('-', '_')}")


RULES = (
    Rule("V61", "nodes of one mark are congruent in all shapes", 0, "°", congruence),
    Rule("V62", "a mark is one node in all shapes: schedules and solids", 0, "nodes", one_kit),
    Rule("V63", "the kit counts the nodes of all shapes", 0, "marks", quantities),
)
