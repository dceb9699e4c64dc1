"""Which instances are the same part: complete-linkage classes of equivalent descriptions (geometry §7).

An instance has several equal descriptions (*variants*): a node may be read from any of its arms, a plate turned over
or end for end, a panel's outline started at any corner. A description is a row of numbers with tolerances
and a row of labels that must be equal. Two instances are the same part if some variant of one agrees with
the other's. A class holds max − min ≤ tolerance in every number: never a chain of neighbours.
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from isomould.arrays import Bools, Floats, Ints, read_only
from isomould.ties import FINE, first_least, in_order

Handed = Literal["none", "L", "R"]
"""Chirality of a part: its mirror image is another part, unless it is none."""

_SNAP = 1e-6
"""mm or rad: differences below it are rounding noise when equal descriptions are looked for."""


@dataclass(frozen=True, eq=False)
class Classes:
    """Instances sorted into classes, numbered by their first instance.

    Attributes
    ----------
    of : (n,) int
        Class of each instance.
    variant : (n,) int
        The variant of the instance that agrees with the class's canonical one.
    representative : (k,) int
        The instance that each class is made from: its first.
    canonical : (k,) int
        The representative's variant that describes the class.
    deviation : (n, q) float
        Absolute differences between the instance's agreeing variant and the class's description; the largest of them
        where groups were joined.
    """

    of: Ints
    variant: Ints
    representative: Ints
    canonical: Ints
    deviation: Floats

    def __post_init__(self) -> None:
        for value in vars(self).values():
            read_only(value)

    @property
    def quantity(self) -> Ints:
        """Number of instances (k,) of each class."""
        return np.bincount(self.of, minlength=len(self.representative))


def classify(
    numbers: Floats, labels: Ints, tolerance: Floats, order: Ints | None = None, held: Floats | None = None
) -> Classes:
    """Sort instances into classes.

    Parameters
    ----------
    numbers : (n, s, q) float
        The s variants of every instance.
    labels : (n, s, r) int
        Labels of each variant; they must agree exactly.
    tolerance : (q,) float
        Largest admissible spread of each number within a class.
    order : (q + r,) int, optional
        Describe a class by the smallest variant of its representative, reading numbers and then labels in this
        order; without it by the representative as it stands (variant 0).
    held : (n, s, q) float, optional
        What a class holds within the tolerance, where that is not what it is read by: the azimuths of a node from its
        arm 1, which are proved, and not its gaps, whose differences add up.
    """
    held = numbers if held is None else held
    best = smallest(numbers, labels, order)
    rows = np.arange(len(numbers))
    snapped = [_snapped(values[rows, best]) for values in (numbers, held)]
    _, first, proto = np.unique(
        np.concatenate([labels[rows, best], *snapped], axis=1), axis=0, return_index=True, return_inverse=True
    )
    size = np.abs(numbers[first, 0] / tolerance).sum(axis=1)
    merged = _merge(held[first], labels[first], best[first], tolerance, size)
    described = np.zeros_like(best) if order is None else best
    return _held_to_description(held, labels, described, merged[proto.ravel()], tolerance)


def smallest(numbers: Floats, labels: Ints, order: Ints | None = None) -> Ints:
    """Number (n,) of the lexicographically smallest variant, numbers and then labels read in an order, noise apart."""
    columns = np.concatenate([_snapped(numbers), labels], axis=2)
    columns = columns if order is None else columns[:, :, order]
    alive = np.ones(columns.shape[:2], dtype=bool)
    top = np.iinfo(np.int64).max
    for column in np.moveaxis(columns, 2, 0):
        value = np.where(alive, column, top)
        alive &= value == value.min(axis=1, keepdims=True)
    return np.argmax(alive, axis=1)


def handedness(
    own: tuple[Floats, Ints],
    mirror: tuple[Floats, Ints],
    tolerance: Floats,
    order: Ints | None = None,
    held: tuple[Floats, Floats] | None = None,
) -> tuple[Handed, ...]:
    """Tell the chirality (k,) of parts by their variants and those of their mirror images: of a pair, the smaller is L.

    Numbers within the tolerance are equal here too, in whatever order they are read: rounding noise decides nothing,
    and a part that agrees with its mirror image has no hand.

    Parameters
    ----------
    own, mirror
        Numbers (k, s, q) and labels (k, s, r).
    tolerance, order, held
        As for `classify`; `held` of both.
    """
    numbers, labels = (np.concatenate(pair, axis=1) for pair in zip(own, mirror, strict=True))
    left = np.arange(numbers.shape[1]) < own[0].shape[1]
    alive = np.ones(numbers.shape[:2], dtype=bool)
    columns = np.concatenate([numbers, labels], axis=2)
    slack = np.concatenate([tolerance + FINE, np.zeros(labels.shape[2])])
    for column in np.arange(columns.shape[2]) if order is None else order:
        value = np.where(alive, columns[..., column], np.inf)
        alive &= value <= value.min(axis=1, keepdims=True) + slack[column]
    same = (
        _agree(own, mirror, tolerance) if held is None else _agree((held[0], own[1]), (held[1], mirror[1]), tolerance)
    )
    either = zip(same, (alive & left).any(axis=1), (alive & ~left).any(axis=1), strict=True)
    return tuple("none" if equal or (one and other) else ("L" if one else "R") for equal, one, other in either)


def _agree(own: tuple[Floats, Ints], mirror: tuple[Floats, Ints], tolerance: Floats) -> Bools:
    """Whether parts (k,) as they stand agree with a variant of their mirror images."""
    spread = np.abs(mirror[0] - own[0][:, :1]) <= tolerance + FINE
    return np.any(spread.all(axis=2) & (mirror[1] == own[1][:, :1]).all(axis=2), axis=1)


def joined(rows: list[Ints], parts: list[Classes]) -> Classes:
    """Put the classes of groups of instances together; `rows` are the instances of each group, all of them once."""
    count = sum(map(len, rows))
    kinds = np.cumsum([0, *(len(part.representative) for part in parts)])
    of, variant, deviation = np.empty(count, np.int64), np.empty(count, np.int64), np.empty((count, 1))
    for group, part, kind in zip(rows, parts, kinds[:-1], strict=True):
        of[group], variant[group] = kind + part.of, part.variant
        deviation[group, 0] = part.deviation.max(axis=1)
    representative = np.concatenate([group[part.representative] for group, part in zip(rows, parts, strict=True)])
    canonical = np.concatenate([part.canonical for part in parts])
    order = np.argsort(representative)
    return Classes(np.argsort(order)[of], variant, representative[order], canonical[order], deviation)


def _snapped(numbers: Floats) -> Ints:
    return np.round(numbers / _SNAP).astype(np.int64)


def _merge(numbers: Floats, labels: Ints, best: Ints, tolerance: Floats, size: Floats) -> Ints:
    """Class (p,) of each distinct description, by complete linkage in the order of an invariant of the variants.

    Descriptions that agree differ in the invariant `size` (p,) by 2q at most, gaps being differences of two
    azimuths; so each meets only the last few classes.
    """
    low, high = np.empty_like(numbers[:, 0]), np.empty_like(numbers[:, 0])
    founder, count, window = np.empty(len(size), dtype=np.int64), 0, 0
    of = np.empty(len(size), dtype=np.int64)
    for proto in in_order(size):
        while window < count and size[founder[window]] < size[proto] - 2 * len(tolerance) - 1:
            window += 1
        open_classes = slice(window, count)
        tags = labels[founder[open_classes], best[founder[open_classes]]]
        fit = _first_fit(numbers[proto], labels[proto], low[open_classes], high[open_classes], tags, tolerance)
        if fit is None:
            founder[count], low[count], high[count] = (
                proto,
                numbers[proto, best[proto]],
                numbers[proto, best[proto]],
            )
            of[proto], count = count, count + 1
            continue
        of[proto], row = window + fit[0], numbers[proto, fit[1]]
        low[of[proto]], high[of[proto]] = np.minimum(low[of[proto]], row), np.maximum(high[of[proto]], row)
    return of


def _first_fit(
    variants: Floats, labels: Ints, low: Floats, high: Floats, tags: Ints, tolerance: Floats
) -> tuple[int, int] | None:
    """Class and variant (s, q) that keep max − min within the tolerance; None if no class (k, q) does."""
    spread = np.maximum(high[:, None], variants) - np.minimum(low[:, None], variants)
    fits = (spread <= tolerance + FINE).all(axis=2) & (labels[None] == tags[:, None]).all(axis=2)
    if not fits.any():
        return None
    where = np.argwhere(fits)
    tightest = first_least((spread / tolerance).max(axis=2)[fits])
    return int(where[tightest, 0]), int(where[tightest, 1])


def _held_to_description(numbers: Floats, labels: Ints, best: Ints, of: Ints, tolerance: Floats) -> Classes:
    """Describe classes, and give what a description does not hold within the tolerance a class of its own.

    A class is merged as its founder is read. Its representative may be read from another arm where two are alike but
    for noise, and azimuths from there differ by up to twice as much.
    """
    while True:
        classes = _describe(numbers, labels, best, of)
        astray = (classes.deviation > tolerance + _SNAP).any(axis=1)
        if not astray.any():
            return classes
        # The representative of a class never strays from itself: every round leaves fewer astray.
        of = classes.of + len(classes.representative) * astray


def _describe(numbers: Floats, labels: Ints, best: Ints, of: Ints) -> Classes:
    """Number the classes by their first instance and align every instance with its class."""
    _, first, place = np.unique(of, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.argsort(order)[place.ravel()]
    representative = first[order]
    canonical = best[representative]
    target = numbers[representative, canonical][rank]
    tags = labels[representative, canonical][rank]
    difference = np.abs(numbers - target[:, None])
    misfit = np.round((difference / _SNAP).max(axis=2))
    misfit[~(labels == tags[:, None]).all(axis=2)] = np.inf
    variant = np.argmin(misfit, axis=1)
    return Classes(rank, variant, representative, canonical, difference[np.arange(len(of)), variant])
