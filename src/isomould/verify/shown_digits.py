"""Numbers that people see, held against the numbers that they stand for."""

import math
from decimal import Decimal, InvalidOperation

_DECIMALS = {"mm": 1, "°": 2, "m²": 2, "m": 2, "kg": 1, "t": 2, "%": 1, "cm³": 1, "h": 1}
"""What `docs/deliverables.md` promises, by unit."""

_ELSE = 2
"""Of ratios and money."""

_TONNE = Decimal(1000)
"""From this mass (kg) on, whole kilograms."""

_SIGNIFICANT = 3
"""Digits of what is smaller than half a unit of the last decimal."""

_HALF = Decimal("0.5005")
"""Of a unit of the last digit: numbers are snapped three digits further before they are rounded (failure mode E5)."""


def shows(text: str, value: float, unit: str) -> bool:
    """Tell whether a text is a value to the digits of its unit, and right in every digit that it has.

    >>> shows("1234.6", 1234.5678, "mm"), shows("1235", 1234.5678, "mm"), shows("1234.55", 1234.5678, "mm")
    (True, False, False)
    >>> shows("4322", 4321.6, "kg"), shows("8", 7.0, ""), shows("2.5e-12", 2.5e-12, "mm"), shows("0.0", 2.5e-12, "mm")
    (True, False, True, False)
    """
    try:
        number = Decimal(text)
    except InvalidOperation:
        return False
    exponent = number.as_tuple().exponent
    if not (isinstance(exponent, int) and math.isfinite(value)):  # infinite, or no number
        return False
    exact = Decimal(repr(float(value)))
    return abs(number - exact) <= _HALF.scaleb(min(exponent, _last_place(exact, unit)))


def _last_place(exact: Decimal, unit: str) -> int:
    """Give the power of ten of the last digit that is due."""
    if unit not in _DECIMALS and exact == exact.to_integral_value():
        return 0
    heavy = unit == "kg" and abs(exact) >= _TONNE
    place = 0 if heavy else -_DECIMALS.get(unit, _ELSE)
    is_residual = 0 < abs(exact) < Decimal("0.5").scaleb(place)
    return exact.adjusted() - _SIGNIFICANT + 1 if is_residual else place
