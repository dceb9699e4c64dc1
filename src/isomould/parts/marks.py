"""Marks name classes of parts, locations name their instances (fabrication, Marks and locations)."""

from isomould.arrays import Ints


def marks(prefix: str, count: int) -> tuple[str, ...]:
    """Give the marks of `count` classes, with at least two digits.

    >>> marks("N", 2)
    ('N01', 'N02')
    """
    width = max(2, len(str(count)))
    return tuple(f"{prefix}{number:0{width}d}" for number in range(1, count + 1))


def locations(prefix: str, ij: Ints) -> tuple[str, ...]:
    """Give the locations of instances with the indices (n, 2), padded to the largest, at least two digits.

    >>> import numpy as np
    >>> locations("P", np.array([[0, 7], [3, 12]]))
    ('P-00-07', 'P-03-12')
    """
    if len(ij) == 0:
        return ()
    width = max(2, len(str(int(ij.max()))))
    return tuple(f"{prefix}-{i:0{width}d}-{j:0{width}d}" for i, j in ij.tolist())
