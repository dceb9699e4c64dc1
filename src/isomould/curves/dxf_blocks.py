"""What the inserts of a drawing show, counted before anything is expanded (failure mode A4).

A block of a few lines can stand for millions of entities, and a site plan holds thousands of trees beside a rail:
only blocks that show the wanted layer are opened, and only as many as somebody may have drawn.
"""

from collections import Counter
from collections.abc import Iterator
from functools import cached_property
from typing import NamedTuple

import numpy as np
from ezdxf.math import OCS

from isomould.arrays import Floats
from isomould.curves.dxf_file import Block, DxfFile, Entity
from isomould.curves.dxf_origins import NEAR, Far, brought_near
from isomould.curves.dxf_records import Record
from isomould.curves.layer_names import layer_key, quoted
from isomould.errors import Refused

MOST_EXPANDED = 50_000
"""Entities that blocks may show on one layer."""

DEEPEST = 64
"""Blocks within blocks."""

LAYER_0 = "0"
"""What a block holds on this layer is on the layer of its INSERT."""

Kinds = Counter[tuple[str, str]]
"""Number of entities by the key of their layer and their type."""


class Shown(NamedTuple):
    """An entity that the model shows, and where its blocks put it."""

    entity: Entity
    inserts: tuple[Entity, ...]
    """From the innermost to the one in the model."""
    place: Floats
    """(4, 4), for rows (x, y, z, 1) from the left."""
    is_near: bool
    """Whether the place is measured from the origin that was asked for."""


class Expansion:
    """The blocks of a file, opened as far as a layer asks for."""

    def __init__(self, file: DxfFile, field: str) -> None:
        self._file, self._field = file, field
        self._known: dict[str, Kinds] = {}
        self._opened: list[str] = []

    @cached_property
    def kinds(self) -> Kinds:
        """What the whole model shows, by layer and type."""
        total = Kinds()
        for entity in self._file.spaces.model:
            total.update(self._kinds_of(entity))
        return total

    def kinds_in(self, block: Block) -> Kinds:
        """Give what a block shows, its own layer 0 among the layers."""
        return self._in_block(layer_key(block.name))

    def placing(self, key: str) -> Iterator[Entity]:
        """Give the entities of the model that are on a layer, and the inserts there that show some."""
        for entity in self._file.spaces.model:
            own = layer_key(entity.layer)
            if own == key if entity.block is None else self._shows(entity, own, key):
                yield entity

    def on_layer(self, layer: str, far: Far = NEAR) -> list[Shown]:
        """Give the entities of the model that are on a layer, blocks measured from an origin.

        Raises
        ------
        Refused
            E-DXF-BLOCK for too many entities, blocks within themselves, references to other files.
        """
        key = layer_key(layer)
        within = sum(self._count(one, key) for one in self._file.spaces.model if one.block is not None)
        if within > MOST_EXPANDED:
            found = f"blocks show {within} entities on layer {quoted(layer)}"
            raise self._refusal(found, f"{MOST_EXPANDED} entities", "Explode what belongs to the curve.")
        view = _View(key, None, (), np.eye(4), far)
        return [one for entity in self._file.spaces.model for one in self._shown(entity, view)]

    def _shown(self, entity: Entity, view: "_View") -> Iterator[Shown]:
        own = _own_layer(entity, view.parent)
        if entity.block is None:
            if own == view.layer:
                yield Shown(entity, view.inserts, view.place, view.is_near)
            return
        block = self._file.blocks.get(entity.block)
        if block is None or block.is_reference:
            self._refuse_reference(entity, own == view.layer)
        elif self._shows(entity, own, view.layer):
            yield from self._inserted(entity, block, view._replace(parent=own))

    def _inserted(self, insert: Entity, block: Block, view: "_View") -> Iterator[Shown]:
        record = self._file.lines.record(insert.number)
        near = record if view.inserts else brought_near(record, view.far, in_world=False)
        placement = Placement.of(near)
        self._refuse_collapsed(insert, placement)
        is_near = view.is_near or near is not record
        for matrix in placement.matrices(block.base):
            place, inserts = matrix @ view.place, (insert, *view.inserts)
            inner = view._replace(place=place, inserts=inserts, is_near=is_near)
            for entity in block.entities:
                if entity.kind != "ATTDEF":
                    yield from self._shown(entity, inner)

    def _shows(self, insert: Entity, own: str, layer: str) -> bool:
        inside = self._in_block(insert.block or "")
        return any(where == layer or (where == LAYER_0 and own == layer) for where, _ in inside)

    def _count(self, insert: Entity, layer: str) -> int:
        """Give how many entities an INSERT of the model shows on a layer; most show none."""
        if not self._shows(insert, layer_key(insert.layer), layer):
            return 0
        return sum(count for (where, _), count in self._kinds_of(insert).items() if where == layer)

    def _kinds_of(self, entity: Entity) -> Kinds:
        own = layer_key(entity.layer)
        if entity.block is None:
            return Kinds({(own, entity.kind): 1})
        inside = self._in_block(entity.block)
        copies = Placement.of(self._file.lines.record(entity.number)).copies if inside else 0
        total = Kinds()
        for (layer, kind), count in inside.items():
            total[own if layer == LAYER_0 else layer, kind] += count * copies
        return total

    def _in_block(self, key: str) -> Kinds:
        """Give what one copy of a block shows; what is on layer 0 there stays so."""
        if key in self._known:
            return self._known[key]
        if key in self._opened or len(self._opened) == DEEPEST:
            found = f"block {quoted(key)} contains itself, or too many blocks within blocks"
            raise self._refusal(found, f"{DEEPEST} blocks within blocks", "Redraw it.")
        block = self._file.blocks.get(key)
        total = Kinds()
        self._opened.append(key)
        for entity in block.entities if block is not None and not block.is_reference else ():
            if entity.kind != "ATTDEF":
                total.update(self._kinds_of(entity))
        self._opened.pop()
        self._known[key] = total
        return total

    def _refuse_collapsed(self, insert: Entity, placement: "Placement") -> None:
        """Refuse what no scale can be read of; heights may be scaled to nothing, as programs for plans do."""
        scales = placement.scales
        if not np.all(np.isfinite(scales)) or 0.0 in scales[:2]:
            found = f"{self._file.called(insert)} has scales {scales[0]:g}, {scales[1]:g}, {scales[2]:g}"
            raise self._refusal(found, "finite scales that are not 0", "Explode the block in the drawing.")

    def _refuse_reference(self, insert: Entity, is_wanted: bool) -> None:
        if is_wanted:
            found = f"{self._file.called(insert)} refers to another drawing, or to no block"
            raise self._refusal(found, "a curve in this file", "Bind the reference into the drawing.")

    def _refusal(self, found: str, limit: str, way_out: str) -> Refused:
        return Refused("E-DXF-BLOCK", self._field, found, limit, way_out)


class _View(NamedTuple):
    """What is looked for, and where the block that is looked into stands."""

    layer: str
    parent: str | None
    """Layer of the INSERT."""
    inserts: tuple[Entity, ...]
    place: Floats
    far: Far
    is_near: bool = False


class Placement(NamedTuple):
    """How an INSERT places its block, as its tags say."""

    at: tuple[float, float, float]
    scales: tuple[float, float, float]
    turn_deg: float
    extrusion: tuple[float, float, float]
    grid: tuple[int, int]
    """Columns and rows."""
    spacing: tuple[float, float]

    @classmethod
    def of(cls, record: Record) -> "Placement":
        """Read the placement; tags that are not there mean 0, 1 or upwards."""
        values = {tag.code: tag.value for tag in reversed(record.tags) if tag.code in _PLACING}

        def number(code: int, default: float) -> float:
            return float(values[code]) if values.get(code) else default

        spacing = (number(44, 0), number(45, 0))
        columns, rows = (max(int(number(code, 1)), 1) for code in (70, 71))
        return cls(
            (number(10, 0), number(20, 0), number(30, 0)),
            (number(41, 1), number(42, 1), number(43, 1)),
            number(50, 0),
            (number(210, 0), number(220, 0), number(230, 1)),
            # copies on one place are one, as CAD shows them
            (columns if spacing[0] else 1, rows if spacing[1] else 1),
            spacing,
        )

    @property
    def copies(self) -> int:
        """The number of copies that a grid of them holds."""
        return self.grid[0] * self.grid[1]

    def matrices(self, base: tuple[float, float, float]) -> Iterator[Floats]:
        """Give where each copy of a block with a base point stands: (4, 4) for rows from the left."""
        ocs = OCS(self.extrusion)
        axes = np.array([ocs.to_wcs(axis) for axis in ((1, 0, 0), (0, 1, 0), (0, 0, 1))], float)
        turn = np.radians(self.turn_deg)
        turned = np.array([[np.cos(turn), np.sin(turn), 0], [-np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
        linear = np.diag(self.scales) @ turned @ axes
        for column in range(self.grid[0]):
            for row in range(self.grid[1]):
                step = np.array([column * self.spacing[0], row * self.spacing[1], 0.0]) @ turned
                matrix = np.eye(4)
                matrix[:3, :3] = linear
                matrix[3, :3] = (np.array(self.at) + step) @ axes - np.array(base) @ linear
                yield matrix


_PLACING = {10, 20, 30, 41, 42, 43, 44, 45, 50, 70, 71, 210, 220, 230}


def _own_layer(entity: Entity, parent: str | None) -> str:
    """Give the key of the layer that an entity shows on."""
    own = layer_key(entity.layer)
    return parent if parent is not None and own == LAYER_0 else own
