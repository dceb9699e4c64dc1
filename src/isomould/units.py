"""Lengths with units, parsed once at the border: inside the program every length is in mm."""

import re
import unicodedata
from fractions import Fraction
from typing import Annotated, Literal

from pydantic import AfterValidator, BeforeValidator, Strict

LengthUnit = Literal["mm", "cm", "m", "in", "ft"]

MassUnit = Literal["kg/m", "kg/m2"]
"""Of profiles and plates in machine files."""

MM_PER_UNIT: dict[str, float] = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "in": 25.4, "ft": 304.8}

LARGEST = 1e12
"""Of numbers without a unit: coordinates, weights, angles, prices."""

LONGEST = 1e9
"""Lengths beyond a thousand kilometres, in mm, are slips of the pen."""

FARTHEST = 1e11
"""Places on maps lie within a hundred thousand kilometres of their origin, mm; there a float resolves 0.00002 mm."""

SHORTEST = 0.001
"""Outlines are multiples of it, mm: nothing that has a size is smaller."""

LEAST = 1e-9
"""Of positive numbers without a unit."""

_LONGEST_TEXT = 64
"""Characters of a length: longer ones are no numbers that people write."""

UNIT_WORDS: dict[str, LengthUnit] = {
    **dict.fromkeys(("mm", "millimeter", "millimetre", "millimeters", "millimetres"), "mm"),
    **dict.fromkeys(("cm", "centimeter", "centimetre", "centimeters", "centimetres"), "cm"),
    **dict.fromkeys(("m", "meter", "metre", "meters", "metres"), "m"),
    **dict.fromkeys(("in", "inch", "inches", "zoll", '"', "″", "”", "''"), "in"),
    **dict.fromkeys(("ft", "foot", "feet", "'", "′", "’"), "ft"),
}
"""How units are written: on drawings, in cells and in headings."""

_EXPONENT = r"(?:[eE][+-]?\d{1,3})?"
_NUMBER = rf"\d+[\s-]+\d+/[1-9]\d*|\d+/[1-9]\d*|\d+\.?\d*{_EXPONENT}|\.\d+{_EXPONENT}"
_UNIT = r"[a-zA-Z]+|\"|″|”|''|'|′|’"
_ONE = re.compile(rf"(?P<sign>[+-]?)\s*(?P<number>{_NUMBER})\s*(?P<unit>{_UNIT})?\.?")
_FEET = re.compile(
    r"(?P<sign>[+-]?)\s*(?P<feet>\d+)\s*(?:'|′|’|ft\.?|feet|foot)[\s-]*"
    rf"(?P<number>{_NUMBER})\s*(?P<unit>{_UNIT})?\.?"
)

_INCHES_PER_FOOT = 12

Written = tuple[Fraction, LengthUnit | None]
"""A number and its unit; None where it has none."""


def read_length(text: str) -> Written | None:
    """Give number and unit of a length as people write it, feet and inches together as inches; None if it is none.

    >>> read_length('27 7/8"') == (Fraction(223, 8), "in"), read_length("650 mm")
    (True, (Fraction(650, 1), 'mm'))
    >>> read_length("12 ft 3½ in") == (Fraction(295, 2), "in"), read_length("5½"), read_length("a few")
    (True, (Fraction(11, 2), None), None)
    """
    if len(text) > _LONGEST_TEXT:
        return None
    text = _spell_out(text)
    feet = _FEET.fullmatch(text)
    match = feet or _ONE.fullmatch(text)
    if match is None:
        return None
    unit = UNIT_WORDS.get((match["unit"] or "").casefold())
    if match["unit"] and unit is None:
        return None
    number = sum(Fraction(part) for part in re.split(r"[\s-]+(?=\d+/)", match["number"]))
    if feet is not None:
        # Twelve inches are another foot: 1'90 is a slip, or thousands that are written in Swiss style.
        if unit not in (None, "in") or number >= _INCHES_PER_FOOT:
            return None
        number, unit = number + _INCHES_PER_FOOT * Fraction(feet["feet"]), "in"
    return Fraction(-number if match["sign"] == "-" else number), unit


def in_mm(number: Fraction, unit: LengthUnit) -> Fraction:
    """Give a length in mm, exactly."""
    return number * Fraction(str(MM_PER_UNIT[unit]))


def _spell_out(text: str) -> str:
    """Write 5½ as 5 1/2."""
    signs = (f" {unicodedata.normalize('NFKC', sign)}" if unicodedata.category(sign) == "No" else sign for sign in text)
    return "".join(signs).replace("\u2044", "/").strip()


def parse_length(value: object) -> float:
    """Give a length in mm from a number (mm) or a string with a unit.

    Raises
    ------
    ValueError
        If the value is not a finite number, or a string without a known unit.

    Examples
    --------
    >>> parse_length("24 m"), parse_length("1 1/2 in"), parse_length(12)
    (24000.0, 38.1, 12.0)
    """
    return _parse(value, LONGEST)


def parse_coordinate(value: object) -> float:
    """Give a coordinate on a map in mm: written as a length is, but it may be larger.

    >>> parse_coordinate("5332417.25 m")
    5332417250.0
    """
    return _parse(value, FARTHEST)


def _parse(value: object, limit: float) -> float:
    if isinstance(value, str):
        return _finite(_parse_text(value), value, limit)
    if isinstance(value, bool) or not isinstance(value, int | float):
        message = f"{value!r} is not a length; a number in mm or a text such as '24 m'"
        raise ValueError(message)
    return _finite(value, value, limit)


def _parse_text(text: str) -> Fraction:
    if re.search(r"\d,\d", text):
        message = f"{text!r} has a decimal comma; a decimal point"
        raise ValueError(message)
    number, unit = read_length(text) or (Fraction(0), None)
    if unit is None:
        shown, units = text[:_LONGEST_TEXT], ", ".join(MM_PER_UNIT)
        message = f"{shown!r} is not a length; a number and one of {units}, such as '24 m'"
        raise ValueError(message)
    return in_mm(number, unit)


def _finite(length: float | Fraction, value: object, limit: float) -> float:
    """Compare before converting: whole numbers and fractions may be larger than any float."""
    if not abs(length) <= limit:
        message = f"{str(value)[:24]!r} is not a length that can be built; at most {limit:g} mm"
        raise ValueError(message)
    return float(length)


def _positive(value: float) -> float:
    if value <= 0:
        message = "must be greater than zero"
        raise ValueError(message)
    if value < LEAST:
        message = f"must be at least {LEAST:g}"
        raise ValueError(message)
    return value


def _positive_length(value: float) -> float:
    return _measurable(_positive(value))


def _length_or_none(value: float) -> float:
    return _measurable(_not_negative(value))


def _measurable(value: float) -> float:
    if 0 < value < SHORTEST:
        message = f"must be at least {SHORTEST:g} mm, to which parts are made"
        raise ValueError(message)
    return value


def _not_negative(value: float) -> float:
    if value < 0:
        message = "must be at least 0"
        raise ValueError(message)
    return value


def _sized(value: float) -> float:
    if abs(value) > LARGEST:
        message = f"must lie between -{LARGEST:g} and {LARGEST:g}"
        raise ValueError(message)
    return value


Number = Annotated[float, Strict(), AfterValidator(_sized)]
"""A float (or integer) whose square is far from overflowing, never a bool or a string."""
PositiveNumber = Annotated[Number, AfterValidator(_positive)]
NonNegativeNumber = Annotated[Number, AfterValidator(_not_negative)]
Count = Annotated[int, Strict(), AfterValidator(_sized)]
"""An integer, never a bool, a float or a string."""
Flag = Annotated[bool, Strict()]
Length = Annotated[float, BeforeValidator(parse_length)]
Coordinate = Annotated[float, BeforeValidator(parse_coordinate)]
"""A length in mm; accepts a number in mm or a string with a unit."""
PositiveLength = Annotated[Length, AfterValidator(_positive_length)]
"""A length that something is made to."""
Tolerance = Annotated[Length, AfterValidator(_positive)]
"""A length by which two things may differ: it may be far smaller than anything that is made."""
NonNegativeLength = Annotated[Length, AfterValidator(_length_or_none)]
