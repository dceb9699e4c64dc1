"""Which search suits which parts: whole sheets for few classes, a dive for many, else filling again and again."""

from isomould.arrays import Ints
from isomould.nesting import dive, patterns
from isomould.nesting.cover import PLENTY, Rack
from isomould.nesting.search import Search, improve, search
from isomould.nesting.sheets import SheetPlan


def find_plans(rack: Rack, counts: Ints, task: Search) -> tuple[list[SheetPlan], bool]:
    """Place `counts` (parts,) pieces; give the sheets, and whether the search ran to its end.

    A quick search, one from a rack with limits and one of thousands of different parts only fill sheets. The
    others generate columns; the best effort then fills the worst of their sheets again.
    """
    if task.effort == "quick" or rack.stock.min() < PLENTY or len(counts) > dive.MOST:
        return search(rack, counts, task)
    generate = patterns.find_sheets if patterns.worth_trying(counts) else dive.dive
    plans, ended = generate(rack, counts, task)
    return improve(rack, plans, counts, task) if ended and task.effort == "best" else (plans, ended)
