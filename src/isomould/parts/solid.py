"""Node solids: one per class, in the node's own frame, made and checked by manifold3d (fabrication, Node solids).

Booleans are made in the node-local frame and with real overlaps: far from the origin or with flush faces
they can lose volume and still report no error.
"""

from dataclasses import dataclass

import manifold3d as m3
import numpy as np

from isomould.arrays import Floats, Ints, read_only
from isomould.errors import IsomouldError
from isomould.parts.details.joint import Carving, Joint
from isomould.parts.nodes import NodeParts
from isomould.parts.plates import Shape, shape_of
from isomould.progress import Told, count_for_nobody, counted

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
        Computed without the solid kernel.
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


def make_solids(nodes: NodeParts, joints: tuple[Joint, ...], told: Told = count_for_nobody) -> tuple[Solid, ...]:
    """Build the solid of every node class, counted.

    Raises
    ------
    SolidError
        If the solid kernel's result fails a check.
    """
    classes = list(zip(joints, nodes.marks, strict=True))
    return tuple(make_solid(joint.carve(), joint.genus, mark) for joint, mark in counted(classes, told))


def make_bodies(nodes: NodeParts, joints: tuple[Joint, ...], told: Told = count_for_nobody) -> tuple[Shape, ...]:
    """Give the surfaces of the solids of every node class, counted, not measured: a quarter of the work.

    Raises
    ------
    SolidError
        If the solid kernel fails.
    """
    classes = list(zip(joints, nodes.marks, strict=True))
    return tuple(shape_of(_cut(joint.carve(), mark)) for joint, mark in counted(classes, told))


def _cut(carving: Carving, mark: str) -> m3.Manifold:
    body = carving.blank - carving.cutters
    _require(body.status() == m3.Error.NoError and not body.is_empty(), mark, f"status {body.status()}")
    return body


def make_solid(carving: Carving, genus: int, mark: str) -> Solid:
    """Cut a solid out of its blank and check it; `genus` is the number of its through holes."""
    blank, cutters = carving.blank, carving.cutters
    body = _cut(carving, mark)
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
        analytic_volume=carving.volume,
    )
    _check(solid, blank.volume() - overlap.volume(), genus, mark)
    return solid


def _difference(one: m3.Manifold, other: m3.Manifold) -> float:
    """Larger relative difference of volume and surface area."""
    volume = abs(one.volume() - other.volume()) / other.volume()
    return max(volume, abs(one.surface_area() - other.surface_area()) / other.surface_area())


def _check(solid: Solid, expected: float, genus: int, mark: str) -> None:
    """Hold a solid to proof V20–V22 and to its analytic volume."""
    _require(solid.components == 1, mark, f"{solid.components} components")
    _require(solid.genus == genus, mark, f"genus {solid.genus}")
    _require(bool(np.isfinite(solid.vertices).all()), mark, "vertices that are not finite")
    _require(abs(solid.volume - expected) <= _NOISE * expected, mark, "a volume that its parts do not explain")
    _require(solid.inclusion_exclusion <= _NOISE, mark, f"inclusion–exclusion off by {solid.inclusion_exclusion:g}")
    _require(solid.commutativity <= _NOISE, mark, f"operands that do not commute: {solid.commutativity:g}")
    off = abs(solid.volume - solid.analytic_volume) / solid.analytic_volume
    _require(off <= _NOISE, mark, f"a volume {off:g} off the one computed without it")


def _require(truth: bool, mark: str, found: str) -> None:
    if not truth:
        message = (
            f"E-SOLID {mark}: the solid kernel returned {found}. This is a fault of the program; please report it."
        )
        raise SolidError(message)
