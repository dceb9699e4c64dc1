"""How far a run has come: its stages in order, what each should cost, and who is told. No clock is read here."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import dataclass, replace
from typing import TypeVar

Item = TypeVar("Item")

Told = Callable[[int, int], None]
"""Told how many pieces of work are done, and how many there are."""


@dataclass(frozen=True)
class Step:
    """How far a run has come.

    Attributes
    ----------
    stage
        What is being done, in words.
    number, stages
        The place of the stage among all, from 1, and how many there are.
    done, total
        Pieces of its work, such as drawings; a total of 0 is not counted, or not yet.
    share
        How much of the work of the whole run is done, from 0 to 1; None while that is unknown.
    """

    stage: str
    number: int = 1
    stages: int = 1
    done: int = 0
    total: int = 0
    share: float | None = None

    def __str__(self) -> str:
        """Say it.

        >>> str(Step("node solids", 2, 9, 3, 8))
        '2 of 9: node solids, 3 of 8'
        """
        place = f"{self.number} of {self.stages}: " if self.stages > 1 else ""
        return f"{place}{self.stage}" + (f", {self.done} of {self.total}" if self.total else "")


Tell = Callable[[Step], None]
"""Told every step of a run."""


@dataclass(frozen=True)
class Stage:
    """A stage and what it is expected to cost, in seconds of the machine on which that was measured."""

    name: str
    seconds: float = 0.0


def tell_nobody(_: Step) -> None:
    """Tell nobody."""


def count_for_nobody(_: int, __: int) -> None:
    """Count for nobody."""


@dataclass(frozen=True)
class Course:
    """The stages of a run in their order, and who is told as it goes through them; `shape` stands before their names.

    The share of work that is done is known once stages have seconds.
    """

    stages: tuple[Stage, ...] = ()
    tell: Tell = tell_nobody
    shape: str = ""

    def of(self, shape: str) -> Course:
        """Give the course of one of several shapes."""
        return replace(self, shape=shape)

    def begin(self, name: str) -> Told:
        """Tell that a stage begins, and give whom to tell how much of it is done."""
        name = stage_name(self.shape, name)
        place = [stage.name for stage in self.stages].index(name) if self.stages else 0
        step = Step(name, place + 1, len(self.stages))

        def told(done: int, total: int) -> None:
            share = self._share(place, done / total if total else 0.0)
            self.tell(replace(step, done=done, total=total, share=share))

        told(0, 0)
        return told

    def _share(self, place: int, part: float) -> float | None:
        """Give the share of all work that is done when a part of the stage at a place is."""
        seconds = [stage.seconds for stage in self.stages]
        if not any(seconds):
            return None
        return (sum(seconds[:place]) + part * seconds[place]) / sum(seconds)


UNTOLD = Course()
"""That of a run of which nobody is told."""


def stage_name(shape: str, name: str) -> str:
    """Name the stage of a shape.

    >>> stage_name("", "nesting"), stage_name("tower", "nesting")
    ('nesting', 'tower: nesting')
    """
    return f"{shape}: {name}" if shape else name


def counted(items: Collection[Item], told: Told) -> Iterator[Item]:
    """Give items one by one, and tell as the next is asked for that one more is done.

    >>> list(counted("ab", print))
    1 2
    2 2
    ['a', 'b']
    """
    yield from counted_to(len(items), items, told)


def counted_to(total: int, items: Iterable[Item], told: Told) -> Iterator[Item]:
    """Give as many items as are said one by one, as `counted` does."""
    for done, item in enumerate(items, start=1):
        yield item
        told(done, total)
