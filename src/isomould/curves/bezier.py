"""Rational Bézier pieces: what polynomials, B-splines, NURBS and interpolated splines are made of."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar, Self

import numpy as np

from isomould.arrays import Floats, read_only
from isomould.curves.bernstein import product, sign_changes, slope
from isomould.curves.pieces import NEAR_END, Piece, Point

_SAME_SPLIT = 1e-7


@dataclass(frozen=True)
class Bezier(Piece):
    """A rational Bézier piece of degree `len(points) - 1` (1 or more), weights positive."""

    points: tuple[Point, ...]
    weights: tuple[float, ...]
    kind: ClassVar[str] = "bezier"
    _points: ClassVar[tuple[str, ...]] = ("points",)

    @property
    def row(self) -> Floats:
        """The first point, then the homogeneous control points relative to it: (degree + 2, 3).

        Relative, so that curves far from the origin keep their precision. Degree 1 is raised to 2.
        """
        return self._row

    @cached_property
    def _row(self) -> Floats:
        weights = np.array(self.weights)[:, None] / max(self.weights)
        controls = np.hstack([(np.array(self.points) - self.points[0]) * weights, weights])
        if len(controls) == 2:
            controls = np.array([controls[0], controls.mean(axis=0), controls[1]])
        return read_only(np.vstack([[*self.points[0], 0.0], controls]))

    @classmethod
    def evaluate(cls, rows: Floats, t: Floats, order: int) -> Floats:
        """Evaluate the homogeneous curve and its quotient."""
        point, first, second = (_split_weight(h) for h in _homogeneous(rows[:, 1:], t[:, None, None]))
        place = point[0] / point[1]
        if order == 0:
            return place + rows[:, 0, :2]
        speed = (first[0] - place * first[1]) / point[1]
        return speed if order == 1 else (second[0] - 2 * speed * first[1] - place * second[1]) / point[1]

    def splits(self) -> Floats:
        """Give inflections and the places where the tangent passes the x or the y direction."""
        inflections = [t for t in sign_changes(*self._curvature) if NEAR_END < t < 1 - NEAR_END]
        taken = np.array([0.0, 1.0, *inflections])
        passes = [t for h in self._hodograph for t in sign_changes(*h) if np.abs(taken - t).min() > _SAME_SPLIT]
        return np.array(sorted([*inflections, *passes]))

    def least_speed(self) -> float:
        """Give the least |dP/dt| at the ends and where the squared hodograph is stationary."""
        squares = [product(h, h) for h, _ in self._hodograph]
        square = squares[0] + squares[1]
        still = sign_changes(slope(square), float(np.abs(square).max()))
        return float(np.hypot(*self.derivative(np.array([0.0, *still, 1.0])).T).min())

    def reversed(self) -> Self:
        """Reverse the control points."""
        return replace(self, points=self.points[::-1], weights=self.weights[::-1])

    @property
    def _noise_scale(self) -> float:
        """The size that rounding of the control points is measured by, mm: grows far from the origin."""
        extent = float(np.abs(self.row[1:, :2]).max())
        return extent + float(np.abs(self.row[0]).max()) / 100

    @cached_property
    def _hodograph(self) -> tuple[tuple[Floats, float], ...]:
        """The numerators X'W − XW' and Y'W − YW' of the tangent, each with the size of its terms."""
        X, Y, W = self.row[1:].T
        scale = W.size * self._noise_scale
        return tuple((product(slope(U), W) - product(U, slope(W)), scale) for U in (X, Y))

    @property
    def _curvature(self) -> tuple[Floats, float]:
        """The determinant of (X, Y, W) and its two derivatives: it has the sign of the curvature."""
        rows = list(self.row[1:].T)
        first = [slope(U) for U in rows]
        second = [slope(U) for U in first]
        terms = [s * product(rows[i], product(first[j], second[k])) for i, j, k, s in _PERMUTATIONS]
        extent = float(np.abs(self.row[1:, :2]).max())
        return np.sum(terms, axis=0), len(rows[0]) ** 3 * extent * self._noise_scale


_PERMUTATIONS = ((0, 1, 2, 1), (1, 2, 0, 1), (2, 0, 1, 1), (0, 2, 1, -1), (2, 1, 0, -1), (1, 0, 2, -1))


def _homogeneous(controls: Floats, t: Floats) -> tuple[Floats, Floats, Floats]:
    """Run de Casteljau's algorithm: value, first and second derivative, each (n, 3)."""
    degree = controls.shape[1] - 1
    while controls.shape[1] > 3:
        controls = (1 - t) * controls[:, :-1] + t * controls[:, 1:]
    second = degree * (degree - 1) * (controls[:, 0] - 2 * controls[:, 1] + controls[:, 2])
    pair = (1 - t) * controls[:, :-1] + t * controls[:, 1:]
    value = ((1 - t) * pair[:, :-1] + t * pair[:, 1:])[:, 0]
    return value, degree * (pair[:, 1] - pair[:, 0]), np.broadcast_to(second, value.shape)


def _split_weight(homogeneous: Floats) -> tuple[Floats, Floats]:
    return homogeneous[:, :2], homogeneous[:, 2:]
