"""Plan and elevation of the system lines with the numbers of parallels and generatrices, and which sheet shows what."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from isomould.arrays import Floats, Ints
from isomould.documents.shop.assembly import Drawn
from isomould.documents.shop.grid import grid, grid_size
from isomould.documents.shop.page import NORMAL, SMALLEST, Item, Line, Text, paper_size, point
from isomould.documents.shop.placing import Waiting, led, place_all
from isomould.documents.shop.title_block import Stationery, room
from isomould.documents.shop.view import View, fit_scale, middle, scale_text
from isomould.form.mesh import Mesh
from isomould.ties import first_largest

VIEWS = (("Plan", (0, 1)), ("Elevation (x to the right, z up)", (0, 2)))
"""What views are called, and which coordinates they show to the right and up."""
_WORDS = "of the system lines with numbers of parallels (i) and generatrices (j)"
_REACHES = (4.0, 7.0, 10.0)
_BESIDE, _UNDER = 6.0, 8.0


@dataclass(frozen=True, eq=False)
class _Lines:
    """A view: its scale, the places (n, 2) of the nodes on paper, its lines."""

    scale: float
    places: Floats
    lines: tuple[Line, ...]


def system_line_views(stationery: Stationery, mesh: Mesh, index: Sequence[tuple[str, ...]]) -> Iterator[Drawn]:
    """Draw all system lines from above and from the front; `index` are rows that say which sheet shows what.

    The plan has the numbers that find room there, the elevation those of the parallels; what found none gets leaders.
    """
    size = paper_size(stationery.paper or "A3", lying=True)
    left, bottom, right, top = room(stationery, size)
    free, tables = right, list[Item]()
    for rows in _columns(index, top - _UNDER - bottom):
        free -= grid_size(rows, SMALLEST)[0] + _BESIDE
        tables += grid(rows, (free + _BESIDE, top - _UNDER), SMALLEST)
    box = np.array([[left, bottom], [free, top - _UNDER]])
    plan, elevation = (_view(mesh, axes, box) for _, axes in VIEWS)
    above = _numbers(mesh, plan, _all_numbers(mesh))
    front, waiting = _others(mesh, elevation, {text.text for text in above})
    led_there = led(waiting, [*elevation.lines, *front], box)
    for (name, _), view, texts in zip(VIEWS, (plan, elevation), (above, [*front, *led_there]), strict=True):
        caption = Text(f"{name} {_WORDS}", (left, top - 2), NORMAL)
        yield "General arrangement", scale_text(view.scale), size, [caption, *tables, *view.lines, *texts]


def _others(mesh: Mesh, view: _Lines, known: set[str]) -> tuple[list[Text], list[Waiting]]:
    """Number the parallels and what is not known yet; what finds no room in this view and is not known waits."""
    lines = _all_numbers(mesh)
    found = _numbers(mesh, view, [line for line in lines if line[0] == 0 or _name(line) not in known])
    known = known | {text.text for text in found}
    missing = [line for line in lines if _name(line) not in known and len(_nodes(mesh, line)) > 1]
    return found, [(_name(line), _outermost(view.places[_nodes(mesh, line)])[0][0]) for line in missing]


def _all_numbers(mesh: Mesh) -> list[tuple[int, int]]:
    """Give axis (0 for parallels, 1 for generatrices) and number of every line."""
    return [(axis, number) for axis in (0, 1) for number in range(mesh.shape[axis])]


def _name(line: tuple[int, int]) -> str:
    return f"{'ij'[line[0]]}{line[1]}"


def _columns(index: Sequence[tuple[str, ...]], height: float) -> Iterator[list[tuple[str, ...]]]:
    """Divide an index into tables that are not higher than they may be, each with the heading; the last ones first."""
    heading, *rows = index
    most = int(height / grid_size([heading], SMALLEST)[1]) - 1
    for start in range(0, len(rows), most)[::-1]:
        yield [heading, *rows[start : start + most]]


def _view(mesh: Mesh, axes: tuple[int, int], box: Floats) -> _Lines:
    """Draw the lines in the middle of a box (2, 2), with room for numbers around them."""
    flat, space = mesh.nodes[:, axes], np.ptp(box, axis=0) - 2 * (_REACHES[-1] + SMALLEST)
    scale = fit_scale(np.ptp(flat, axis=0), (float(space[0]), float(space[1])))
    places = View(scale, middle(flat), middle(box)).place(flat)
    return _Lines(scale, places, tuple(Line("thin", ends) for ends in places[mesh.edges]))


def _numbers(mesh: Mesh, view: _Lines, wanted: Sequence[tuple[int, int]]) -> list[Text]:
    """Write the numbers of lines, as far as they find room."""
    ways = [_number_places(mesh, view.places, line) for line in wanted]
    return place_all([way for way in ways if way], view.lines, 0.4)


def _nodes(mesh: Mesh, line: tuple[int, int]) -> Ints:
    """Give the nodes of a line, one after the other."""
    axis, number = line
    nodes = np.flatnonzero(mesh.node_ij[:, axis] == number)
    return nodes[np.argsort(mesh.node_ij[nodes, 1 - axis], kind="stable")]


def _number_places(mesh: Mesh, places: Floats, line: tuple[int, int]) -> list[Text]:
    """Places for the number of a line: behind its ends, close beside its outermost nodes."""
    at = places[_nodes(mesh, line)]
    if len(at) < 2:
        return []
    ends = [(at[0], at[0] - at[1]), (at[-1], at[-1] - at[-2])]
    ways = [(end, way, reach) for end, way in ends for reach in _REACHES]
    ways += [(end, way, _REACHES[0]) for end, way in _outermost(at)]
    drop = np.array([0.0, -SMALLEST / 2])
    lengths = [max(float(np.hypot(*way)), 1e-9) for _, way, _ in ways]
    spots = [end + reach / length * way + drop for (end, way, reach), length in zip(ways, lengths, strict=True)]
    return [Text(_name(line), point(spot), SMALLEST, "middle") for spot in spots]


def _outermost(at: Floats) -> list[tuple[Floats, Floats]]:
    """Give the nodes of a line furthest to the right and to the left, each with that direction."""
    ways = [np.array([side, 0.0]) for side in (1.0, -1.0)]
    return [(at[first_largest(at @ way)], way) for way in ways]
