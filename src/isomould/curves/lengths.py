"""Arc lengths by Gauss quadrature, halving until they settle: of the whole and to a place."""

from typing import NamedTuple

import numpy as np
from scipy.optimize import elementwise

from isomould.arrays import Bools, Floats, Ints
from isomould.curves.curve import Curve

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(20)
_SETTLED = 1e-13
"""Of the cell's own length; a tenth of it of the whole curve's."""
_DEEPEST = 40


class _Cells(NamedTuple):
    """Stretches of pieces short enough for one quadrature, in order along the curve."""

    piece: Ints
    t0: Floats
    t1: Floats
    lengths: Floats


def length(curve: Curve) -> float:
    """Give the curve's length, mm, to about 1e-12 of itself."""
    return float(_cells(curve).lengths.sum())


def parameter_at(curve: Curve, lengths: Floats) -> tuple[Ints, Floats]:
    """Find the places at arc lengths (n,) from the start, mm, as index (n,) and t (n,).

    Raises
    ------
    ValueError
        If a length lies outside the curve by more than 1e-9 of its length.
    """
    cells = _cells(curve)
    after = np.cumsum(cells.lengths)
    asked = np.clip(lengths, 0.0, after[-1])
    if np.any(np.abs(asked - lengths) > 1e-9 * after[-1]):
        message = f"stations from {lengths.min()} to {lengths.max()} on a curve {after[-1]} mm long"
        raise ValueError(message)
    cell = np.minimum(np.searchsorted(after, asked), after.size - 1)
    rest = asked - (after - cells.lengths)[cell]
    return cells.piece[cell], _solve(curve, cells, cell, rest)


def _solve(curve: Curve, cells: _Cells, cell: Ints, rest: Floats) -> Floats:
    """Find in each cell the parameter that is `rest` along it."""
    index, low, high = cells.piece[cell], cells.t0[cell], cells.t1[cell]

    def excess(t: Floats, lane: Ints) -> Floats:
        lane = lane.astype(np.int64)
        return _integrate(curve, index[lane], low[lane], t) - rest[lane]

    found = elementwise.find_root(excess, (low, high), args=(np.arange(rest.size),))
    nearer_high = 2 * rest > cells.lengths[cell]
    return np.where(found.success, found.x, np.where(nearer_high, high, low))


def _cells(curve: Curve) -> _Cells:
    """Halve the pieces' monotone spans until the quadrature settles."""
    open_cells = _first_cells(curve)
    settled: list[_Cells] = []
    whole = open_cells.lengths.sum()
    for _ in range(_DEEPEST):
        halves = _halved(curve, open_cells)
        fine = halves.lengths.reshape(2, -1).sum(axis=0)
        rough = np.abs(fine - open_cells.lengths) > _SETTLED * np.maximum(fine, whole / 10)
        settled.append(_chosen(open_cells, ~rough))
        open_cells = _chosen(halves, np.tile(rough, 2))
        if not rough.any():
            break
    return _ordered([*settled, open_cells])


def _first_cells(curve: Curve) -> _Cells:
    fences = [np.concatenate([[0.0], piece.splits(), [1.0]]) for piece in curve.pieces]
    index = np.repeat(np.arange(len(fences)), [len(f) - 1 for f in fences])
    t0, t1 = np.concatenate([f[:-1] for f in fences]), np.concatenate([f[1:] for f in fences])
    return _Cells(index, t0, t1, _integrate(curve, index, t0, t1))


def _halved(curve: Curve, cells: _Cells) -> _Cells:
    middle = (cells.t0 + cells.t1) / 2
    index = np.tile(cells.piece, 2)
    t0, t1 = np.concatenate([cells.t0, middle]), np.concatenate([middle, cells.t1])
    return _Cells(index, t0, t1, _integrate(curve, index, t0, t1))


def _chosen(cells: _Cells, which: Bools | Ints) -> _Cells:
    return _Cells(cells.piece[which], cells.t0[which], cells.t1[which], cells.lengths[which])


def _ordered(parts: list[_Cells]) -> _Cells:
    index = np.concatenate([part.piece for part in parts])
    t0, t1 = np.concatenate([part.t0 for part in parts]), np.concatenate([part.t1 for part in parts])
    every = _Cells(index, t0, t1, np.concatenate([part.lengths for part in parts]))
    return _chosen(every, np.lexsort((t0, index)))


def _integrate(curve: Curve, index: Ints, t0: Floats, t1: Floats) -> Floats:
    """Integrate the speed over each stretch: all (n,) to lengths (n,), mm."""
    half = (t1 - t0) / 2
    t = (t0 + half)[:, None] + half[:, None] * _NODES
    speed = np.linalg.norm(curve.derivative(np.repeat(index, _NODES.size), t.ravel()), axis=1)
    return half * (speed.reshape(t.shape) @ _WEIGHTS)
