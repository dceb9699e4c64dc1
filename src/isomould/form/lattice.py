"""The directions that tangent lines may have: a numbered, increasing sequence of angles.

An *even* lattice steps by the constant turning angle α (paper §4.1). A *listed* one has the directions of a
single arc, where steps differ (several angles, leftover turning: geometry §2). A *Koebe* lattice steps through
the slopes that an edge offset mesh admits (paper §3.6 with the erratum of geometry §5).
"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from isomould.arrays import Floats, read_only


class Lattice(Protocol):
    """A strictly increasing sequence of tangent directions, numbered by the integers."""

    def direction(self, index: Floats) -> Floats:
        """Tangent directions (n,) rad of the indices (n,)."""
        ...

    def index(self, direction: Floats) -> Floats:
        """Real-valued indices (n,) of the directions (n,) rad: the inverse of `direction`."""
        ...


@dataclass(frozen=True)
class EvenLattice:
    """Directions `first + k·step` (rad).

    >>> EvenLattice(0.5, 0.25).direction(np.array([0.0, 2.0]))
    array([0.5, 1. ])
    """

    first: float
    step: float

    def direction(self, index: Floats) -> Floats:
        """Tangent directions (n,) rad."""
        return self.first + self.step * index

    def index(self, direction: Floats) -> Floats:
        """Real-valued indices (n,)."""
        return (direction - self.first) / self.step


@dataclass(frozen=True, eq=False)
class ListedLattice:
    """Directions listed one by one, numbered from 0; beyond both ends they go on in the outermost steps.

    >>> ListedLattice(np.array([0.0, 0.25, 1.0])).direction(np.array([1.0, 3.0]))
    array([0.25, 1.75])
    """

    listed: Floats
    """(n,) increasing directions, rad; n at least 2."""

    def __post_init__(self) -> None:
        read_only(self.listed)

    def direction(self, index: Floats) -> Floats:
        """Tangent directions (n,) rad."""
        low = np.clip(np.floor(index), 0, len(self.listed) - 2).astype(np.int64)
        return self.listed[low] + (index - low) * (self.listed[low + 1] - self.listed[low])

    def index(self, direction: Floats) -> Floats:
        """Real-valued indices (n,)."""
        low = np.clip(np.searchsorted(self.listed, direction, side="right") - 1, 0, len(self.listed) - 2)
        return low + (direction - self.listed[low]) / (self.listed[low + 1] - self.listed[low])


@dataclass(frozen=True)
class KoebeLattice:
    """The slopes that the generatrix of an edge offset mesh may have (geometry §5).

    The latitudes `λ_k = 2 atan(tanh(start + k·artanh s))`, s = sin(turning/2), are those of the parallels of
    a Koebe mesh; the profile edge between λ_k and λ_{k+1} has the normal latitude m_k = (λ_k + λ_{k+1})/2 and
    the tangent direction m_k + π/2. Between two poles, on the half with normals from half·π − π/2 to
    half·π + π/2, the mesh is the image of the first under a point reflection for every odd `half`.
    """

    turning: float
    start: float
    half: int = 0

    @property
    def step(self) -> float:
        """The constant step artanh(sin(α/2)) of the recurrence."""
        return float(np.arctanh(np.sin(self.turning / 2)))

    def latitude(self, index: Floats) -> Floats:
        """Latitudes λ (n,) rad of the parallels with the indices (n,)."""
        return self.half * np.pi + 2 * np.arctan(np.tanh(self.start + self.step * index))

    def direction(self, index: Floats) -> Floats:
        """Tangent directions (n,) rad in (0, π) + half·π."""
        return (self.latitude(index) + self.latitude(index + 1)) / 2 + np.pi / 2

    def index(self, direction: Floats) -> Floats:
        """Real-valued indices (n,) of tangent directions (n,) rad in (0, π) + half·π."""
        slope = direction - np.pi / 2 - self.half * np.pi
        lower = slope - half_width(slope, self.turning)
        return (np.arctanh(np.tan(lower / 2)) - self.start) / self.step


def half_width(slope: Floats, turning: float) -> Floats:
    """Half the latitude step h (rad) between the ends of an edge with normal latitude `slope` (geometry §5)."""
    return np.arcsin(np.sin(turning / 2) * np.abs(np.cos(slope)))


def koebe_lattice(turning: float, phase: str | float, half: int = 0) -> KoebeLattice:
    """Give the lattice for a rail turning angle (rad) and a phase: "centre", "node" or a first slope (rad).

    A slope m is that of an edge on the outer half, and π − m on the inner one (`half` odd).

    >>> round(float(np.degrees(koebe_lattice(np.radians(5), "centre").latitude(np.array(1.0)))), 12)
    2.5
    """
    step = float(np.arctanh(np.sin(turning / 2)))
    if phase == "centre":
        return KoebeLattice(turning, -step / 2, half)
    if phase == "node":
        return KoebeLattice(turning, 0.0, half)
    slope = float(phase) * (-1) ** half
    first = slope - float(half_width(np.array(slope), turning))
    return KoebeLattice(turning, float(np.arctanh(np.tan(first / 2))), half)
