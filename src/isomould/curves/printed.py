"""What the printing of a file loses: programs that write six significant digits move every point a little."""

import re
from collections.abc import Iterable
from decimal import Decimal, InvalidOperation
from typing import NamedTuple

SIX = 6
"""Significant digits of C's %g, which FreeCAD and many others print coordinates with."""

_WITNESSES = 3
"""Different numbers of just six digits that show that no more were printed; one may be meant so."""

_EXPONENT = re.compile(r"[eE].*")


class PrintedAngle(NamedTuple):
    """An angle as it is printed, the radius that it is swung with, and the size of its unit in rad."""

    text: str
    radius: float
    unit: float


def lost_in_print(texts: Iterable[str], angles: Iterable[PrintedAngle] = ()) -> float:
    """Give what a file of six digits loses: one unit of the sixth digit of the largest coordinate, or of an angle.

    Files that print more digits, or too few numbers to tell, lose nothing.

    >>> lost_in_print(["8942.66", "-1420.72", "7760.58", "0"])
    0.01
    >>> lost_in_print(["24000", "24000.001", "8000"])
    0.0
    """
    different = set(texts)
    digits = [_digits(text) for text in different]
    if max(digits, default=0) != SIX or digits.count(SIX) < _WITNESSES:
        return 0.0
    along = max(_sixth(text) for text in different)
    around = max((_sixth(angle.text) * angle.unit * angle.radius for angle in angles), default=0.0)
    return max(along, around)


def _sixth(text: str) -> float:
    """Give one unit of the sixth significant digit of a printed number."""
    number = _number(text)
    return float(Decimal(1).scaleb(number.adjusted() - SIX + 1)) if number else 0.0


def _number(text: str) -> Decimal:
    """Read a printed number; what is none counts as 0 here, and is refused where it is interpreted."""
    try:
        number = Decimal(text.strip())
    except InvalidOperation:
        return Decimal(0)
    return number if number.is_finite() else Decimal(0)


def _digits(text: str) -> int:
    """Count the significant digits of a printed number, zeros at its end aside."""
    mantissa = _EXPONENT.sub("", text.strip()).lstrip("+-")
    return len(mantissa.replace(".", "").strip("0")) if "." in mantissa else len(mantissa.strip("0"))
