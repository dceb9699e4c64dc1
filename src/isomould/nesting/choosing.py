"""Whole numbers of strips and stacks: the best sheets that the columns of a master programme make, for few pieces."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import highspy
import numpy as np

from isomould.arrays import Ints
from isomould.nesting.cover import Rack
from isomould.nesting.master import Column, Master, Way, solve
from isomould.nesting.sheets import SheetPlan, Strip, strip_height, take_once

PIECES = 150
"""Pieces up to which whole numbers are chosen: with more of them the search for these hardly moves."""

ON_A_SHEET = 10
"""Pieces of a sheet, in the mean, up to which it is worth while: small ones make too many strips near the best."""

NODES = 100
"""Nodes of the search."""

TINY = 1e-6
"""What costs so little more costs the same."""


def worth_choosing(counts: Ints, sheets: int) -> bool:
    """Tell whether there are few enough pieces, and few on a sheet."""
    return counts.sum() <= min(PIECES, ON_A_SHEET * sheets)


@dataclass(eq=False)
class _Sheet:
    """A stack, and the strips that lie on it."""

    column: Column
    strips: list[Strip] = field(default_factory=list[Strip])


def choose_sheets(rack: Rack, master: Master, counts: Ints, most: float) -> list[SheetPlan]:
    """Cover the counts by whole strips on whole stacks that cost `most`; nothing if none are found within the limit."""
    uses = _whole_uses(master, solve(master, counts).cost, most)
    sheets = [_Sheet(column) for column, many in uses if not column.strip for _ in range(many)]
    strips = [(column, column.strip) for column, many in uses if column.strip for _ in range(many)]
    for way in dict.fromkeys((frame.stock, frame.turned) for frame in rack.frames):
        _lay(way, strips, sheets)
    left = counts.copy()
    return [plan for sheet in sheets for plan in _planned(rack, sheet, left)]


def _whole_uses(master: Master, cost: float, most: float) -> list[tuple[Column, int]]:
    """Give the used columns; links may be used in fractions, for all others are whole.

    A column that loses more than the programme may still cost has no part in what costs less.
    """
    solver = master.solver
    loses = np.array(solver.getSolution().col_dual) > most - cost + TINY
    for column in np.flatnonzero(loses).tolist():
        solver.changeColBounds(column, 0.0, 0.0)
    columns = [k for k, column in enumerate(master.columns) if column.stack and not loses[k]]
    _mark(master, columns, highspy.HighsVarType.kInteger)
    solver.setOptionValue("mip_max_nodes", NODES)
    solver.setOptionValue("mip_abs_gap", max(most - cost, 0.0) + TINY)
    solver.run()
    found = solver.getInfo().primal_solution_status == highspy.SolutionStatus.kSolutionStatusFeasible
    amounts = np.rint(np.array(solver.getSolution().col_value)).astype(np.int64).tolist() if found else []
    _mark(master, columns, highspy.HighsVarType.kContinuous)
    return [(master.columns[k], amounts[k]) for k in columns if found and amounts[k]]


def _mark(master: Master, columns: Sequence[int], kind: highspy.HighsVarType) -> None:
    for column in columns:
        master.solver.changeColIntegrality(column, kind)


def _lay(way: Way, strips: Sequence[tuple[Column, Strip]], sheets: Sequence[_Sheet]) -> None:
    """Lay the strips in the slots of one way to cut, the tallest in the tallest: if all find a slot, then so."""
    slots = [(slot[2], sheet) for sheet in sheets for slot in sheet.column.stack if slot[:2] == way]
    own = [strip for column, strip in strips if column.stack[0][:2] == way]
    slots.sort(key=lambda pair: -pair[0])
    own.sort(key=lambda strip: -strip_height(strip))
    for (_, sheet), strip in zip(slots, own, strict=False):
        sheet.strips.append(strip)


def _planned(rack: Rack, sheet: _Sheet, left: Ints) -> Iterator[SheetPlan]:
    """Give a sheet without what is covered already, if anything is left on it."""
    way = sheet.column.stack[0][:2]
    frame = next(frame for frame in rack.frames if (frame.stock, frame.turned) == way)
    kept = tuple(strip for strip in (take_once(strip, left) for strip in sheet.strips) if strip)
    if kept:
        yield SheetPlan(frame, kept)
