"""General arrangement: the axes in plan, the developed surface with marks and locations, the assembly table."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise

import numpy as np

from isomould.arrays import Floats, Ints
from isomould.documents.shop.assembly import Drawn, assembly
from isomould.documents.shop.development import Block, flat_faces, lay_block, usual_size
from isomould.documents.shop.labels import Labels, face_names, make_names, owners
from isomould.documents.shop.page import NORMAL, Item, Page, Text, paper_size
from isomould.documents.shop.placing import place_all, within
from isomould.documents.shop.rows import Row
from isomould.documents.shop.system_lines import VIEWS, system_line_views
from isomould.documents.shop.title_block import Stationery, Subject, finish, room
from isomould.documents.shop.view import View, scale_text
from isomould.form.mesh import Mesh
from isomould.parts.kit import Kit
from isomould.ties import NOISE

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
    developed, meetings = list(_developed(stationery, kit)), list(assembly(stationery, rows, marks))
    first = 1 + len(VIEWS)
    index = [("Sheet", "Rows", "Strips"), *((str(k), *shown) for k, (shown, _) in enumerate(developed, start=first))]
    drawn = [
        *system_line_views(stationery, kit.mesh, index),
        *(sheet for _, sheet in developed),
        *meetings,
    ]
    return tuple(
        finish(stationery, Subject(title, "", scale, k, len(drawn)), size, items)
        for k, (title, scale, size, items) in enumerate(drawn, start=1)
    )


def _developed(stationery: Stationery, kit: Kit) -> Iterator[tuple[tuple[str, str], Drawn]]:
    """Draw the panels laid flat, as many on a sheet as can be read, with the rows and strips that it shows."""
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
                yield _shown(block, mesh), _block_sheet(block, scale, size, (left, bottom, space), labels)


def _readable(side: float, text: float) -> float:
    """Smallest scale of the list at which a usual side is as long as the longest text, else the largest."""
    return next((scale for scale in reversed(_SCALES) if side / scale >= text - NOISE), _SCALES[0])


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
    scale = next((s for s in _SCALES if s >= scale and (extent / s <= np.array(space) + NOISE).all()), _SCALES[-1])
    middle_of = np.array([left + space[0] / 2, bottom + space[1] / 2])
    view = View(scale, (low + high) / 2, middle_of)
    rows, strips = _shown(block, labels.mesh)
    caption = f"Developed from outside: panels of rows {rows}, strips {strips}"
    items: list[Item] = [Text(caption, (left, bottom + space[1] + 5), NORMAL)]
    for face, corners in zip(block.faces, block.corners, strict=True):
        outline = view.outline(corners, "thin")
        items += [outline, *place_all(_inside(face, outline.points, labels), [outline], 0.25)]
    return "General arrangement", scale_text(scale), size, items


def _shown(block: Block, mesh: Mesh) -> tuple[str, str]:
    """Say which rows and strips of panels a block has."""
    ij = mesh.face_ij[list(block.faces)]
    low, high = ij.min(axis=0).tolist(), ij.max(axis=0).tolist()
    rows, strips = (f"{a} to {b}" if a < b else f"{a}" for a, b in zip(low, high, strict=True))
    return rows, strips


def _inside(face: int, points: Floats, labels: Labels) -> Iterator[list[Text]]:
    """Ways to write the names that belong to a panel without leaving it."""
    return ([text for text in way if within(text, points)] for way in face_names(face, points, labels))
