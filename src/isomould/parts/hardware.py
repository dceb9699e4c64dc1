"""What is bought: hexagon bolts with nuts and washers, by exact size (ISO 4014, 4017, 4032, 7089)."""

import csv
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Annotated

from pydantic import AfterValidator

_TABLE = Path(__file__).with_name("bolts.csv")

LENGTHS = (*range(20, 70, 5), *range(70, 160, 10), *range(160, 520, 20))
"""Nominal lengths of hexagon bolts, mm."""


@dataclass(frozen=True)
class Bolt:
    """Sizes of a bolt with its nut and washer, mm; `tool` is the outer diameter of a socket."""

    size: str
    diameter: float
    pitch: float
    clearance_hole: float
    head_height: float
    across_corners: float
    nut_height: float
    washer_diameter: float
    washer_thickness: float
    tool: float


@dataclass(frozen=True)
class Item:
    """Bought parts of one kind that go with one node or member: `quantity` per piece."""

    item: str
    size: str
    standard: str
    quantity: int


def gather(items: Iterable[Item]) -> tuple[Item, ...]:
    """Count equal items together, in the order in which they come first.

    >>> gather([Item("nut", "M12", "ISO 4032", 2)] * 3)
    (Item(item='nut', size='M12', standard='ISO 4032', quantity=6),)
    """
    found: dict[tuple[str, str, str], int] = {}
    for each in items:
        key = (each.item, each.size, each.standard)
        found[key] = found.get(key, 0) + each.quantity
    return tuple(Item(*key, quantity) for key, quantity in found.items())


def find_bolt(size: str) -> Bolt:
    """Look a bolt up by its exact size.

    Examples
    --------
    >>> find_bolt("M16").washer_diameter
    30.0
    """
    return _bolts()[size]


def next_length(least: float) -> int | None:
    """Give the shortest nominal length (mm) that is enough, or None beyond the longest.

    >>> next_length(67.5), next_length(20), next_length(501)
    (70, 20, None)
    """
    return next((length for length in LENGTHS if length >= least - 1e-9), None)


@cache
def _bolts() -> dict[str, Bolt]:
    with _TABLE.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    names = [name for name in rows[0] if name != "size"]
    return {
        row["size"]: Bolt(row["size"], **{name.removesuffix("_mm"): float(row[name]) for name in names}) for row in rows
    }


def _known(size: str) -> str:
    if size not in _bolts():
        message = f"{size!r} is no bolt of the table; one of {', '.join(_bolts())}"
        raise ValueError(message)
    return size


BoltSize = Annotated[str, AfterValidator(_known)]
"""The size of a bolt that the table holds."""
