"""Strokes, drawn in any order and direction, and the chains that they form end to end."""

from typing import Any, Generic, NamedTuple, Protocol, Self, TypeVar

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import KDTree

from isomould.arrays import Floats, Ints


class Joinable(Protocol):
    """A piece in the plane or in space."""

    def point(self, t: Floats) -> Floats: ...  # noqa: D102
    def derivative(self, t: Floats) -> Floats: ...  # noqa: D102
    def reversed(self) -> Self: ...  # noqa: D102


P = TypeVar("P", bound=Joinable)


class Stroke(NamedTuple, Generic[P]):
    """What one entity draws: pieces that join, in its own direction."""

    name: str
    """What messages call the entity, for messages."""
    pieces: tuple[P, ...]

    def reversed(self) -> "Stroke[P]":
        """Give the same stroke in the opposite direction."""
        return Stroke(self.name, tuple(piece.reversed() for piece in self.pieces[::-1]))


class Chain(NamedTuple, Generic[P]):
    """Strokes end to end, each in the direction of the chain."""

    strokes: tuple[Stroke[P], ...]
    closed: bool

    @property
    def pieces(self) -> tuple[P, ...]:
        """The pieces of all strokes."""
        return tuple(piece for stroke in self.strokes for piece in stroke.pieces)

    @property
    def names(self) -> tuple[str, ...]:
        """What messages call the entities."""
        return tuple(stroke.name for stroke in self.strokes)


def tips_of(strokes: list[Stroke[Any]]) -> Floats:
    """Give start and end of every stroke: (s, 2, 2 or 3), mm."""
    return np.array([[s.pieces[0].point(np.zeros(1))[0], s.pieces[-1].point(np.ones(1))[0]] for s in strokes])


def places_of(tips: Floats, reach: float) -> Ints:
    """Give each tip (s, 2) the number of the place where it meets others within reach, mm."""
    flat = tips.reshape(-1, tips.shape[-1])
    pairs = KDTree(flat).query_pairs(reach, output_type="ndarray")
    return _components(pairs, len(flat)).reshape(-1, 2)


def chains_of(strokes: list[Stroke[P]], places: Ints) -> list[Chain[P]]:
    """Join strokes that share places, no more than two tips on each, in the direction of the first of each chain."""
    touching: dict[int, list[int]] = {}
    for tip, place in enumerate(places.ravel().tolist()):
        touching.setdefault(place, []).append(tip)
    left = dict.fromkeys(range(len(strokes)))
    chains = list[Chain[P]]()
    while left:
        walk = _walk(places, touching, next(iter(left)))
        for step in walk:
            del left[step.stroke]
        walked = tuple(strokes[s.stroke] if s.forward else strokes[s.stroke].reversed() for s in walk)
        chains.append(Chain(walked, closed=_leaving(places, walk[0]) == _arriving(places, walk[-1])))
    return chains


class _Step(NamedTuple):
    """A stroke walked forwards or backwards."""

    stroke: int
    forward: bool


def _components(pairs: Ints, count: int) -> Ints:
    graph = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(count, count))
    return connected_components(graph, directed=False)[1].astype(np.int64)


def _walk(places: Ints, touching: dict[int, list[int]], first: int) -> list[_Step]:
    """Go on from a stroke until the end or all round, then back from it to the beginning."""
    ahead = _follow(places, touching, _Step(first, forward=True))
    if _leaving(places, ahead[0]) == _arriving(places, ahead[-1]):
        return ahead
    behind = _follow(places, touching, _Step(first, forward=False))
    return [_Step(step.stroke, not step.forward) for step in behind[:0:-1]] + ahead


def _follow(places: Ints, touching: dict[int, list[int]], start: _Step) -> list[_Step]:
    walk = [start]
    while True:
        last = walk[-1]
        came = 2 * last.stroke + last.forward
        onward = [tip for tip in touching[_arriving(places, last)] if tip != came]
        if not onward or onward[0] // 2 == start.stroke:
            return walk
        walk.append(_Step(onward[0] // 2, onward[0] % 2 == 0))


def _arriving(places: Ints, step: _Step) -> int:
    return int(places[step.stroke, int(step.forward)])


def _leaving(places: Ints, step: _Step) -> int:
    return int(places[step.stroke, int(not step.forward)])
