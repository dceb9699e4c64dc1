"""The assembly table: which members and panels meet at every node."""

from collections.abc import Iterator, Mapping, Sequence

from isomould.documents.shop.grid import grid
from isomould.documents.shop.page import SMALL, SMALLEST, Item, Text, paper_size
from isomould.documents.shop.rows import Row
from isomould.documents.shop.title_block import Stationery, room

_ROW = 1.8 * SMALLEST

Drawn = tuple[str, str, tuple[float, float], list[Item]]
"""Title, scale, size of a sheet, what is on it."""


def assembly(stationery: Stationery, rows: Sequence[Row], marks: Mapping[str, str]) -> Iterator[Drawn]:
    """List what meets at every node, as many nodes on a sheet as fit."""
    size = paper_size(stationery.paper or "A4", lying=True)
    left, bottom, _, top = room(stationery, size)
    members, panels = (max(len(_list(row[name])) for row in rows) for name in ("members", "panels"))
    heading = ("Node", "Mark", *["Member"] * members, *["Panel"] * panels)
    lines = [_line(row, members, panels, marks) for row in rows]
    most = int((top - bottom - 8) // _ROW) - 1
    for start in range(0, len(lines), most):
        caption = Text("What meets at every node, arm by arm; a panel lies behind its arm", (left, top - 2), SMALL)
        yield (
            "Assembly",
            "-",
            size,
            [caption, *grid([heading, *lines[start : start + most]], (left, top - 5), SMALLEST)],
        )


def _list(cell: str) -> list[str]:
    return cell.split(";") if cell else []


def _line(row: Row, members: int, panels: int, marks: Mapping[str, str]) -> tuple[str, ...]:
    cells = [_list(row[name]) for name in ("members", "panels")]
    texts = [[f"{marks[where]} {where}" if where else "-" for where in cell] for cell in cells]
    padded = [text + [""] * (count - len(text)) for text, count in zip(texts, (members, panels), strict=True)]
    return row["location"], row["mark"], *padded[0], *padded[1]
