"""Orders and choices that rounding noise cannot turn: what differs by noise only is equal, and the first one wins.

Processors round the same formula differently in the last digits. Where many values are equal by design, as in all
symmetric buildings, those digits would decide which comes first. Whatever puts values in an order or picks one
of them asks here, unless the values are whole numbers or rounded already.
"""

import numpy as np

from isomould.arrays import Floats, Ints

NOISE = 1e-6
"""Values that differ by less are equal: mm, or steps of whatever is counted."""

FINE = 1e-9
"""The same for angles in rad, shares of a length, and components of unit vectors."""


def ranks(values: Floats, noise: float = NOISE) -> Ints:
    """Number values (n,) by size from 0; values that are equal but for noise share a number.

    >>> ranks(np.array([2.0, 1.0, 2.0 + 1e-12])).tolist()
    [1, 0, 1]
    """
    order = np.argsort(values, kind="stable")
    # infinite values have no difference; they are equal to each other only
    steps = np.diff(np.nan_to_num(values[order], posinf=np.finfo(float).max / 4, neginf=-np.finfo(float).max / 4))
    result = np.zeros(len(values), dtype=np.int64)
    result[order[1:]] = np.cumsum(steps > noise)
    return result


def in_order(values: Floats, noise: float = NOISE) -> Ints:
    """Give the places (n,) of values from the smallest to the largest; of equal ones the first comes first.

    >>> in_order(np.array([2.0 + 1e-12, 1.0, 2.0])).tolist()
    [1, 0, 2]
    """
    return np.argsort(ranks(values, noise), kind="stable")


def first_least(values: Floats, noise: float = NOISE) -> int:
    """Give the place of the first of the smallest values (n,).

    >>> first_least(np.array([3.0, 1.0 + 1e-12, 1.0]))
    1
    """
    return int(np.argmax(values <= values.min() + noise))


def first_largest(values: Floats, noise: float = NOISE) -> int:
    """Give the place of the first of the largest values (n,).

    >>> first_largest(np.array([3.0 - 1e-12, 1.0, 3.0]))
    0
    """
    return int(np.argmax(values >= values.max() - noise))


def first_least_of_rows(values: Floats, noise: float = NOISE) -> Ints:
    """Give the place (n,) of the first of the smallest values in every row of (n, k).

    >>> first_least_of_rows(np.array([[1.0 + 1e-12, 1.0], [2.0, 0.0]])).tolist()
    [0, 1]
    """
    return np.argmax(values <= values.min(axis=1, keepdims=True) + noise, axis=1)
