"""Which search suits which parts: whole sheets for few classes, a dive for many, else filling again and again."""

from isomould.arrays import Ints
from isomould.nesting import dive, patterns
from isomould.nesting.cover import PLENTY, Rack
from isomould.nesting.search import Search, first_sheets, improve
from isomould.nesting.sheets import SheetPlan

LOSS = 1.08
"""Sheets of a first filling over their bound from which stacking is what loses, so that it pays to plan it."""


def find_plans(rack: Rack, counts: Ints, task: Search) -> tuple[list[SheetPlan], bool]:
    """Place `counts` (parts,) pieces; give the sheets, and whether the search ran to its end.

    Where a first filling is near the bound, the worst sheets are filled again. Where it is not, heights that
    do not stack are to blame: columns are generated, unless the search is to be quick, the rack has limits or there
    are thousands of different parts. The best effort then fills the worst sheets again.
    """
    first = first_sheets(rack, counts, task)
    if task.effort == "quick" or len(first) <= LOSS * rack.goal or rack.stock.min() < PLENTY or len(counts) > dive.MOST:
        return improve(rack, first, counts, task)
    generate = patterns.find_sheets if patterns.worth_trying(counts) else dive.dive
    plans, ended = generate(rack, first, counts, task)
    return improve(rack, plans, counts, task) if ended and task.effort == "best" else (plans, ended)
