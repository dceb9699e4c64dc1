"""V47: every part is packed once, in the crate of its row, and the lists at the nodes name what meets there."""

from collections import Counter
from itertools import chain

from isomould.verify.delivery import Delivery
from isomould.verify.read.tables import Table, number, pairs, texts
from isomould.verify.rules import Measured, Rule, faults

_CLASSES = {"node": "nodes", "member": "members", "panel": "panels"}


def contents(delivery: Delivery) -> Measured:
    """Compare the crates with marks and rows of the model: every location once, under its mark, in its row's crate."""
    found = Counter(chain.from_iterable(_pieces(row) for row in _rows(delivery.table("crates"))))
    wanted = Counter(_wanted(delivery))
    return faults(len(wanted), [" ".join(map(str, piece)) for piece in sorted((found - wanted) + (wanted - found))])


def _pieces(row: dict[str, str]) -> list[tuple[int, str, str, str]]:
    """Row of the crate, kind, mark and location of the pieces of a line."""
    return [(_crate(row["crate"]), row["part"], row["mark"], where) for where in row["locations"].split(";")]


def _crate(name: str) -> int:
    return int(name.removeprefix("R-"))


def _wanted(delivery: Delivery) -> list[tuple[int, str, str, str]]:
    mesh = delivery.mesh
    kinds = (
        ("node", mesh.node_ij[:, 0], mesh.node_mark, mesh.node_location),
        ("member", mesh.node_ij[mesh.edges[:, 0], 0], mesh.edge_mark, mesh.edge_location),
        ("panel", mesh.face_ij[:, 0], mesh.face_mark, mesh.face_location),
    )
    return [
        (int(row), kind, str(mark), str(where)) for kind, *data in kinds for row, mark, where in zip(*data, strict=True)
    ]


def counts(delivery: Delivery) -> Measured:
    """Quantities and masses of the crates: as many as locations, as heavy as the schedule says."""
    masses = {(kind, mark): number(mass) for kind, name in _CLASSES.items()
              for mark, mass in pairs(delivery.table(name), "mark", "mass_kg").items()}  # fmt: skip
    rows = _rows(delivery.table("crates"))
    wrong = [row for row in rows if not _counted(row, masses[row["part"], row["mark"]])]
    return faults(len(rows), [f"{row['crate']} {row['mark']}" for row in wrong])


def _counted(row: dict[str, str], mass: float) -> bool:
    """Tell whether quantity, mass and total of a line are those of its pieces."""
    pieces = len(row["locations"].split(";"))
    total = abs(number(row["total_mass_kg"]) - pieces * mass) < 5.1e-4
    return int(row["quantity"]) == pieces and number(row["mass_kg"]) == mass and total


def at_nodes(delivery: Delivery) -> Measured:
    """Lists at the nodes: members in arm order and panels with their marks, as the schedule of nodes has them."""
    mesh, table = delivery.mesh, delivery.table("packing")
    marks = dict(zip([*mesh.edge_location, *mesh.face_location], [*mesh.edge_mark, *mesh.face_mark], strict=True))
    crates = dict(zip(mesh.node_location.tolist(), mesh.node_ij[:, 0].tolist(), strict=True))
    told = {row["location"]: row for row in _rows(table)}
    wrong = [] if len(told) == table.rows else ["a location is repeated"]
    for node in _rows(delivery.table("node_instances")):
        wanted = {name: _named(node[name], marks) for name in ("members", "panels")} | {"mark": node["mark"]}
        row = told.pop(node["location"], {"crate": ""})
        same = _crate(row["crate"] or "-1") == crates[node["location"]]
        wrong += [] if same and wanted.items() <= row.items() else [node["location"]]
    return faults(table.rows, [*wrong, *told])


def _named(cell: str, marks: dict[str, str]) -> str:
    return ";".join(" ".join((marks[where], where)) if where else "" for where in cell.split(";"))


def _rows(table: Table) -> list[dict[str, str]]:
    columns = [texts(table, name) for name in table.columns]
    return [dict(zip(table.columns, cells, strict=True)) for cells in zip(*columns, strict=True)]


RULES = (
    Rule("V47", "every part is in the crate of its row, once", 0, "parts", contents),
    Rule("V47b", "crates count and weigh what is in them", 0, "lines", counts),
    Rule("V47c", "packing lists name what meets at every node", 0, "nodes", at_nodes),
)
