"""Cutting patterns of bars by column generation (Gilmore and Gomory 1961)."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import highspy
import numpy as np

from isomould.arrays import Bools, Floats
from isomould.nesting.bar_ladder import Ladder
from isomould.nesting.bar_pricing import Values, price
from isomould.nesting.bar_rack import BarRack, Need, Pattern
from isomould.nesting.solver import quiet_solver
from isomould.nesting.stop import Stops, never

PULL = 0.8
"""Weight of the calm worths among those that are priced."""

MISSING = 100.0
"""What a piece costs that no pattern cuts, in costs of the dearest bar."""

PRIMAL = 4
"""The solver's primal simplex: new columns leave the last basis feasible."""

SLIGHT = 1e-6
"""Of costs."""


@dataclass(eq=False)
class Programme:
    """A growing linear programme: a row for every size and one for every kind; columns as the solver has them.

    `costs` are in costs `top` of the dearest kind; `calm` worths (n,) are at first in proportion to lengths.
    """

    rack: BarRack
    costs: Floats
    top: float
    calm: Floats
    stops: Stops = never
    solver: Any = field(default_factory=quiet_solver)
    patterns: list[Pattern] = field(default_factory=list[Pattern])
    known: set[tuple[int, bytes]] = field(default_factory=set[tuple[int, bytes]])


@dataclass(frozen=True, eq=False)
class Shares:
    """Least cost in fractions, uses of every pattern, worth of a piece of every size, toll of every kind.

    `proof` are the worths that prove the most.
    """

    cost: float
    uses: Floats
    worth: Floats
    tolls: Floats
    proof: Floats


def make_programme(rack: BarRack, costs: Floats, first: Sequence[Pattern], stops: Stops = never) -> Programme:
    """Set up a programme from first patterns; the dearest kind of bar counts one."""
    top = float(costs.max())
    calm = rack.sizes.astype(np.float64) * float((costs / top / np.maximum(rack.rooms, 1)).min())
    programme = Programme(rack, costs / top, top, calm, stops)
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
            programme.patterns.append(replace(pattern, times=1))
            rows = np.append(np.flatnonzero(pattern.takes), len(pattern.takes) + pattern.kind)
            values = np.append(pattern.takes[pattern.takes > 0], 1)
            _add_column(programme, float(programme.costs[pattern.kind]), rows, values)


def _add_column(programme: Programme, cost: float, rows: object, values: object) -> None:
    entries = np.asarray(rows, dtype=np.int32), np.asarray(values, dtype=np.float64)
    programme.solver.addCol(cost, 0.0, highspy.kHighsInf, len(entries[0]), *entries)


def generate(programme: Programme, need: Need, rounds: int, ladder: Ladder) -> Shares:
    """Price patterns for what is left until no more can save a whole bar; at most so many rounds.

    Worths of early rounds jump: patterns are priced between them and the calm ones, which have proved the most so far
    (Wentges 1997). Where no new pattern comes of that, the worths themselves are priced.
    """
    _ask(programme, need)
    shares, pull = _solve(programme, need), PULL
    for _ in range(rounds):
        if programme.stops():
            break
        known, pull = len(programme.patterns), pull if _is_steady(programme, shares) else 0.0
        worth = pull * programme.calm + (1.0 - pull) * shares.worth
        values = Values(worth, shares.worth, programme.costs + shares.tolls)
        patterns, most = price(programme.rack, need, values, ladder)
        add_patterns(programme, patterns)
        proved, closer = _prove(programme, need, shares, (worth, most))
        if whole(programme.top * proved) >= whole(programme.top * shares.cost):
            break
        if len(programme.patterns) > known:
            shares, pull = _solve(programme, need), PULL
        elif pull == 0.0:
            break
        elif not closer:
            pull = 0.0
    return replace(shares, proof=programme.calm) if _is_steady(programme, shares) else shares


def _is_steady(programme: Programme, shares: Shares) -> bool:
    """Tell whether worths scaled alone prove something: no bar is free or scarce."""
    return bool(programme.costs.min() > 0 and shares.tolls.max() < SLIGHT)


def _prove(programme: Programme, need: Need, shares: Shares, priced: tuple[Floats, Floats]) -> tuple[float, bool]:
    """Give what worths, scaled until no bar holds more than it costs, prove; if that is more, they become calm."""
    worth, most = priced
    over = float(((most - shares.tolls) / np.maximum(programme.costs, SLIGHT)).max())
    if not _is_steady(programme, shares):
        return shares.cost / max(over, 1.0), False
    before, now = float(programme.calm @ need.counts), float(worth @ need.counts) / max(over, SLIGHT)
    if now > before:
        programme.calm = worth / over
    return max(before, now), now > before


def whole(cost: float) -> int:
    """Round a cost up to the next whole one."""
    return max(math.ceil(cost - SLIGHT), 0)


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
    worth = np.maximum(dual[:sizes], 0.0)
    return Shares(cost, uses, worth, np.maximum(-dual[sizes:], 0.0), worth)
