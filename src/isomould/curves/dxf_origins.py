"""Remote drawings read from a whole metre near them, subtracted from the digits of the file before they are doubles.

A northing of seven digits in metres, as a double, is off by up to half a millionth of a millimetre; its digits are not.
"""

from collections.abc import Iterable
from decimal import Decimal, InvalidOperation
from typing import NamedTuple

from isomould.curves.dxf_records import Record, Tag
from isomould.curves.origins import REMOTE, WHOLE

_X, _Y = (10, 11), (20, 21)

_ENDS_TOO = {"LINE", "SPLINE"}
"""Entities whose second point, code 11, is a place; of an ellipse it is a direction."""

_PLACED = {"LINE", "CIRCLE", "ARC", "ELLIPSE", "LWPOLYLINE", "VERTEX", "SPLINE", "INSERT"}

_IN_WORLD = {"LINE", "ELLIPSE", "SPLINE"}
"""Entities that have no coordinate system of their own."""


class Far(NamedTuple):
    """An origin in the drawing's units."""

    x: Decimal = Decimal(0)
    y: Decimal = Decimal(0)

    def __bool__(self) -> bool:
        """Tell whether it is another origin than the drawing's own."""
        return bool(self.x or self.y)


NEAR = Far()
"""The drawing's own origin."""


def far_of(records: Iterable[Record], mm: float) -> Far:
    """Give the origin for what some records draw, in a unit of so many mm; `NEAR` unless that is remote."""
    places = [tag for record in records if _is_level(record) for tag in record.tags if _is_place(record, tag)]
    along = ([_number(tag.value) for tag in places if tag.code in codes] for codes in (_X, _Y))
    return Far(*(_whole(numbers, mm) for numbers in along))


def brought_near(record: Record, far: Far, in_world: bool) -> Record:
    """Give the record with its places measured from an origin, digit by digit.

    `in_world` says of a vertex whether it is a point of the world.
    """
    if not far or not (_is_level(record) or in_world):
        return record
    tags = tuple(_moved(tag, far) if _is_place(record, tag) else tag for tag in record.tags)
    return Record(record.kind, tags, record.line)


def _is_level(record: Record) -> bool:
    """Tell whether x and y of a record are the drawing's own."""
    if record.kind in _IN_WORLD:
        return True
    extrusion = [_number(record.first(code, default)) for code, default in ((210, "0"), (220, "0"), (230, "1"))]
    return extrusion[0] == extrusion[1] == 0 and extrusion[2] > 0


def _is_place(record: Record, tag: Tag) -> bool:
    if record.kind not in _PLACED:
        return False
    return tag.code in (10, 20) or (tag.code in (11, 21) and record.kind in _ENDS_TOO)


def _moved(tag: Tag, far: Far) -> Tag:
    step = far.x if tag.code in _X else far.y
    try:
        return Tag(tag.code, str(Decimal(tag.value) - step))
    except InvalidOperation:
        # no number: whoever interprets the entity says so
        return tag


def _whole(numbers: list[Decimal], mm: float) -> Decimal:
    finite = [number for number in numbers if number.is_finite()]
    if not finite or float(max(abs(number) for number in finite)) * mm <= REMOTE:
        return Decimal(0)
    step = Decimal(max(round(WHOLE / mm), 1))
    return step * round(min(finite) / step)


def _number(text: str) -> Decimal:
    try:
        return Decimal(text)
    except InvalidOperation:
        return Decimal("nan")
