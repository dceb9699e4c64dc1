"""Cutting patterns of bars by column generation (Gilmore and Gomory 1961)."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import highspy
import numpy as np

from isomould.arrays import Bools, Floats
from isomould.nesting.bar_ladder import Ladder
from isomould.nesting.bar_pricing import Values, price
from isomould.nesting.bar_rack import BarRack, Need, Pattern

MISSING = 100.0
"""What a piece costs that no pattern cuts, in costs of the dearest bar."""

PRIMAL = 4
"""The solver's primal simplex: new columns leave the last basis feasible."""

SLIGHT = 1e-6
"""Of costs."""


@dataclass(eq=False)
class Programme:
    """A growing linear programme: a row for every size and one for every kind; columns as the solver has them.

    `costs` are in costs `top` of the dearest kind.
    """

    rack: BarRack
    costs: Floats
    top: float
    solver: Any = field(default_factory=highspy.Highs)
    patterns: list[Pattern] = field(default_factory=list[Pattern])
    known: set[tuple[int, bytes]] = field(default_factory=set[tuple[int, bytes]])


@dataclass(frozen=True, eq=False)
class Shares:
    """Least cost in fractions, uses of every pattern, worth of a piece of every size, toll of every kind."""

    cost: float
    uses: Floats
    worth: Floats
    tolls: Floats


def make_programme(rack: BarRack, costs: Floats, first: Sequence[Pattern]) -> Programme:
    """Set up a programme from first patterns; the dearest kind of bar counts one."""
    programme = Programme(rack, costs / costs.max(), float(costs.max()))
    programme.solver.setOptionValue("output_flag", False)
    programme.solver.setOptionValue("threads", 1)
    programme.solver.setOptionValue("simplex_strategy", PRIMAL)
    for _ in range(len(rack.sizes)):
        programme.solver.addRow(0.0, highspy.kHighsInf, 0, [], [])
    for _ in range(len(rack.rooms)):
        programme.solver.addRow(-highspy.kHighsInf, 0.0, 0, [], [])
    for row in range(len(rack.sizes)):
        _add_column(programme, MISSING, [row], [1.0])
    add_patterns(programme, first)
    return programme


def add_patterns(programme: Programme, patterns: Sequence[Pattern]) -> None:
    """Add the patterns that are not known yet."""
    for pattern in patterns:
        key = (pattern.kind, pattern.takes.tobytes())
        if key not in programme.known:
            programme.known.add(key)
            programme.patterns.append(pattern)
            rows = np.append(np.flatnonzero(pattern.takes), len(pattern.takes) + pattern.kind)
            values = np.append(pattern.takes[pattern.takes > 0], 1)
            _add_column(programme, float(programme.costs[pattern.kind]), rows, values)


def _add_column(programme: Programme, cost: float, rows: object, values: object) -> None:
    entries = np.asarray(rows, dtype=np.int32), np.asarray(values, dtype=np.float64)
    programme.solver.addCol(cost, 0.0, highspy.kHighsInf, len(entries[0]), *entries)


def generate(programme: Programme, need: Need, rounds: int, ladder: Ladder) -> Shares:
    """Price patterns for what is left until no more can save a whole bar; at most so many rounds."""
    _ask(programme, need)
    shares = _solve(programme, need)
    for _ in range(rounds):
        known = len(programme.patterns)
        patterns = price(programme.rack, need, Values(shares.worth, programme.costs + shares.tolls), ladder)
        add_patterns(programme, patterns)
        if len(programme.patterns) == known or _is_settled(programme, shares, patterns):
            break
        shares = _solve(programme, need)
    return shares


def whole(cost: float) -> int:
    """Round a cost up to the next whole one."""
    return max(math.ceil(cost - SLIGHT), 0)


def _is_settled(programme: Programme, shares: Shares, patterns: Sequence[Pattern]) -> bool:
    """Tell whether the worths, scaled until no pattern holds more than it costs, prove the same whole cost."""
    over = max(
        float((pattern.takes @ shares.worth - shares.tolls[pattern.kind]) / max(programme.costs[pattern.kind], SLIGHT))
        for pattern in patterns
    )
    cost = programme.top * shares.cost
    return whole(cost / max(over, 1.0)) >= whole(cost)


def _ask(programme: Programme, need: Need) -> None:
    """Ask for what is left; patterns that take more of a size than that are barred."""
    sizes, kinds = len(need.counts), len(need.limits)
    endless = np.full(sizes, highspy.kHighsInf)
    lower = np.concatenate([need.counts.astype(float), np.full(kinds, -highspy.kHighsInf)])
    upper = np.concatenate([endless, need.limits.astype(float)])
    programme.solver.changeRowsBounds(sizes + kinds, np.arange(sizes + kinds, dtype=np.int32), lower, upper)
    most = np.concatenate([endless, np.where(fits(programme, need), highspy.kHighsInf, 0.0)])
    columns = np.arange(len(most), dtype=np.int32)
    programme.solver.changeColsBounds(len(most), columns, np.zeros(len(most)), most)


def fits(programme: Programme, need: Need) -> Bools:
    """Tell of every pattern whether it takes no more than what is left."""
    return np.array([not (pattern.takes > need.counts).any() for pattern in programme.patterns], dtype=np.bool_)


def _solve(programme: Programme, need: Need) -> Shares:
    programme.solver.run()
    sizes, found = len(need.counts), programme.solver.getSolution()
    dual, cost = np.array(found.row_dual), programme.solver.getInfo().objective_function_value
    uses = np.array(found.col_value)[sizes:]
    return Shares(cost, uses, np.maximum(dual[:sizes], 0.0), np.maximum(-dual[sizes:], 0.0))
