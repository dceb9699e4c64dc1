"""What columns of part lists may mean, what a user says of a table, and a row of it."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from isomould.intake.part_rows import TRAPEZOID
from isomould.units import LengthUnit


@dataclass(frozen=True)
class Words:
    """What the columns of a table may be: lengths, and others."""

    lengths: tuple[str, ...]
    others: tuple[str, ...]

    @property
    def known(self) -> frozenset[str]:
        """All columns that mean something."""
        return frozenset((*self.lengths, *self.others))


_COMMON = ("id", "quantity", "material", "grade", "enabled", "unit")
PARTS = Words(
    (*TRAPEZOID, "length", "width", "height", "thickness"),
    (*_COMMON, "row", "points", "files", "grain", "turn", "section"),
)
MEMBERS = Words(("length", "depth"), (*_COMMON, "section", "end_angle_start", "end_angle_end"))


@dataclass(frozen=True)
class Reading:
    """What a user says of a table: the unit of lengths without one, and headings by what they mean."""

    units: LengthUnit | None = None
    columns: Mapping[str, str] = field(default_factory=dict[str, str])


@dataclass(frozen=True)
class Line:
    """A row of a table: its cells by what they mean, and how messages call it."""

    cells: Mapping[str, str]
    field: str
