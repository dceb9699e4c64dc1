"""General arrangement: the axes in plan, the developed surface with marks and locations, the assembly table."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise

import numpy as np

from isomould.arrays import Floats, Ints
from isomould.documents.shop.assembly import Drawn, assembly
from isomould.documents.shop.development import Block, flat_faces, lay_block, usual_size
from isomould.documents.shop.labels import Labels, face_names, make_names, owners
from isomould.documents.shop.page import NORMAL, SMALLEST, Item, Line, Page, Text, paper_size, point
from isomould.documents.shop.placing import place_all, within
from isomould.documents.shop.rows import Row
from isomould.documents.shop.title_block import Stationery, Subject, finish, room
from isomould.documents.shop.view import View, fit_scale, middle, scale_text
from isomould.form.mesh import Mesh
from isomould.parts.kit import Kit

_SCALES = (5.0, 10.0, 20.0, 25.0, 30.0, 40.0, 50.0, 75.0, 100.0, 200.0, 500.0, 1000.0)
"""Scales of the development: finer steps than elsewhere save sheets."""


def arrangement_pages(
    stationery: Stationery, kit: Kit, rows: Sequence[Row], marks: Mapping[str, str]
) -> tuple[Page, ...]:
    """Draw the general arrangement.

    Parameters
    ----------
    rows
        Of the node instances.
    marks
        Mark by location of all members and panels.
    """
    drawn = [
        _plan(stationery, kit.mesh),
        *_developed(stationery, kit),
        *assembly(stationery, rows, marks),
    ]
    return tuple(
        finish(stationery, Subject(title, "", scale, k, len(drawn)), size, items)
        for k, (title, scale, size, items) in enumerate(drawn, start=1)
    )


def _plan(stationery: Stationery, mesh: Mesh) -> Drawn:
    """Draw all system lines from above; numbers of parallels and generatrices stand at their ends."""
    size = paper_size(stationery.paper or "A3", lying=True)
    left, bottom, right, top = room(stationery, size)
    flat = mesh.nodes[:, :2]
    scale = fit_scale(np.ptp(flat, axis=0), (right - left - 16, top - bottom - 26))
    view = View(scale, middle(flat), np.array([(left + right) / 2, (bottom + top) / 2]))
    places = view.place(flat)
    items: list[Item] = [Line("thin", ends) for ends in places[mesh.edges]]
    caption = Text("Plan of the system lines, numbers of parallels (i) and generatrices (j)", (left, top - 2), NORMAL)
    return "General arrangement", scale_text(scale), size, [*items, caption, *_numbers(mesh, places, [*items, caption])]


def _numbers(mesh: Mesh, places: Floats, items: Sequence[Item]) -> list[Text]:
    ways = [_ends(mesh, places, axis, number) for axis in (0, 1) for number in range(mesh.shape[axis])]
    return place_all([way for way in ways if way], items, 0.4)


def _ends(mesh: Mesh, places: Floats, axis: int, number: int) -> list[Text]:
    """Places for the number of a parallel (axis 0) or generatrix (1) behind both of its ends."""
    line = np.flatnonzero(mesh.node_ij[:, axis] == number)
    line = line[np.argsort(mesh.node_ij[line, 1 - axis], kind="stable")]
    if len(line) < 2:
        return []
    name, drop = f"{'ij'[axis]}{number}", np.array([0.0, -SMALLEST / 2])
    found = list[Text]()
    for end, inner in ((line[0], line[1]), (line[-1], line[-2])):
        way = places[end] - places[inner]
        unit = way / max(float(np.hypot(*way)), 1e-9)
        found += [
            Text(name, point(places[end] + reach * unit + drop), SMALLEST, "middle") for reach in (4.0, 7.0, 10.0)
        ]
    return found


def _developed(stationery: Stationery, kit: Kit) -> Iterator[Drawn]:
    """Draw the panels laid flat, as many on a sheet as can be read."""
    size = paper_size(stationery.paper or "A3", lying=True)
    left, bottom, right, top = room(stationery, size)
    mesh, names, space = kit.mesh, make_names(kit), (right - left, top - bottom - 10.0)
    flat, (width, height) = flat_faces(mesh), usual_size(mesh)
    scale = _readable(min(width, height), names.longest + 4.0)
    per_sheet = [max(1, int(space[k] // (1.07 * side / scale))) for k, side in enumerate((width, height))]
    labels = Labels(mesh, names, *owners(mesh, names))
    for columns in _runs(mesh.face_ij[:, 1], per_sheet[0]):
        for rows in _runs(mesh.face_ij[:, 0], per_sheet[1]):
            block = lay_block(mesh, flat, rows, columns)
            if block.faces:
                yield _block_sheet(block, scale, size, (left, bottom, space), labels)


def _readable(side: float, text: float) -> float:
    """Smallest scale of the list at which a usual side is as long as the longest text, else the largest."""
    return next((scale for scale in reversed(_SCALES) if side / scale >= text), _SCALES[0])


def _runs(numbers: Ints, most: int) -> list[range]:
    """Divide the numbers there are into equal runs of at most so many."""
    low, high = int(numbers.min()), int(numbers.max()) + 1
    count = -(-(high - low) // most)
    bounds = np.linspace(low, high, count + 1).round().astype(int).tolist()
    return [range(a, b) for a, b in pairwise(bounds)]


def _block_sheet(
    block: Block,
    scale: float,
    size: tuple[float, float],
    place: tuple[float, float, tuple[float, float]],
    labels: Labels,
) -> Drawn:
    left, bottom, space = place
    low, high = block.extent
    extent = high - low
    scale = next((s for s in _SCALES if s >= scale and (extent / s <= np.array(space)).all()), _SCALES[-1])
    middle_of = np.array([left + space[0] / 2, bottom + space[1] / 2])
    view = View(scale, (low + high) / 2, middle_of)
    items: list[Item] = [Text(_caption(block, labels.mesh), (left, bottom + space[1] + 5), NORMAL)]
    for face, corners in zip(block.faces, block.corners, strict=True):
        outline = view.outline(corners, "thin")
        items += [outline, *place_all(_inside(face, outline.points, labels), [outline], 0.25)]
    return "General arrangement", scale_text(scale), size, items


def _caption(block: Block, mesh: Mesh) -> str:
    ij = mesh.face_ij[list(block.faces)]
    (low_i, low_j), (high_i, high_j) = ij.min(axis=0).tolist(), ij.max(axis=0).tolist()
    return f"Developed from outside: panels of rows {low_i} to {high_i}, strips {low_j} to {high_j}"


def _inside(face: int, points: Floats, labels: Labels) -> Iterator[list[Text]]:
    """Ways to write the names that belong to a panel without leaving it."""
    return ([text for text in way if within(text, points)] for way in face_names(face, points, labels))
