"""Numbers of schedules and drawings: rounded once, printed by one function."""

import numpy as np

from isomould.arrays import Floats

_EXACT = 2.0**52
"""Beyond it a float resolves no fractions, and rounding would only add noise."""
_DIGITS = 15
"""Significant digits that every program keeps, Excel among them; large areas have no room for all their decimals."""
_SNAP = 3
_SIGNIFICANT = 6


def round_to(values: Floats, decimals: int | None) -> Floats:
    """Round numbers for a schedule, half to even; NaN stays and a negative zero goes.

    Values are snapped three decimals further first, as `isomould.arrays.round_um` does, so that
    ties fall to the same side on every machine (failure mode E5).

    Parameters
    ----------
    values : (n,) float
    decimals : int or None
        None keeps six significant digits, for residuals of any magnitude.

    Examples
    --------
    >>> round_to(np.array([1234.56789, -0.0001, 2e-13]), 3)
    array([1234.568,    0.   ,    0.   ])
    >>> round_to(np.array([1.23456789e-14]), None)
    array([1.23457e-14])
    >>> round_to(np.array([12345.678901234567]), 12).tolist()
    [12345.6789012346]
    """
    if decimals is None:
        return np.array([float(f"{value:.{_SIGNIFICANT}g}") for value in values], dtype=float)
    fine = values * 10.0 ** (decimals + _SNAP)
    resolved = np.abs(fine) < _EXACT
    whole = np.rint(np.where(resolved, np.rint(fine) / 10.0**_SNAP, values * 10.0**decimals))
    rounded = np.where(np.abs(whole) < _EXACT, whole / 10.0**decimals, values) + 0.0
    long = np.abs(whole) >= 10.0**_DIGITS
    rounded[long] = [float(f"{value:.{_DIGITS}g}") for value in values[long]]
    return rounded


def format_number(value: float, decimals: int | None = None) -> str:
    """Print a number: decimal point, no exponent, no trailing zeros, never "-0".

    `decimals` rounds first; without it the number is printed as it is, which is what a value that
    `round_to` has already rounded needs. The text reads back to the very same float.

    Examples
    --------
    >>> format_number(1234.5), format_number(1e-6), format_number(-0.0004, 3), format_number(12)
    ('1234.5', '0.000001', '0', '12')
    """
    rounded = float(value) if decimals is None else float(round_to(np.array([value]), decimals)[0])
    text = repr(rounded + 0.0)
    return np.format_float_positional(rounded, trim="-") if "e" in text else text.removesuffix(".0")
