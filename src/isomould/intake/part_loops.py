"""Closed loops of a part drawing, sorted by what lies in what: outlines, and the holes in them."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NoReturn

import numpy as np
import shapely

from isomould.arrays import Floats
from isomould.curves.pieces import Line, Piece
from isomould.errors import Refused

_SAGITTA = 0.005
"""How far chords may be off a curve where only the place of loops counts, mm."""

_MOST_CHORDS = 2**12


@dataclass(frozen=True, eq=False)
class Loop:
    """A closed chain of pieces, counter-clockwise, how messages call it, and its layer."""

    pieces: tuple[Piece, ...]
    name: str
    layer: str

    @cached_property
    def polygon(self) -> shapely.Polygon:
        """The loop with its curves as chords."""
        return shapely.Polygon(np.concatenate([_chords(piece) for piece in self.pieces]))

    @property
    def place(self) -> str:
        """The middle of the loop's box, for messages."""
        x0, y0, x1, y1 = self.polygon.bounds
        return f"{(x0 + x1) / 2:.3f}, {(y0 + y1) / 2:.3f} mm"


@dataclass(frozen=True, eq=False)
class Nested:
    """An outline with the loops that are cut out of it."""

    outline: Loop
    holes: tuple[Loop, ...]


def make_loop(pieces: Sequence[Piece], name: str, layer: str) -> Loop:
    """Give a closed chain as a loop, turned round if it is drawn clockwise."""
    points = np.concatenate([_chords(piece) for piece in pieces])
    x, y = (points - points[0]).T
    clockwise = float(x @ np.roll(y, -1) - y @ np.roll(x, -1)) < 0
    onward = tuple(piece.reversed() for piece in pieces[::-1]) if clockwise else tuple(pieces)
    return Loop(onward, name, layer)


def loop_of_ring(points: Floats, name: str, layer: str) -> Loop:
    """Give a ring of corners (n, 2) as a loop."""
    corners = [(float(x), float(y)) for x, y in points]
    return make_loop([Line(*side) for side in zip(corners, [*corners[1:], corners[0]], strict=True)], name, layer)


def stroke_points(pieces: Sequence[Piece]) -> Floats:
    """Give points along pieces that join, the last end included."""
    return np.vstack([*(_chords(piece) for piece in pieces), pieces[-1].point(np.ones(1))])


def _chords(piece: Piece) -> Floats:
    """Give points along a piece without its end, close enough to tell what lies where."""
    if isinstance(piece, Line):
        return np.array([piece.start])
    count = 8
    while True:
        points = piece.point(np.linspace(0.0, 1.0, 2 * count + 1))
        middles = (points[:-2:2] + points[2::2]) / 2
        off = float(np.linalg.norm(points[1::2] - middles, axis=1).max())
        # Halving a chord leaves a quarter of its sagitta.
        if off <= 4 * _SAGITTA or count >= _MOST_CHORDS:
            return points[:-1]
        count *= 2


def lies_on(pieces: Sequence[Piece], loop: Loop, join: float) -> bool:
    """Tell whether pieces that join run along a loop all the way."""
    near = loop.polygon.exterior.buffer(join + 2 * _SAGITTA)
    return near.contains(shapely.LineString(stroke_points(pieces)))


def refuse_crossing(loop: Loop, field: str) -> None:
    """Refuse a loop that crosses or touches itself, or runs out and back (a spike), naming the place."""
    if loop.polygon.is_valid and loop.polygon.area > 0:
        return
    reason = shapely.is_valid_reason(loop.polygon)
    where = reason.partition("[")[2].rstrip("]").split()
    place = f" at {float(where[0]):.3f}, {float(where[1]):.3f} mm" if len(where) == 2 else ""
    found = f"{loop.name} crosses itself, or runs out and back{place}"
    _refuse("CROSS", field, found, "a loop that keeps clear of itself", "Redraw it in CAD there.")


def without_copies(loops: Sequence[Loop], join: float) -> tuple[list[Loop], list[Loop]]:
    """Part loops from those that lie on an earlier one all round."""
    late = {k for first, k in _meeting(loops, join) if _same(loops[first], loops[k], join)}
    kept = [loop for k, loop in enumerate(loops) if k not in late]
    return kept, [loops[k] for k in sorted(late)]


def _meeting(loops: Sequence[Loop], join: float) -> list[tuple[int, int]]:
    """Give the pairs of loops (first, later) that overlap, hold each other or come as near as ends that join."""
    polygons = np.array([loop.polygon for loop in loops], dtype=object)
    first, later = shapely.STRtree(polygons).query(polygons, predicate="dwithin", distance=join)
    ahead = first < later
    return list(zip(first[ahead].tolist(), later[ahead].tolist(), strict=True))


def _same(one: Loop, other: Loop, join: float) -> bool:
    room = join + 4 * _SAGITTA
    near = np.abs(np.subtract(one.polygon.bounds, other.polygon.bounds)).max() <= room
    rims = one.polygon.exterior, other.polygon.exterior
    return bool(near) and bool(shapely.hausdorff_distance(*rims, 0.05) <= room)


def nest_loops(loops: Sequence[Loop], named_holes: Sequence[Loop], join: float, field: str) -> list[Nested]:
    """Sort the loops of the outline's layer, and holes on layers of their own, by what lies in what.

    A loop that no other holds is an outline, one inside it a hole. What lies deeper is refused: it would be cut out of
    what has been cut out. A hole that is drawn on two layers is taken once.

    Raises
    ------
    Refused
        E-PART-HOLE for holes that lie in holes, overlap, touch the edge or lie outside; E-PART-CROSS for outlines
        that cross each other.
    """
    outlines = _outermost(loops, join, field)
    inner = [loop for loop in loops if loop not in outlines]
    holes, _ = without_copies([*inner, *named_holes], join)
    _refuse_meeting(holes, join, field)
    tree = shapely.STRtree([loop.polygon for loop in outlines])
    held: list[list[Loop]] = [[] for _ in outlines]
    for hole in holes:
        around = tree.query(hole.polygon.representative_point(), predicate="within").tolist()
        if not around:
            found = f"{hole.name} on layer {hole.layer!r} at {hole.place} lies in no outline"
            _refuse("HOLE", field, found, "holes inside the outline", "Correct the drawing.")
        held[around[0]].append(hole)
        _refuse_edge(outlines[around[0]], hole, join, field)
    found = [Nested(outline, tuple(own)) for outline, own in zip(outlines, held, strict=True)]
    return sorted(found, key=_drawn_place)


def _outermost(loops: Sequence[Loop], join: float, field: str) -> list[Loop]:
    """Give the loops that no other holds."""
    inside = set[int]()
    for one, other in _meeting(loops, join):
        small, large = sorted((one, other), key=lambda k: loops[k].polygon.area)
        if _crosses(loops[one], loops[other]):
            found = f"{loops[one].name} and {loops[other].name} cross each other at {loops[small].place}"
            _refuse("CROSS", field, found, "outlines side by side, holes inside them", "Redraw them in CAD.")
        if loops[large].polygon.contains(loops[small].polygon.representative_point()):
            inside.add(small)
    return [loop for k, loop in enumerate(loops) if k not in inside]


def _crosses(one: Loop, other: Loop) -> bool:
    """Tell whether each has an area outside of the other, beyond what chords leave open."""
    shared = one.polygon.intersection(other.polygon).area
    rim = 4 * _SAGITTA * min(one.polygon.length, other.polygon.length)
    apart = min(one.polygon.area, other.polygon.area) - shared
    return shared > rim and apart > rim


def _drawn_place(one: Nested) -> tuple[float, float]:
    """Sort from left to right, then upwards; a hundredth of a millimetre decides nothing."""
    x, y = one.outline.polygon.bounds[:2]
    return round(x, 1), round(y, 1)


def _refuse_edge(outline: Loop, hole: Loop, join: float, field: str) -> None:
    leaves = not outline.polygon.contains(hole.polygon)
    if leaves or outline.polygon.exterior.distance(hole.polygon) <= join:
        what = "reaches out of" if leaves else "touches"
        found = f"{hole.name} on layer {hole.layer!r} at {hole.place} {what} the outline"
        _refuse("HOLE", field, found, "holes clear of the outline", "Correct the drawing.")


def _refuse_meeting(holes: Sequence[Loop], join: float, field: str) -> None:
    """Refuse holes in holes, and holes that overlap or touch."""
    for pair in _meeting(holes, join):
        small, large = sorted((holes[k] for k in pair), key=lambda loop: loop.polygon.area)
        inside = large.polygon.contains(small.polygon)
        found = f"{small.name} at {small.place} {'lies in' if inside else 'meets'} the hole {large.name}"
        way_out = "Keep one of them; a part that lies in another's hole wants a drawing of its own."
        _refuse("HOLE", field, found, "holes clear of each other", way_out)


def _refuse(what: str, field: str, found: str, limit: str, way_out: str) -> NoReturn:
    raise Refused(f"E-PART-{what}", field, found, limit, way_out)
