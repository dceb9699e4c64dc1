"""V34c, V34d of members that were nested alone: what a layout says of its bars, and its saw list."""

from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import shapely

from isomould.verify.checks.bars import placed, reach, shortfall
from isomould.verify.checks.cutting_plan import says
from isomould.verify.checks.saw_list import Bar, Cut
from isomould.verify.read.tables import read_table
from isomould.verify.read.text import Json
from isomould.verify.read.workbook import read_workbook
from isomould.verify.rules import Measured, NotApplicable, Unreadable, faults, worst_of

_HALF = 1e4
"""Half the width of a piece that is cut square, mm: wider than any bar."""
_COLUMNS = ("bar", "stock", "cut", "mark", "location", "position_mm", "length_mm", "bar_turned", "offcut_mm")


def bars_of(raw: Json) -> list[Bar]:
    """Give the bars of a layout."""
    return [
        Bar(str(bar["id"]), f"{bar['section']} x {bar['length']:g}", tuple(map(_cut, bar["cuts"])), float(bar["rest"]))
        for bar in raw["bars"]
    ]


def _cut(raw: Json) -> Cut:
    return Cut(str(raw["id"]), raw["location"] or "", float(raw["start"]), float(raw["length"]), raw["turned"])


def pieces(raw: Json) -> Measured:
    """How far pieces fall short of kerf or trim, are not as long as asked, or do not add up with the offcut."""
    members = {str(member["id"]): member for member in raw["members"]}
    off, where = [_missing(raw)], ["quantities"]
    for bar in raw["bars"]:
        off.append(_bar_off(raw, bar, members))
        where.append(str(bar["id"]))
    return worst_of(off, where)


def _missing(raw: Json) -> float:
    """Give infinity if members are cut or listed more or less often than asked for, from another section too."""
    found = Counter((str(cut["id"]), bar["section"]) for bar in raw["bars"] for cut in bar["cuts"])
    left, sections = (
        Counter(str(item["id"]) for item in raw["unplaced"]),
        {str(m["id"]): m["section"] for m in raw["members"]},
    )
    found.update({(mark, sections.get(mark, "")): count for mark, count in left.items()})
    wanted = Counter({(str(member["id"]), member["section"]): int(member["quantity"]) for member in raw["members"]})
    same = found == wanted and raw["status"] == ("incomplete" if raw["unplaced"] else "complete")
    return 0.0 if same else np.inf


def _bar_off(raw: Json, bar: Json, members: dict[str, Json]) -> float:
    kerf, trim = float(raw["nesting"]["bar_kerf_mm"]), float(raw["nesting"]["bar_trim_mm"])
    lying = sorted(
        (_piece(raw, cut, members[str(cut["id"])]) for cut in bar["cuts"]), key=lambda piece: piece.bounds[0]
    )
    left = bar["length"] - trim - reach(lying)
    lengths = [abs(cut["length"] - members[str(cut["id"])]["length"]) for cut in bar["cuts"]]
    return max(shortfall(lying, kerf, trim), abs(left - bar["rest"]), -left, *lengths)


def _piece(raw: Json, cut: Json, member: Json) -> shapely.Polygon:
    """Give a piece where it lies: slanted where ends lie head to tail, else the box around it."""
    slanted = member["points"] and raw["nesting"]["bar_ends"] == "head-to-tail"
    length = float(cut["length"])
    square = [[0.0, -_HALF], [length, -_HALF], [length, _HALF], [0.0, _HALF]]
    return placed(np.array(member["points"] if slanted else square), cut["turned"], float(cut["start"]))


def listed(raw: Json, path: Path | None) -> Measured:
    """Compare the saw list with the layout, cut by cut."""
    if path is None:
        raise NotApplicable("no saw list was written")
    wanted, found = list(_rows(raw)), _table(path)
    problems = [
        f"{row[0]} cut {row[2]} differs" for row, other in zip(wanted, found, strict=False) if not _same(row, other)
    ]
    counts = [f"{len(found)} rows, not {len(wanted)}"] if len(found) != len(wanted) else []
    return faults(len(wanted), [*problems, *counts])


def _rows(raw: Json) -> Iterator[list[str | float]]:
    for bar in bars_of(raw):
        for number, cut in enumerate(bar.cuts, start=1):
            offcut = bar.offcut if number == len(bar.cuts) else ""
            yield [
                bar.name,
                bar.stock,
                str(number),
                cut.mark,
                cut.location,
                cut.position,
                cut.length,
                cut.turned,
                offcut,
            ]


def _same(wanted: list[str | float], found: list[str]) -> bool:
    return all(says(text, cell, "length_mm") for text, cell in zip(found, wanted, strict=True))


def _table(path: Path) -> list[list[str]]:
    """Give the rows of a saw list: a CSV file, or the sheet of a workbook."""
    if path.suffix.lower() == ".csv":
        table = read_table(path)
        if tuple(table.columns) != _COLUMNS:
            message = f"{path.name}: columns {', '.join(table.columns)}"
            raise Unreadable(message)
        return [list(row) for row in zip(*table.columns.values(), strict=True)]
    book = read_workbook(path)
    named = next(table for table in book.tables.values() if table.headers[:3] == ("Bar", "Stock", "Cut"))
    cells = book.sheets[named.sheet]
    places = [[(row, named.column + k) for k in range(len(_COLUMNS))] for row in range(named.first, named.last + 1)]
    return [["" if at not in cells else str(cells[at].value) for at in row] for row in places]
