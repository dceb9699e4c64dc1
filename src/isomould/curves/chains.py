"""Joining strokes, drawn in any order and direction, to the one chain that they form."""

from typing import Any, Generic, NamedTuple, Protocol, Self, TypeVar

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import KDTree

from isomould.arrays import Floats, Ints
from isomould.curves.curve import JOINT_GAP
from isomould.errors import Refused


class Joinable(Protocol):
    """A piece in the plane or in space."""

    def point(self, t: Floats) -> Floats: ...  # noqa: D102
    def reversed(self) -> Self: ...  # noqa: D102


P = TypeVar("P", bound=Joinable)


class Stroke(NamedTuple, Generic[P]):
    """What one entity draws: pieces that join, in its own direction."""

    name: str
    """What messages call the entity, for messages."""
    pieces: tuple[P, ...]


def chained(strokes: list[Stroke[P]], field: str) -> tuple[tuple[P, ...], bool]:
    """Join strokes end to end, in the direction of the first; say whether the chain is closed.

    Raises
    ------
    Refused
        E-DRAWN-CURVES if they form more than one curve or branch; the message lists the entities.
    """
    tips = _tips(strokes)
    nodes = _nodes(tips)
    _refuse_branches(strokes, tips, nodes, field)
    _refuse_several(strokes, tips, nodes, field)
    walk = _walk(nodes)
    closed = bool(_leaving(nodes, walk[0]) == _arriving(nodes, walk[-1]))
    _refuse_doubled(strokes, closed, field)
    return tuple(piece for step in walk for piece in _stepped(strokes, step)), closed


class _Step(NamedTuple):
    """A stroke walked forwards or backwards."""

    stroke: int
    forward: bool


def _tips(strokes: list[Stroke[Any]]) -> Floats:
    """Give start and end of every stroke: (s, 2, 2 or 3), mm."""
    return np.array([[s.pieces[0].point(np.zeros(1))[0], s.pieces[-1].point(np.ones(1))[0]] for s in strokes])


def _nodes(tips: Floats) -> Ints:
    """Give each tip (s, 2) the number of the place where it meets others."""
    flat = tips.reshape(-1, tips.shape[-1])
    pairs = KDTree(flat).query_pairs(JOINT_GAP, output_type="ndarray")
    return _components(pairs, len(flat)).reshape(-1, 2)


def _components(pairs: Ints, count: int) -> Ints:
    graph = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(count, count))
    return connected_components(graph, directed=False)[1].astype(np.int64)


def _walk(nodes: Ints) -> list[_Step]:
    """Go on from the first stroke until the end or all round, then back from it to the beginning."""
    ahead = _follow(nodes, [_Step(0, forward=True)])
    if len(ahead) == len(nodes):
        return ahead
    behind = _follow(nodes, [_Step(0, forward=False)])
    return [_Step(step.stroke, not step.forward) for step in behind[:0:-1]] + ahead


def _follow(nodes: Ints, walk: list[_Step]) -> list[_Step]:
    touching: dict[int, list[int]] = {}
    for tip, node in enumerate(nodes.ravel().tolist()):
        touching.setdefault(node, []).append(tip)
    while True:
        last = walk[-1]
        came = 2 * last.stroke + last.forward
        onward = [tip for tip in touching[_arriving(nodes, last)] if tip != came]
        if not onward or onward[0] // 2 == walk[0].stroke:
            return walk
        walk.append(_Step(onward[0] // 2, onward[0] % 2 == 0))


def _arriving(nodes: Ints, step: _Step) -> int:
    return int(nodes[step.stroke, int(step.forward)])


def _leaving(nodes: Ints, step: _Step) -> int:
    return int(nodes[step.stroke, int(not step.forward)])


def _stepped(strokes: list[Stroke[P]], step: _Step) -> tuple[P, ...]:
    pieces = strokes[step.stroke].pieces
    return pieces if step.forward else tuple(piece.reversed() for piece in pieces[::-1])


def _refuse_branches(strokes: list[Stroke[Any]], tips: Floats, nodes: Ints, field: str) -> None:
    crowded = np.flatnonzero(np.bincount(nodes.ravel()) > 2)
    if crowded.size:
        here = np.argwhere(nodes == crowded[0])
        place = ", ".join(f"{coordinate:.6g}" for coordinate in tips[tuple(here[0])])
        names = ", ".join(strokes[k].name for k in np.unique(here[:, 0]))
        _refuse(f"{len(here)} ends meet at ({place}): {names}", "two ends at a joint", field)


def _refuse_several(strokes: list[Stroke[Any]], tips: Floats, nodes: Ints, field: str) -> None:
    groups = _components(nodes, int(nodes.max()) + 1)[nodes[:, 0]]
    count = int(groups.max()) + 1
    if count > 1:
        names = "; ".join(
            _listed([s.name for s, g in zip(strokes, groups, strict=True) if g == k]) for k in range(count)
        )
        near = _nearest_gap(tips, groups)
        _refuse(f"{count} curves ({names}); their nearest ends are {near:.6g} mm apart", "one curve", field)


def _listed(names: list[str]) -> str:
    return ", ".join(names[:8]) + (f" and {len(names) - 8} more" if len(names) > 8 else "")


def _nearest_gap(tips: Floats, groups: Ints) -> float:
    one = groups == 0
    distances, _ = KDTree(tips[one].reshape(-1, tips.shape[-1])).query(tips[~one].reshape(-1, tips.shape[-1]))
    return float(np.min(distances))


def _refuse_doubled(strokes: list[Stroke[Any]], closed: bool, field: str) -> None:
    """Refuse two strokes that join to a loop because one lies on the other."""
    if closed and len(strokes) == 2 and all(len(s.pieces) == 1 for s in strokes):
        middles = [s.pieces[0].point(np.array([0.5]))[0] for s in strokes]
        if np.linalg.norm(middles[0] - middles[1]) <= JOINT_GAP:
            names = " and ".join(s.name for s in strokes)
            _refuse(f"{names} lie on each other", "each entity once", field)


def _refuse(found: str, limit: str, field: str) -> None:
    raise Refused(
        code="E-DRAWN-CURVES",
        field=field,
        found=found,
        limit=limit,
        way_out="Keep one curve on the layer, its entities joined end to end within 1e-6 mm.",
    )
