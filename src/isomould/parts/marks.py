"""Marks name classes of parts, locations name their instances (fabrication, Marks and locations)."""

from isomould.arrays import Ints

_LETTERS = ("", "-A", "-B", "-C", "-D")
"""Ends of the locations of what is whole, and of the pieces that trimming leaves."""


def marks(prefix: str, count: int) -> tuple[str, ...]:
    """Give the marks of `count` classes, with at least two digits.

    >>> marks("N", 2)
    ('N01', 'N02')
    """
    width = max(2, len(str(count)))
    return tuple(f"{prefix}{number:0{width}d}" for number in range(1, count + 1))


def locations(prefix: str, ij: Ints, piece: Ints | None = None) -> tuple[str, ...]:
    """Give the locations of instances with the indices (n, 2), padded to the largest, at least two digits.

    `piece` (n,) counts what trimming left of an instance from 1; 0 is for what is whole.

    >>> import numpy as np
    >>> locations("P", np.array([[0, 7], [3, 12]]))
    ('P-00-07', 'P-03-12')
    >>> locations("N", np.array([[4, 7]]), np.array([2]))
    ('N-04-07-B',)
    """
    if len(ij) == 0:
        return ()
    width = max(2, len(str(int(ij.max()))))
    pieces = [0] * len(ij) if piece is None else piece.tolist()
    rows = zip(ij.tolist(), pieces, strict=True)
    return tuple(f"{prefix}-{i:0{width}d}-{j:0{width}d}{_LETTERS[k]}" for (i, j), k in rows)
