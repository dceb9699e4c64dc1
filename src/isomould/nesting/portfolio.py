"""Which search suits which parts: whole sheets for few classes, a dive for many, else filling again and again."""

from dataclasses import replace

from isomould.arrays import Ints
from isomould.nesting import dive, patterns
from isomould.nesting.cover import PLENTY, Rack, cost_of
from isomould.nesting.crew import Crew, gather
from isomould.nesting.leftover import leave_offcut
from isomould.nesting.search import Found, Search, first_sheets, improve

PARTS = (24, 30)
"""Emptiest sheets that are dived into at a time."""

LOSS = 1.05
"""Sheets of a first filling over their bound from which stacking is what loses, so that it pays to plan it."""

DIVED = 10_000
"""Pieces up to which a dive pays: it sees every one of them."""


def find_plans(rack: Rack, counts: Ints, task: Search) -> Found:
    """Place `counts` (parts,) pieces.

    Where a first filling is near the bound, the worst sheets are filled again. Where it is not, heights that
    do not stack are to blame: columns are generated, unless the search is to be quick, the rack has limits or there
    are thousands of different parts. The best effort goes on with the other way.
    """
    with gather(rack, task.jobs) as crew:
        found = _find(rack, counts, task, crew)
    return replace(found, plans=leave_offcut(rack, found.plans))


def _find(rack: Rack, counts: Ints, task: Search, crew: Crew) -> Found:
    first = first_sheets(rack, counts, task, crew)
    limited, near = rack.stock.min() < PLENTY, len(first) <= LOSS * rack.goal or len(counts) > dive.MOST
    if near or limited or task.effort == "quick":
        found = improve(rack, first, counts, task, crew)
        return found if limited or task.effort != "best" else _dive_on(rack, found, counts, task, crew)
    if counts.sum() > DIVED and not patterns.worth_trying(counts):
        return improve(rack, first, counts, task, crew)
    generate = patterns.find_sheets if patterns.worth_trying(counts) else dive.dive
    found = generate(rack, first, counts, task, crew)
    if not found.ended or task.effort != "best":
        return found
    return replace(improve(rack, found.plans, counts, task, crew), pattern_bound=found.pattern_bound)


def _dive_on(rack: Rack, found: Found, counts: Ints, task: Search, crew: Crew) -> Found:
    """Dive into the emptiest sheets, again as long as that saves any, and then into more of them."""
    for sheets in PARTS:
        saved = True
        while saved and found.ended and len(found.plans) > rack.goal:
            before, found = found, dive.dive_part(rack, found.plans, counts, task, crew, sheets)
            saved = cost_of(found.plans) < cost_of(before.plans) - dive.USED
    return found
