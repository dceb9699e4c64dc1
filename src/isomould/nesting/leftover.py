"""The last step of a search: what the emptiest sheets hold is squeezed to one edge, so that a large offcut is left."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

from isomould.arrays import Ints
from isomould.nesting.cover import Rack, area_of, pieces_of
from isomould.nesting.sheets import Frame, Run, SheetPlan, Zone, fill, narrow, strip_height
from isomould.nesting.strips import Block

EMPTIEST = 3
"""Sheets that are squeezed; the one that leaves the largest offcut counts."""

HALVINGS = 10
"""How finely the height is found that just holds them."""


def leave_offcut(rack: Rack, plans: Sequence[SheetPlan]) -> list[SheetPlan]:
    """Give the same sheets with the same pieces, squeezed where that makes the largest offcut larger."""
    emptiest = sorted(range(len(plans)), key=lambda k: area_of(rack, plans[k]) / plans[k].frame.area)[:EMPTIEST]
    squeezed = {k: _squeezed(rack, plans[k]) for k in emptiest}
    return [squeezed.get(k, plan) for k, plan in enumerate(plans)]


def _offcut(plan: SheetPlan) -> float:
    """Area (µm²) of the largest rectangle left beside all strips, or at the end of one."""
    frame = plan.frame
    length = frame.capacity * frame.step
    beside = frame.room - sum(strip_height(strip) + frame.gap for strip in plan.strips)
    ends = (
        (length - _length(frame, strip)) * strip_height(strip) for strip in plan.strips if not isinstance(strip, Zone)
    )
    return max(beside * length, *ends, 0)


def _length(frame: Frame, run: Run) -> float:
    """Give what a run takes of its strip: the sizes of its items, and what the slanted ends of blocks stand out."""
    return sum(sum(item.size for item in block) * frame.step + _ends(block) for block in run)


def _ends(block: Block) -> float:
    return (block[0].shape.overhang + block[-1].shape.overhang) / 2 if len(block) > 1 else 0.0


def _squeezed(rack: Rack, plan: SheetPlan) -> SheetPlan:
    """Fill a sheet again, lying or turned, so that its strips take the least height."""
    counts = pieces_of([plan], len(rack.areas))
    ways = [frame for frame in rack.frames if frame.stock == plan.frame.stock]
    return max([plan, *(found for frame in ways for found in _lower(rack, frame, counts))], key=_offcut)


def _lower(rack: Rack, frame: Frame, counts: Ints) -> Iterator[SheetPlan]:
    """Find ever lower stacks that hold all pieces."""
    own, low, high = narrow(frame, counts), 0, frame.room
    for _ in range(HALVINGS):
        middle = (low + high) // 2
        strips = fill(replace(own, room=middle), counts, rack.areas).strips
        found = SheetPlan(frame, strips)
        if (pieces_of([found], len(counts)) == counts).all():
            high = middle
            yield found
        else:
            low = middle
