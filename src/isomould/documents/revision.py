"""Revisions: unchanged classes keep their marks, and a mark is never used for another part (failure mode E6)."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import KDTree

from isomould.arrays import Ints
from isomould.documents.columns import Column
from isomould.documents.table import Table, cells, make_table

Row = Mapping[str, str]

PARTS = {"nodes": "N", "members": "M", "panels": "P"}
"""Tables of classes and the letter of their marks."""

_LAST_DIGITS = 1.5
"""Classes whose numbers differ by no more units of their last printed digit are the same part."""

_NOT_THE_PART = frozenset(("mark", "quantity", "files", "solid_file", "drawing_file"))
_NOT_THE_PART_STARTS = ("total_", "max_deviation_")


@dataclass(frozen=True)
class Former:
    """What a former delivery says.

    Attributes
    ----------
    classes : mapping of table name to rows
        Nodes, members and panels, cell texts by column.
    places : mapping of table name to marks by location
    retired : frozenset of str
        Marks that were dropped before it, never to come back.
    """

    classes: Mapping[str, Sequence[Row]]
    places: Mapping[str, Mapping[str, str]]
    retired: frozenset[str]


def keep_marks(table: Table, former: Former) -> tuple[str, ...]:
    """Give every class of a table its former mark, or a number that was never used.

    Parameters
    ----------
    table
        Nodes, members or panels with any marks.
    former
        The former delivery.
    """
    rows = former.classes[table.name]
    match = match_rows(table, rows)
    letter = PARTS[table.name]
    used = [row["mark"] for row in rows] + [mark for mark in former.retired if mark[:1] == letter]
    first = max((int(mark[1:]) for mark in used), default=0) + 1
    fresh = (f"{letter}{number:02d}" for number in range(first, first + len(match)))
    return tuple(rows[k]["mark"] if k >= 0 else next(fresh) for k in match.tolist())


def match_rows(table: Table, rows: Sequence[Row]) -> Ints:
    """Number (k,) of the former row that is the same part, −1 where there is none; no row serves twice."""
    found = np.full(len(table.frame), -1)
    ours, theirs = _descriptions(table), _former_descriptions(table, rows)
    for label in ours.keys() & theirs.keys():
        _match_alike(ours[label], theirs[label], found)
    return found


Described = tuple[list[int], list[list[float]]]
"""Row numbers, and the numbers of each in units of their last printed digit."""


def _match_alike(ours: Described, theirs: Described, found: Ints) -> None:
    """Match rows whose texts agree by their numbers, nearest first."""
    near = KDTree(ours[1]).sparse_distance_matrix(KDTree(theirs[1]), _LAST_DIGITS, p=np.inf, output_type="ndarray")
    near["v"] = np.round(near["v"], 6)
    taken: set[int] = set()
    for pair in np.sort(near, order=["v", "i", "j"]).tolist():
        a, b = ours[0][pair[0]], theirs[0][pair[1]]
        if found[a] < 0 and b not in taken:
            found[a] = b
            taken.add(b)


def _descriptions(table: Table) -> dict[tuple[str, ...], Described]:
    columns = _part_columns(table)
    found = [cells(table, column) for column in columns]
    return _sorted(columns, zip(*found, strict=True))


def _former_descriptions(table: Table, rows: Sequence[Row]) -> dict[tuple[str, ...], Described]:
    columns = _part_columns(table)
    return _sorted(columns, ([row.get(column.name, "") for column in columns] for row in rows))


def _sorted(columns: Sequence[Column], rows: Iterable[Iterable[object]]) -> dict[tuple[str, ...], Described]:
    """Sort rows by their texts; a leading 0 keeps rows without numbers comparable."""
    found: dict[tuple[str, ...], Described] = {}
    for k, row in enumerate(rows):
        label, numbers = _describe(columns, row)
        numbered, values = found.setdefault(label, ([], []))
        numbered.append(k)
        values.append([0.0, *numbers])
    return found


def _describe(columns: Sequence[Column], row: Iterable[object]) -> tuple[tuple[str, ...], list[float]]:
    """Texts of a row (blank numbers too), and its numbers in units of their last printed digit."""
    pairs = [(c, "" if cell is None else cell) for c, cell in zip(columns, row, strict=True)]
    label = tuple("" if cell == "" else str(cell) if c.kind == "text" else "#" for c, cell in pairs)
    numbers = [float(str(cell)) * 10.0 ** (c.decimals or 0) for c, cell in pairs if c.kind != "text" and cell != ""]
    return label, numbers


def _part_columns(table: Table) -> list[Column]:
    """Columns that describe the part itself, not its name, number or place."""
    return [c for c in table.columns if c.name not in _NOT_THE_PART and not c.name.startswith(_NOT_THE_PART_STARTS)]


def revision_table(tables: Sequence[Table], former: Former) -> Table:
    """List every mark, now and before: what is new, what changed, what is gone.

    Parameters
    ----------
    tables
        The schedules with their final marks.
    former
        The former delivery.
    """
    by_name = {table.name: table for table in tables}
    rows = [row for name in PARTS for row in _revised(by_name, name, former)]
    names = ("mark", "part", "status", "quantity_before", "quantity", "replaces")
    return make_table("revision", {name: [row[k] for row in rows] for k, name in enumerate(names)})


def _revised(tables: Mapping[str, Table], name: str, former: Former) -> list[tuple[object, ...]]:
    """Rows of one kind of part: those of now, those that were dropped, those dropped earlier."""
    part = name.removesuffix("s")
    now = dict(zip(_column(tables[name], "mark"), _column(tables[name], "quantity"), strict=True))
    before = {row["mark"]: int(row["quantity"]) for row in former.classes[name]}
    replaces = _replaces(tables[f"{part}_instances"], former.places[name])
    rows = [(mark, part, *_change(count, before.get(str(mark)), replaces[mark])) for mark, count in now.items()]
    rows += [(mark, part, "dropped", count, 0, "") for mark, count in before.items() if mark not in now]
    gone = sorted(mark for mark in former.retired if mark[:1] == PARTS[name])
    return rows + [(mark, part, "retired", 0, 0, "") for mark in gone]


def _change(count: object, before: int | None, replaces: set[str]) -> tuple[object, ...]:
    """Status, quantity before and now, and the former marks at the places of a new one."""
    if before is not None:
        return "unchanged" if before == count else "quantity", before, count, ""
    return "changed" if replaces else "added", 0, count, ";".join(sorted(replaces))


def _column(table: Table, name: str) -> list[object]:
    return list(cells(table, next(column for column in table.columns if column.name == name)))


def _replaces(instances: Table, places: Mapping[str, str]) -> dict[object, set[str]]:
    """Former marks at the locations of every mark."""
    found: dict[object, set[str]] = {}
    for mark, location in zip(_column(instances, "mark"), _column(instances, "location"), strict=True):
        found.setdefault(mark, set()).update({places[str(location)]} if str(location) in places else set())
    return found
