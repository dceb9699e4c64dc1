"""Node solids: one per class, in the node's own frame, made and checked by manifold3d (fabrication, Node solids).

Booleans are made in the node-local frame and with real overlaps: far from the origin or with flush faces
they can lose volume and still report no error.
"""

from dataclasses import dataclass

import manifold3d as m3
import numpy as np
import shapely
import shapely.affinity

from isomould.arrays import Floats, Ints, read_only
from isomould.errors import IsomouldError
from isomould.parts.drum import Drum
from isomould.parts.nodes import NodeArms, NodeParts

CHORD = 0.002
"""Largest distance (mm) between a round surface and its facets."""
_OVERLAP = 5.0
_NOISE = 1e-9


class SolidError(IsomouldError):
    """A solid that fails its own checks: a fault of the program, never delivered."""


@dataclass(frozen=True, eq=False)
class Solid:
    """A watertight solid in the node-local frame: +Z along the axis, +X along arm 1's projection.

    Attributes
    ----------
    vertices : (n, 3) float, mm
    triangles : (m, 3) int
        Counter-clockwise from outside.
    volume, surface : float, mm³ and mm²
    status : str
        What the solid kernel says of itself.
    genus, components : int
    inclusion_exclusion, commutativity : float
        Relative residuals of vol(A + B) = vol(A) + vol(B) − vol(A ∩ B), and of volume and area when the operands
        change places.
    analytic_volume : float, mm³
        Cross-section times height, computed without the solid kernel.
    """

    vertices: Floats
    triangles: Ints
    volume: float
    surface: float
    status: str
    genus: int
    components: int
    inclusion_exclusion: float
    commutativity: float
    analytic_volume: float

    def __post_init__(self) -> None:
        read_only(self.vertices)
        read_only(self.triangles)


def make_solids(nodes: NodeParts, drum: Drum, slot_end: str) -> tuple[Solid, ...]:
    """Build the drum of every node class.

    Raises
    ------
    SolidError
        If the solid kernel's result fails a check.
    """
    return tuple(
        _make_solid(arms, drum, float(height), slot_end, mark)
        for arms, height, mark in zip(nodes.arms, drum.height, nodes.marks, strict=True)
    )


def _make_solid(arms: NodeArms, drum: Drum, height: float, slot_end: str, mark: str) -> Solid:
    blank = _cylinder(drum.radius, height)
    cutters = _cutters(arms, drum, height, slot_end)
    body = blank - cutters
    _require(body.status() == m3.Error.NoError and not body.is_empty(), mark, f"status {body.status()}")
    together, overlap = blank + cutters, blank ^ cutters
    sum_of_both = blank.volume() + cutters.volume()
    mesh = body.to_mesh64()
    vertices = np.array(mesh.vert_properties, dtype=np.float64)[:, :3]
    solid = Solid(
        vertices=vertices,
        triangles=np.array(mesh.tri_verts, dtype=np.int64),
        volume=float(body.volume()),
        surface=float(body.surface_area()),
        status=body.status().name,
        genus=int(body.genus()),
        components=len(body.decompose()),
        inclusion_exclusion=abs(together.volume() + overlap.volume() - sum_of_both) / sum_of_both,
        commutativity=_difference(cutters + blank, together),
        analytic_volume=_section_area(arms, drum, slot_end) * height,
    )
    _check(solid, blank.volume() - overlap.volume(), drum.bore > 0, mark)
    return solid


def _difference(one: m3.Manifold, other: m3.Manifold) -> float:
    """Larger relative difference of volume and surface area."""
    volume = abs(one.volume() - other.volume()) / other.volume()
    return max(volume, abs(one.surface_area() - other.surface_area()) / other.surface_area())


def _cylinder(radius: float, height: float) -> m3.Manifold:
    return m3.Manifold.cylinder(height, radius, radius, facets(radius), center=True)


def facets(radius: float) -> int:
    """Number of facets, a multiple of four, that keeps a round surface within `CHORD` of the true one.

    >>> facets(50.0)
    352
    """
    return 4 * int(np.ceil(np.pi / np.arccos(1 - CHORD / max(radius, 1.0)) / 4))


def _cutters(arms: NodeArms, drum: Drum, height: float, slot_end: str) -> m3.Manifold:
    """Slots and bore, longer than the drum at every free end."""
    tall = height + 2 * _OVERLAP
    slots = [_slot(drum, tall, slot_end).rotate((0.0, 0.0, float(np.degrees(a)))) for a in arms.slotted.azimuth]
    bore = [_cylinder(drum.bore / 2, tall)] if drum.bore > 0 else []
    return m3.Manifold.batch_boolean([*slots, *bore], m3.OpType.Add)


def _slot(drum: Drum, tall: float, slot_end: str) -> m3.Manifold:
    """One slot towards +X: its full width reaches from the slot floor beyond the rim."""
    reach = drum.radius + _OVERLAP - drum.slot_floor
    box = m3.Manifold.cube((reach, drum.slot_width, tall), center=True)
    box = box.translate((drum.slot_floor + reach / 2, 0.0, 0.0))
    if slot_end == "square":
        return box
    return box + _cylinder(drum.slot_width / 2, tall).translate((drum.slot_floor, 0.0, 0.0))


def _section_area(arms: NodeArms, drum: Drum, slot_end: str) -> float:
    """Area (mm²) of the drum's cross-section by planar booleans, which share nothing with the solid kernel."""
    slot = shapely.box(drum.slot_floor, -drum.slot_width / 2, drum.radius + _OVERLAP, drum.slot_width / 2)
    if slot_end == "round":
        slot = slot.union(_disc(drum.slot_width / 2, drum.slot_floor))
    slots = [shapely.affinity.rotate(slot, float(a), origin=(0, 0), use_radians=True) for a in arms.slotted.azimuth]
    bore = [_disc(drum.bore / 2)] if drum.bore > 0 else []
    return float(_disc(drum.radius).difference(shapely.union_all([*slots, *bore])).area)


def _disc(radius: float, x: float = 0.0) -> shapely.Polygon:
    angle = np.arange(facets(radius)) * 2 * np.pi / facets(radius)
    return shapely.Polygon(np.stack([x + radius * np.cos(angle), radius * np.sin(angle)], axis=-1))


def _check(solid: Solid, expected: float, bored: bool, mark: str) -> None:
    """Hold a solid to proof V20–V22 and to its analytic volume."""
    _require(solid.components == 1, mark, f"{solid.components} components")
    _require(solid.genus == int(bored), mark, f"genus {solid.genus}")
    _require(bool(np.isfinite(solid.vertices).all()), mark, "vertices that are not finite")
    _require(abs(solid.volume - expected) <= _NOISE * expected, mark, "a volume that its parts do not explain")
    _require(solid.inclusion_exclusion <= _NOISE, mark, f"inclusion–exclusion off by {solid.inclusion_exclusion:g}")
    _require(solid.commutativity <= _NOISE, mark, f"operands that do not commute: {solid.commutativity:g}")
    off = abs(solid.volume - solid.analytic_volume) / solid.analytic_volume
    _require(off <= _NOISE, mark, f"a volume {off:g} off its cross-section times height")


def _require(truth: bool, mark: str, found: str) -> None:
    if not truth:
        message = (
            f"E-SOLID {mark}: the solid kernel returned {found}. This is a fault of the program; please report it."
        )
        raise SolidError(message)
