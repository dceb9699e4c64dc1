"""Values of the workbook that stay alive: expressions with the value that they have, worded by `writers.formulas`.

>>> hours = Given(2.0) * RateCell("assembly", 60.0)
>>> hours.value
120.0
"""

import operator
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

Sign = Literal["+", "-", "*", "/"]
_APPLY = {"+": operator.add, "-": operator.sub, "*": operator.mul, "/": operator.truediv}


class Live:
    """An expression; `value` is what a spreadsheet would show for it."""

    @property
    def value(self) -> float:
        """What the expression gives."""
        raise NotImplementedError(type(self).__name__)

    def __add__(self, other: "Live") -> "Joint":
        return Joint("+", self, other)

    def __sub__(self, other: "Live") -> "Joint":
        return Joint("-", self, other)

    def __mul__(self, other: "Live") -> "Joint":
        return Joint("*", self, other)

    def __truediv__(self, other: "Live") -> "Joint":
        return Joint("/", self, other)


@dataclass(frozen=True)
class Given(Live):
    """A number that never changes, such as a factor between units."""

    number: float

    @property
    def value(self) -> float:
        """The number."""
        return self.number


@dataclass(frozen=True)
class RateCell(Live):
    """The input cell of a rate; a blank one counts as 0."""

    code: str
    given: float | None

    @property
    def value(self) -> float:
        """The rate."""
        return self.given or 0.0


@dataclass(frozen=True)
class NamedCell(Live):
    """A cell with a defined name, that shows `of`."""

    name: str
    of: Live

    @property
    def value(self) -> float:
        """What the cell shows."""
        return self.of.value


@dataclass(frozen=True)
class Here(Live):
    """Another cell of the same row, by its column's name."""

    column: str
    shown: float

    @property
    def value(self) -> float:
        """What the cell shows."""
        return self.shown


@dataclass(frozen=True)
class Joint(Live):
    """Two expressions and the sign between them."""

    sign: Sign
    left: Live
    right: Live

    @property
    def value(self) -> float:
        """The result."""
        return float(_APPLY[self.sign](self.left.value, self.right.value))


def add_up(values: Sequence[Live]) -> Live:
    """Give the sum of one or more expressions.

    >>> add_up([Given(1.0), Given(2.0), Given(4.0)]).value
    7.0
    """
    first, *others = values
    return Joint("+", add_up(values[:-1]), values[-1]) if others else first
