"""The errors and notes that users see.

A refusal names the field (or file and entity), the value found with its unit, the limit and a way
out. The library raises these and never prints or exits; `isomould.cli` turns them into one message
and an exit code.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from types import TracebackType
from typing import Generic, ParamSpec, TypeVar

P = ParamSpec("P")
T = TypeVar("T")

_LONGEST = 600
"""Characters of what was found; a message is read by people."""

_MOST = 24
"""Refusals that are listed together; the others are counted."""


class IsomouldError(Exception):
    """Base of every error that is meant for users; `exit_code` is what the command line returns."""

    exit_code = 2


class Refused(IsomouldError):
    """Input that would lead to a wrong or impossible part.

    >>> raise Refused("E-RAIL-01", "rail.divide.nodes", "1 node", "at least 3", "Give more nodes.")
    Traceback (most recent call last):
    isomould.errors.Refused: E-RAIL-01 rail.divide.nodes: 1 node. Limit: at least 3. Give more nodes.
    """

    def __init__(self, code: str, field: str, found: str, limit: str, way_out: str) -> None:
        found = found if len(found) <= _LONGEST else f"{found[:_LONGEST]} …"
        super().__init__(f"{code} {field}: {found}. Limit: {limit}. {way_out}")
        self.code, self.field, self.found, self.limit, self.way_out = code, field, found, limit, way_out

    def __reduce__(self) -> tuple[type["Refused"], tuple[str, ...]]:
        """Travel between processes by the five texts, not by the message made of them."""
        return type(self), (self.code, self.field, self.found, self.limit, self.way_out)

    @property
    def each(self) -> tuple["Refused", ...]:
        """The refusals that this one stands for."""
        return (self,)

    def within(self, place: str) -> "Refused":
        """Give the refusal with the place of its field in front: `shapes (east): rail.divide`."""
        return Refused(self.code, f"{place}: {self.field}", self.found, self.limit, self.way_out)


class RefusedTogether(Refused):
    """Refusals that do not depend on each other, the gravest first: code, field and the rest are those of the first.

    >>> one = Refused("E-A", "rail", "none", "one", "Draw it.")
    >>> print(RefusedTogether([one, Refused("E-B", "stock", "none", "one", "Buy it.")]))
    E-A rail: none. Limit: one. Draw it.
    E-B stock: none. Limit: one. Buy it.
    """

    def __init__(self, refusals: Sequence[Refused]) -> None:
        first = refusals[0]
        super().__init__(first.code, first.field, first.found, first.limit, first.way_out)
        self._each = tuple(one for refused in refusals for one in refused.each)
        lines = [str(one) for one in self._each[:_MOST]]
        more = len(self._each) - len(lines)
        self.args = ("\n".join([*lines, f"and {more} more"] if more else lines),)

    def __reduce__(self) -> tuple[type["RefusedTogether"], tuple[tuple[Refused, ...]]]:  # pyright: ignore[reportIncompatibleMethodOverride]
        """Travel between processes by the refusals."""
        return type(self), (self._each,)

    @property
    def each(self) -> tuple[Refused, ...]:
        """The refusals, in their order."""
        return self._each

    def within(self, place: str) -> "RefusedTogether":
        """Give the refusals with the place of their fields in front."""
        return RefusedTogether([one.within(place) for one in self._each])


@dataclass(frozen=True)
class Attempt(Generic[T]):
    """What came of a piece of work: its result, or the refusal that ended it."""

    result: T | None
    refused: Refused | None = None

    @property
    def value(self) -> T:
        """The result.

        Raises
        ------
        Refused
            The one that ended the work: work that needs this result ends with it too.
        """
        if self.refused is not None:
            raise self.refused
        return self.result  # pyright: ignore[reportReturnType]


class Gathering:
    """Runs pieces of work and gathers their refusals, which end the `with` block together.

    Work is run in the order of the data, so that the gravest refusal comes first: what it decides is not yet known.
    Work that needs the result of other work asks for its `value` and ends quietly with it.

    >>> with Gathering() as gathering:
    ...     length = gathering.run(float, "12")
    ...     area = gathering.run(lambda: length.value**2)
    >>> area.value
    144.0
    """

    def __init__(self) -> None:
        self._found: list[Refused] = []

    def __enter__(self) -> "Gathering":
        return self

    def run(self, work: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> Attempt[T]:
        """Run a piece of work; a refusal of it is kept for the end."""
        try:
            return Attempt(work(*args, **kwargs))
        except Refused as refused:
            self._keep(refused)
            return Attempt(None, refused)

    def _keep(self, refused: Refused) -> None:
        """Keep a refusal once, however many pieces of work it ended."""
        known = {id(one) for one in self._found}
        self._found += [one for one in refused.each if id(one) not in known]

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Refuse what was gathered, with the refusal that ended the block itself."""
        if isinstance(error, Refused):
            self._keep(error)
        elif error is not None:
            return
        if len(self._found) > 1:
            raise RefusedTogether(self._found) from None
        if self._found:
            raise self._found[0] from None


class CertificateFailed(IsomouldError):
    """A delivered folder that does not prove what it claims."""

    exit_code = 1


class OutputFault(IsomouldError):
    """A file or folder that could not be read or written."""

    exit_code = 3


@dataclass(frozen=True)
class Note:
    """Something that the user should know and that does not stop the work.

    Printed by `check`, repeated on the Summary sheet.
    """

    code: str
    field: str
    text: str

    def __str__(self) -> str:
        return f"{self.code} {self.field}: {self.text}"
