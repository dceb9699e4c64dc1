"""V43, V44: marks, quantities and places agree across the documents, and the sums are the summary's."""

import re
from collections import Counter
from collections.abc import Iterator

import numpy as np

from isomould.verify.delivery import Delivery
from isomould.verify.read.tables import half_unit, number, numbers, pairs, texts
from isomould.verify.rules import Floats, Measured, NotApplicable, Rule, Unreadable, faults, worse, worst_of

PARTS = ("node", "member", "panel")
_MESH = {"node": "node", "member": "edge", "panel": "face"}


def identity(delivery: Delivery) -> Measured:
    """Locations and marks of mesh and tables agree; quantities count the instances."""
    problems = [fault for part in PARTS for fault in _identity_faults(delivery, part)]
    return faults(sum(delivery.table(f"{part}_instances").rows for part in PARTS), problems)


def _identity_faults(delivery: Delivery, part: str) -> Iterator[str]:
    marks = pairs(delivery.table(f"{part}_instances"), "location", "mark")
    mesh = _mesh_marks(delivery, part)
    for location in sorted(marks.keys() | mesh.keys()):
        if marks.get(location) != mesh.get(location):
            yield f"{location}: {marks.get(location)} in the table, {mesh.get(location)} in the model"
    counted = Counter(marks.values())
    for mark, quantity in pairs(delivery.table(f"{part}s"), "mark", "quantity").items():
        if number(quantity) != counted.pop(mark, 0):
            yield f"{mark}: quantity {quantity} is not the number of its instances"
    yield from (f"{mark} has no row in {part}s" for mark in counted)


def _mesh_marks(delivery: Delivery, part: str) -> dict[str, str]:
    """Map the locations of nodes, edges or faces of the mesh on their marks."""
    names = (f"{_MESH[part]}_{what}" for what in ("location", "mark"))
    location, mark = (getattr(delivery.mesh, name).tolist() for name in names)
    return dict(zip(location, mark, strict=True))


def neighbours(delivery: Delivery) -> Measured:
    """Nodes of members and panels, indices of nodes and panels as in the mesh."""
    mesh = delivery.mesh
    ends = [";".join(sorted(pair)) for pair in mesh.node_location[mesh.edges].tolist()]
    corners = np.split(mesh.node_location[mesh.faces], mesh.face_offsets[1:-1])
    claims = {
        "member_instances": _rows(delivery, "member_instances", "node_start", "node_end"),
        "panel_instances": _rows(delivery, "panel_instances", "nodes"),
    }
    truth = {
        "member_instances": dict(zip(mesh.edge_location.tolist(), ends, strict=True)),
        "panel_instances": {
            str(face): ";".join(sorted(nodes)) for face, nodes in zip(mesh.face_location, corners, strict=True)
        },
    }
    problems = [f"{k}: {claims[t][k]}, in the model {truth[t].get(k)}" for t in claims for k in claims[t]
                if claims[t][k] != truth[t].get(k)]  # fmt: skip
    return faults(sum(map(len, claims.values())), problems + _index_faults(delivery))


def _rows(delivery: Delivery, table: str, *columns: str) -> dict[str, str]:
    """Map locations on the sorted names in some columns."""
    found = delivery.table(table)
    cells = zip(*(texts(found, column) for column in columns), strict=True)
    lists = [";".join(sorted(name for cell in row for name in cell.split(";") if name)) for row in cells]
    return dict(zip(texts(found, "location"), lists, strict=True))


def _index_faults(delivery: Delivery) -> list[str]:
    mesh, problems = delivery.mesh, list[str]()
    sources = (
        ("node_instances", mesh.node_location, mesh.node_ij),
        ("panel_instances", mesh.face_location, mesh.face_ij),
    )
    for name, locations, indices in sources:
        table = delivery.table(name)
        claimed = dict(
            zip(texts(table, "location"), zip(texts(table, "i"), texts(table, "j"), strict=True), strict=True)
        )
        own = zip(locations.tolist(), indices.tolist(), strict=True)
        problems += [f"{k}: i, j = {claimed.get(k)}" for k, (i, j) in own if claimed.get(k) != (str(i), str(j))]
    return problems


def revision(delivery: Delivery) -> Measured:
    """What a revision lists is what the schedules hold: quantities of now, and nothing that was dropped."""
    now = {m: q for part in PARTS for m, q in pairs(delivery.table(f"{part}s"), "mark", "quantity").items()}
    if "revision" not in delivery.tables:
        raise NotApplicable("no former delivery was named")
    table = delivery.table("revision")
    listed = pairs(table, "mark", "quantity")
    problems = [f"{m}: {listed.get(m)} in the revision, {q} scheduled" for m, q in now.items() if listed.get(m) != q]
    gone = [m for m, status in pairs(table, "mark", "status").items() if status in {"dropped", "retired"}]
    return faults(table.rows, problems + [f"{mark} was dropped and is used again" for mark in gone if mark in now])


def coordinates(delivery: Delivery) -> Measured:
    """Node coordinates in the schedule against the model, at the schedule's rounding."""
    return _node_values(delivery, ("x_mm", "y_mm", "z_mm"), delivery.mesh.nodes, half_unit("x_mm"))


def axes(delivery: Delivery) -> Measured:
    """Node axes in the schedule against the model; printed to nine decimals."""
    return _node_values(delivery, ("axis_x", "axis_y", "axis_z"), delivery.mesh.node_axes, 0.5005e-9)


def _node_values(delivery: Delivery, columns: tuple[str, ...], own: Floats,
                 rounding: float) -> Measured:  # fmt: skip
    table = delivery.table("node_instances")
    row = {location: k for k, location in enumerate(texts(table, "location"))}
    order = [row[str(location)] for location in delivery.mesh.node_location]
    claimed = np.column_stack([numbers(table, column) for column in columns])[order]
    return worst_of(abs(claimed - own).max(axis=1), delivery.mesh.node_location, limit=rounding)


def end_cuts(delivery: Delivery) -> Measured:
    """Top minus bottom length of a plate against its depth and the slopes of its end cuts."""
    table, depth = delivery.table("members"), float(delivery.design.raw["member"]["depth"])
    start, end = (np.radians(numbers(table, f"end_angle_{side}_deg")) for side in ("start", "end"))
    longer = numbers(table, "top_length_mm") - numbers(table, "bottom_length_mm")
    steepest = max(abs(start).max(), abs(end).max())
    limit = 4 * half_unit("mm") + 2 * depth * np.radians(half_unit("deg")) / np.cos(steepest) ** 2
    return worst_of(abs(longer - depth * (np.tan(start) + np.tan(end))), texts(table, "mark"), limit=float(limit))


def products(delivery: Delivery) -> Measured:
    """Every total column is quantity × the value per piece (off by how many half units of its last digit)."""
    found = [_product(delivery, name, column) for name, column in _total_columns(delivery)]
    return worse(*found)


def _total_columns(delivery: Delivery) -> list[tuple[str, str]]:
    made = ["fittings"] if "fittings" in delivery.tables else []
    tables = [delivery.table(name) for name in (*(f"{part}s" for part in PARTS), *made)]
    return [(table.name, column) for table in tables for column in table.columns if column.startswith("total_")]


def _product(delivery: Delivery, name: str, column: str) -> Measured:
    table = delivery.table(name)
    own = numbers(table, "quantity") * numbers(table, column.removeprefix("total_"))
    off = abs(own - numbers(table, column)) / (half_unit(column) + 1e-12 * abs(own))
    return worst_of(off, [f"{mark} {column}" for mark in texts(table, "mark")])


def summary(delivery: Delivery) -> Measured:
    """Totals of the parts, summed here from the tables, against the lines of the Summary sheet (relative)."""
    lines = _summary_lines(delivery)
    off, names = list[float](), list[str]()
    for name, column in [*_total_columns(delivery), *((f"{part}s", "quantity") for part in PARTS)]:
        table = delivery.table(name)
        each = numbers(table, column.removeprefix("total_")) if column != "quantity" else 1.0
        total = float((numbers(table, "quantity") * each).sum())
        label, shown = _line_about(lines, name, column)
        off.append(abs(shown - total) / max(abs(total), 1e-12))
        names.append(f"Summary: {label}")
    return worst_of(off, names)


def _summary_lines(delivery: Delivery) -> list[tuple[str, float]]:
    """Give label and number of every line of the sheet that has both."""
    cells = delivery.workbook.sheets["Summary"]
    rows = sorted({row for row, _ in cells})
    lines = [[cells[row, column].value for r, column in sorted(cells) if r == row] for row in rows]
    found = [
        ([v for v in line if isinstance(v, str)], [v for v in line if isinstance(v, float | int)]) for line in lines
    ]
    return [(words[0], float(values[0])) for words, values in found if words and values]


def _line_about(lines: list[tuple[str, float]], name: str, column: str) -> tuple[str, float]:
    words = column.removesuffix("_kg").removesuffix("_m2").replace("_", " ")
    pattern = re.compile(rf"{name}\b.*\b{words}\b", re.IGNORECASE)
    for label, value in lines:
        if pattern.search(label):
            return label, value
    message = f"the Summary sheet has no line about the {words} of the {name}"
    raise Unreadable(message)


RULES = (
    Rule("V43", "marks, locations and quantities agree", 0, "faults", identity),
    Rule("V43b", "neighbours and indices agree with the model", 0, "faults", neighbours),
    Rule("V43i", "revision lists what is scheduled; dropped marks stay away", 0, "faults", revision),
    Rule("V43c", "scheduled coordinates = model", half_unit("x_mm"), "mm", coordinates),
    Rule("V43d", "scheduled axes = model", 0.5005e-9, "", axes),
    Rule("V43e", "top, bottom and end cuts of members agree", 0, "mm", end_cuts),
    Rule("V44", "totals = quantity × per piece", 1.0, "half digits", products),
    Rule("V44b", "sums of parts = Summary", 1e-9, "relative", summary),
)
