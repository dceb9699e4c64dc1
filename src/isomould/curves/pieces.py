"""The five kinds of piece that every planar curve is a chain of, each with t in [0, 1].

Every kind is closed under affine maps and reversal, so no curve ever has to be approximated:
lines, ellipses (circles and arcs among them), sines, catenaries (here) and rational Béziers (`bezier`).
"""

from abc import ABC, abstractmethod
from dataclasses import asdict, dataclass, replace
from typing import Any, ClassVar, Self

import numpy as np

from isomould.arrays import Floats

Point = tuple[float, float]
"""A point or vector of the curve's plane, mm."""

NEAR_END = 1e-9
"""Splits this near (in t) to an end of the piece are the end."""


class Piece(ABC):
    """What every piece offers. Field names are the keys of its JSON descriptor."""

    kind: ClassVar[str]
    _points: ClassVar[tuple[str, ...]]
    _vectors: ClassVar[tuple[str, ...]] = ()

    @property
    @abstractmethod
    def row(self) -> Floats:
        """The numbers that `evaluate` needs, as one array: pieces with rows of equal shape can be stacked."""

    @classmethod
    @abstractmethod
    def evaluate(cls, rows: Floats, t: Floats, order: int) -> Floats:
        """Evaluate the derivative of an order (0, 1, 2): rows (n, …) or (1, …), t (n,) to (n, 2), mm."""

    @abstractmethod
    def splits(self) -> Floats:
        """Give the sorted parameters in (0, 1) between which the tangent turns one way by less than π."""

    @abstractmethod
    def least_speed(self) -> float:
        """Give the least |dP/dt|, mm, within a small factor; zero where it vanishes."""

    @abstractmethod
    def reversed(self) -> Self:
        """Give the same points in the opposite direction."""

    def point(self, t: Floats) -> Floats:
        """Give the points at t (n,) as (n, 2), mm."""
        return self.evaluate(self.row[None], np.asarray(t, float), 0)

    def derivative(self, t: Floats) -> Floats:
        """Give dP/dt at t (n,) as (n, 2), mm."""
        return self.evaluate(self.row[None], np.asarray(t, float), 1)

    def second(self, t: Floats) -> Floats:
        """Give d²P/dt² at t (n,) as (n, 2), mm."""
        return self.evaluate(self.row[None], np.asarray(t, float), 2)

    def mapped(self, matrix: Floats, offset: Floats) -> Self:
        """Give the affine image: P becomes matrix (2, 2) @ P + offset (2,)."""
        points = {name: _each(getattr(self, name), matrix, offset) for name in self._points}
        vectors = {name: _each(getattr(self, name), matrix, np.zeros(2)) for name in self._vectors}
        return replace(self, **points, **vectors)  # type: ignore[type-var]

    def describe(self) -> dict[str, Any]:
        """Give the JSON descriptor; `piece_from` of module `curve` reads it."""
        fields = asdict(self)  # type: ignore[call-overload]
        return {"kind": self.kind, **{name: _lists(value) for name, value in fields.items()}}


def _each(value: Any, matrix: Floats, offset: Floats) -> Any:
    return tuples(np.asarray(value) @ np.asarray(matrix).T + offset)


def tuples(value: Any) -> Any:
    """Turn nested arrays and lists into nested tuples of floats."""
    return tuple(tuples(item) for item in value) if np.ndim(value) else float(value)


def _lists(value: Any) -> Any:
    return [_lists(item) for item in value] if isinstance(value, tuple) else value


@dataclass(frozen=True)
class Line(Piece):
    """A straight piece from `start` to `end`."""

    start: Point
    end: Point
    kind: ClassVar[str] = "line"
    _points: ClassVar[tuple[str, ...]] = ("start", "end")

    @property
    def row(self) -> Floats:
        """Start and end: (2, 2)."""
        return np.array([self.start, self.end])

    @classmethod
    def evaluate(cls, rows: Floats, t: Floats, order: int) -> Floats:
        """Interpolate; both ends are met exactly."""
        start, end, t = rows[:, 0], rows[:, 1], t[:, None]
        if order == 0:
            return (1 - t) * start + t * end
        return np.broadcast_to((end - start) * (order == 1), (t.size, 2)).copy()

    def splits(self) -> Floats:
        """Give none: a line does not turn."""
        return np.empty(0)

    def least_speed(self) -> float:
        """Give the length."""
        return float(np.hypot(*np.subtract(self.end, self.start)))

    def reversed(self) -> Self:
        """Exchange the ends."""
        return replace(self, start=self.end, end=self.start)


class _Framed(Piece):
    """Shared by the transcendental kinds: origin + along·f(φ) + across·g(φ), φ linear in t."""

    start: float
    end: float

    @property
    def row(self) -> Floats:
        """Origin, along, across and (start, end): (4, 2)."""
        frame = [getattr(self, name) for name in (*self._points, *self._vectors)]
        return np.array([*frame, (self.start, self.end)])

    @staticmethod
    @abstractmethod
    def basis(phi: Floats, order: int) -> tuple[Floats, Floats]:
        """Give the derivatives of f and g of an order."""

    @classmethod
    def evaluate(cls, rows: Floats, t: Floats, order: int) -> Floats:
        """Combine the frame with the basis."""
        start, end = rows[:, 3, 0], rows[:, 3, 1]
        f, g = cls.basis((1 - t) * start + t * end, order)
        inner = rows[:, 1] * f[:, None] + rows[:, 2] * g[:, None]
        return inner + rows[:, 0] if order == 0 else inner * ((end - start) ** order)[:, None]

    def least_speed(self) -> float:
        """Give the frame's shortest stretch times the range of φ."""
        # every basis derivative (f', g') is at least 1 long, so the frame's shortest stretch bounds the speed
        stretch = np.linalg.svd(self.row[1:3], compute_uv=False)
        return float(stretch[-1]) * abs(self.end - self.start)

    def reversed(self) -> Self:
        """Exchange the ends of the range."""
        return replace(self, start=self.end, end=self.start)  # type: ignore[type-var]

    def _multiples(self, step: float) -> Floats:
        low, high = sorted((self.start, self.end))
        phi = step * np.arange(np.ceil(low / step), np.floor(high / step) + 1)
        t = np.sort((phi - self.start) / (self.end - self.start))
        return t[(t > NEAR_END) & (t < 1 - NEAR_END)]


@dataclass(frozen=True)
class Ellipse(_Framed):
    """An arc of an ellipse: centre + major·cos φ + minor·sin φ, φ from `start` to `end` in radians.

    `major` and `minor` are any two conjugate half diameters; end < start draws backwards.
    """

    centre: Point
    major: Point
    minor: Point
    start: float
    end: float
    kind: ClassVar[str] = "ellipse"
    _points: ClassVar[tuple[str, ...]] = ("centre",)
    _vectors: ClassVar[tuple[str, ...]] = ("major", "minor")

    @staticmethod
    def basis(phi: Floats, order: int) -> tuple[Floats, Floats]:
        """Give cos φ and sin φ."""
        cos, sin = np.cos(phi), np.sin(phi)
        return ((cos, sin), (-sin, cos), (-cos, -sin))[order]

    def splits(self) -> Floats:
        """Give the quadrants."""
        return self._multiples(np.pi / 2)


@dataclass(frozen=True)
class Sine(_Framed):
    """A sine wave: origin + along·φ + across·sin φ, φ from `start` to `end` in radians."""

    origin: Point
    along: Point
    across: Point
    start: float
    end: float
    kind: ClassVar[str] = "sine"
    _points: ClassVar[tuple[str, ...]] = ("origin",)
    _vectors: ClassVar[tuple[str, ...]] = ("along", "across")

    @staticmethod
    def basis(phi: Floats, order: int) -> tuple[Floats, Floats]:
        """Give φ and sin φ."""
        ones = np.ones_like(phi)
        return ((phi, np.sin(phi)), (ones, np.cos(phi)), (0 * ones, -np.sin(phi)))[order]

    def splits(self) -> Floats:
        """Give the inflections."""
        return self._multiples(np.pi)


@dataclass(frozen=True)
class Catenary(_Framed):
    """A catenary: origin + along·u + across·cosh u, u from `start` to `end`."""

    origin: Point
    along: Point
    across: Point
    start: float
    end: float
    kind: ClassVar[str] = "catenary"
    _points: ClassVar[tuple[str, ...]] = ("origin",)
    _vectors: ClassVar[tuple[str, ...]] = ("along", "across")

    @staticmethod
    def basis(phi: Floats, order: int) -> tuple[Floats, Floats]:
        """Give u and cosh u."""
        ones, cosh = np.ones_like(phi), np.cosh(phi)
        return ((phi, cosh), (ones, np.sinh(phi)), (0 * ones, cosh))[order]

    def splits(self) -> Floats:
        """Give the vertex, where the tangent is parallel to `along`."""
        t = np.array([self.start / (self.start - self.end)])
        return t[(t > NEAR_END) & (t < 1 - NEAR_END)]
