"""Polynomials on [0, 1] in Bernstein form: the numbers behind a Bézier curve's inflections and cusps.

A polynomial of degree n is its `(n + 1,) float` coefficients. Sums need equal degrees. The Bernstein form
is kept throughout because its coefficients bound the polynomial and their sign variations bound its roots.
"""

from functools import cache, partial
from itertools import pairwise

import numpy as np
from scipy.optimize import brentq
from scipy.special import comb

from isomould.arrays import Floats, read_only

ROUNDING = 1e-13
"""Values below this share of the largest term are rounding noise, not signs."""

_FINEST = 2.0**-20


def product(a: Floats, b: Floats) -> Floats:
    """Multiply two polynomials; the degrees add up.

    >>> product(np.array([0.0, 1.0]), np.array([0.0, 1.0]))
    array([0., 0., 1.])
    """
    return np.convolve(a * _binomials(a.size - 1), b * _binomials(b.size - 1)) / _binomials(a.size + b.size - 2)


def slope(a: Floats) -> Floats:
    """Differentiate; the degree falls by one."""
    return (a.size - 1) * np.diff(a)


def value(a: Floats, t: float) -> float:
    """Evaluate by de Casteljau's algorithm.

    >>> value(np.array([0.0, 0.0, 1.0]), 0.5)
    0.25
    """
    for _ in range(a.size - 1):
        a = (1 - t) * a[:-1] + t * a[1:]
    return float(a[0])


def sign_changes(a: Floats, scale: float) -> list[float]:
    """Find the parameters in (0, 1) where the polynomial changes its sign.

    Roots of even multiplicity are none, whether rounding parts them into two or not: a value below
    `ROUNDING * scale` has no sign.

    Parameters
    ----------
    a : (n + 1,) float
    scale : float
        Largest size of the terms that `a` was summed from.

    Examples
    --------
    >>> sign_changes(np.array([-1.0, 1.0]), 1.0), sign_changes(np.array([0.25, -0.25, 0.25]), 1.0)
    ([0.5], [])
    """
    noise = ROUNDING * scale
    marks = np.unique(_candidates(a, 0.0, 1.0, noise))
    return _crossed(a, marks, noise) if marks.size else []


def _crossed(a: Floats, marks: Floats, noise: float) -> list[float]:
    """Keep of the sorted candidates those with opposite signs on their sides."""
    fences = np.concatenate([[0.0], marks, [1.0]])
    signs = np.array([_sign(value(a, t), noise) for t in (fences[:-1] + fences[1:]) / 2])
    seen = np.flatnonzero(signs)
    return [float(marks[i:j].mean()) for i, j in pairwise(seen) if signs[i] != signs[j]]


def _candidates(a: Floats, low: float, high: float, noise: float) -> list[float]:
    """Collect places where the sign may change, by halving until Descartes' rule decides."""
    middle, variations = (low + high) / 2, _variations(a, noise)
    if np.abs(a).max() <= noise or (variations and high - low < _FINEST):
        return [middle]
    if variations == 0:
        return []
    if variations == 1 and min(abs(a[0]), abs(a[-1])) > noise:
        return [low + (high - low) * _root(a)]
    left, right = _halves(a)
    between = [middle] if abs(right[0]) <= noise else []
    return _candidates(left, low, middle, noise) + between + _candidates(right, middle, high, noise)


def _root(a: Floats) -> float:
    """Find the one root between coefficients of opposite sign at the ends."""
    return float(brentq(partial(value, a), 0.0, 1.0, xtol=1e-16))


def _halves(a: Floats) -> tuple[Floats, Floats]:
    left, right = np.empty_like(a), np.empty_like(a)
    for k in range(a.size):
        left[k], right[-1 - k] = a[0], a[-1]
        a = (a[:-1] + a[1:]) / 2
    return left, right


def _variations(a: Floats, noise: float) -> int:
    positive = a[np.abs(a) > noise] > 0
    return int(np.count_nonzero(positive[1:] != positive[:-1]))


def _sign(number: float, noise: float) -> int:
    return 0 if abs(number) <= noise else (1 if number > 0 else -1)


@cache
def _binomials(n: int) -> Floats:
    return read_only(np.asarray(comb(n, np.arange(n + 1)), dtype=float))
