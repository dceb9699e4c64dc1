"""New columns for the master programme: the best strips and the best stacks for given worths, and a bound.

One knapsack per frame knows the best strip of every height. What these are worth, stacked exactly, tells whether any
sheet holds more than it costs; and a strip pays if it is worth more than its slot.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from isomould.arrays import Floats, Ints
from isomould.nesting.cover import Rack
from isomould.nesting.master import Master, Slot, add_stack, add_strip
from isomould.nesting.patterns import stack_up
from isomould.nesting.sheets import Frame, Run, once
from isomould.nesting.strips import price, trace

STRIPS = 60
"""Strips of a frame that are offered at a time."""

STACKS = 30
"""Stacks of a frame that are offered at a time."""

GAIN = 1e-6
"""What is worth so little more than it costs is no gain."""


@dataclass(frozen=True, eq=False)
class Offer:
    """Columns of one frame that pay; no sheet is worth more than `most`, for its cost."""

    frame: Frame
    strips: tuple[Run, ...]
    stacks: tuple[tuple[int, ...], ...]
    most: float


def make_offers(rack: Rack, counts: Ints, worth: Floats, slots: Mapping[Slot, float]) -> list[Offer]:
    """Price strips and stacks for every frame.

    Parameters
    ----------
    counts : (parts,) int
        Pieces left.
    worth : (parts,) float
        What a piece is worth.
    slots
        What every slot of the programme is worth.
    """
    return [_offer(frame, counts, worth, _own(frame, slots)) for frame in rack.frames]


def add_offer(master: Master, offer: Offer) -> None:
    """Add what is offered to the programme."""
    for strip in offer.strips:
        add_strip(master, offer.frame, strip)
    for stack in offer.stacks:
        add_stack(master, offer.frame, stack)


def _own(frame: Frame, slots: Mapping[Slot, float]) -> tuple[Ints, Floats]:
    """Give heights, ascending, and worths of the slots of a frame."""
    own = sorted((slot[2], worth) for slot, worth in slots.items() if slot[:2] == (frame.stock, frame.turned))
    return np.array([height for height, _ in own], dtype=np.int64), np.array([worth for _, worth in own])


def _offer(frame: Frame, counts: Ints, worth: Floats, slots: tuple[Ints, Floats]) -> Offer:
    priced = price(frame.kinds, counts, worth, frame.capacity)
    better = np.flatnonzero(np.diff(priced.worth, prepend=0.0) > 0)
    heights, strips = priced.heights[better], priced.worth[better]
    stacks, known = _stacks(frame, heights, strips), _stacks(frame, *slots)
    paying = _paying(heights, strips, slots) | {k for stack in stacks for k in stack}
    runs = (once(trace(priced, int(better[k]), frame.capacity), counts.copy()) for k in sorted(paying))
    named = [tuple(heights[list(stack)].tolist()) for stack in stacks] + [
        tuple(slots[0][list(stack)].tolist()) for stack in known
    ]
    return Offer(frame, tuple(run for run in runs if run), tuple(named), _most(frame, heights, strips) / frame.cost)


def _paying(heights: Ints, strips: Floats, slots: tuple[Ints, Floats]) -> set[int]:
    """Choose the strips that are worth most more than the lowest slot that holds them."""
    room = np.searchsorted(slots[0], heights)
    gain = strips - np.append(slots[1], np.inf)[room]
    return {k for k in np.argsort(-gain, kind="stable")[:STRIPS].tolist() if gain[k] > GAIN}


def _stacks(frame: Frame, heights: Ints, worth: Floats) -> list[list[int]]:
    """Give the stacks that are worth more than the sheet: the best above every item."""
    steps, room = -(-(heights + frame.gap) // frame.step), frame.room // frame.step
    stacks = stack_up(steps, worth[:, None], room)
    rest = room - steps
    total = np.where(rest >= 0, worth + stacks.worth[np.maximum(rest, 0), 0], 0.0)
    order = np.argsort(-total, kind="stable")[:STACKS].tolist()
    return [[k, *stacks.trace(0, int(rest[k]))] for k in order if total[k] > frame.cost * (1 + GAIN)]


def _most(frame: Frame, heights: Ints, worth: Floats) -> float:
    """Give no less than what the best stack is worth: heights are rounded down."""
    steps = np.maximum((heights + frame.gap) // frame.step, 1)
    return float(stack_up(steps, worth[:, None], -(-frame.room // frame.step)).worth[-1, 0])
