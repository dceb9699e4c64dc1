"""Which way round an arc goes: counter-clockwise from its start to its end, whatever the angles are written as."""

import math

FULL = 2 * math.pi

ALMOST_FULL = 1e-5
"""Turns this near to a full one are full, rad: six digits of 2π lose up to 5e-6, four decimals of degrees 2e-6."""


def counter_clockwise(start: float, end: float) -> tuple[float, float]:
    """Give the range of an arc in rad, its end above its start by the turn.

    The turn is (end − start) mod 2π, a full one where that is nearly none or nearly full.
    An end just above its start is a tiny arc, as every CAD program draws it.

    Raises
    ------
    ValueError
        If the end lies more than a turn above the start, is the start, or a number is not finite.

    Examples
    --------
    >>> [round(math.degrees(angle)) for angle in counter_clockwise(math.radians(450), math.radians(30))]
    [450, 750]
    """
    span = end - start
    if not math.isfinite(span):
        message = f"an arc from {start:g} to {end:g}"
        raise ValueError(message)
    if span == 0:
        message = "an arc that ends where it starts: a point or a full circle"
        raise ValueError(message)
    if span > FULL + ALMOST_FULL:
        message = f"an arc over {math.degrees(span):g} degrees"
        raise ValueError(message)
    if 0 < span < FULL - ALMOST_FULL:
        return start, end
    turn = span % FULL
    is_full = turn < ALMOST_FULL or FULL - turn < ALMOST_FULL
    return start, start + (FULL if is_full else turn)
