"""Packing lists: what goes into the crate of every row, and what meets at every node.

A row's crate holds its nodes, the members that start at them and the panels above its parallel, so that crates are
opened one after another as the structure grows, and every part is in one.
"""

from collections.abc import Iterable, Mapping
from typing import Any

import pandas as pd

from isomould.documents.table import Table, make_table

_PARTS = {"node": "nodes", "member": "members", "panel": "panels"}


def packing_tables(tables: Iterable[Table]) -> tuple[Table, Table]:
    """Make the tables "packing", a row per node, and "crates", a row per crate and class, from those of the parts."""
    frames = {table.name: table.frame for table in tables}
    lists = {part: frames[f"{part}_instances"] for part in _PARTS}
    marks = {where: mark for rows in lists.values() for where, mark in _pairs(rows, "location", "mark").items()}
    masses = {mark: mass for name in _PARTS.values() for mark, mass in _pairs(frames[name], "mark", "mass_kg").items()}
    crates = _contents(_pieces(lists), masses, _width(lists["node"]))
    return make_table("packing", _at_nodes(lists["node"], marks)), make_table("crates", crates)


def _pairs(frame: pd.DataFrame, key: str, value: str) -> dict[str, Any]:
    return dict(zip(frame[key].tolist(), frame[value].tolist(), strict=True))


def _pieces(lists: Mapping[str, pd.DataFrame]) -> dict[tuple[int, str, str], list[str]]:
    """Give the locations by row, kind and mark; members go where they start."""
    row_of, found = _pairs(lists["node"], "location", "i"), dict[tuple[int, str, str], list[str]]()
    for part, frame in lists.items():
        rows = [row_of[start] for start in frame["node_start"]] if part == "member" else frame["i"].tolist()
        for row, mark, where in zip(rows, frame["mark"], frame["location"], strict=True):
            found.setdefault((int(row), part, str(mark)), []).append(str(where))
    return found


def _contents(
    pieces: Mapping[tuple[int, str, str], list[str]], masses: Mapping[str, float], width: int
) -> dict[str, list[object]]:
    """Give the lines of the crates: row by row nodes, members and panels, locations joined in their order."""
    order = list(_PARTS)
    keys = sorted(pieces, key=lambda key: (key[0], order.index(key[1]), key[2]))
    return {
        "crate": [_crate(row, width) for row, _, _ in keys],
        "part": [part for _, part, _ in keys],
        "mark": [mark for _, _, mark in keys],
        "quantity": [len(pieces[key]) for key in keys],
        "mass_kg": [masses[mark] for _, _, mark in keys],
        "locations": [";".join(pieces[key]) for key in keys],
    }


def _at_nodes(nodes: pd.DataFrame, marks: Mapping[str, str]) -> dict[str, list[object]]:
    """Give crate, location and mark of every node, and mark and location of what meets there, in arm order."""
    width = _width(nodes)
    return {
        "crate": [_crate(row, width) for row in nodes["i"].tolist()],
        "location": nodes["location"].tolist(),
        "mark": nodes["mark"].tolist(),
        "members": [_named(cell, marks) for cell in nodes["members"]],
        "panels": [_named(cell, marks) for cell in nodes["panels"]],
    }


def _named(cell: str, marks: Mapping[str, str]) -> str:
    """Put its mark before every location of a list; empty sectors stay empty."""
    return ";".join(f"{marks[where]} {where}" if where else "" for where in cell.split(";"))


def _width(nodes: pd.DataFrame) -> int:
    return max(2, len(str(max(nodes["i"].tolist()))))


def _crate(row: int, width: int) -> str:
    return f"R-{row:0{width}d}"
