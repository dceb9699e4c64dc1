"""Panels on their seats: outlines with clear gaps, packers and bearing (fabrication, Panels).

Sides are numbered from 0: side 0 lies on parallel i, then counter-clockwise from outside. In the section across
an edge, u points from the member's centre plane to the panel and v along the member's top direction; β is the
angle by which the panel falls away from the member's top.
"""

from dataclasses import dataclass

import numpy as np

from isomould.arrays import Bools, Floats, Ints, read_only
from isomould.errors import Refused
from isomould.form.mesh import Mesh
from isomould.parts.arms import normalised
from isomould.parts.congruence import Classes, agrees_with_mirror, classify, smallest
from isomould.parts.marks import locations, marks
from isomould.parts.nodes import Handed
from isomould.parts.outline import round_outline
from isomould.parts.settings import CongruenceSettings, PanelSettings

_SIDES = 4


@dataclass(frozen=True, eq=False)
class PanelParts:
    """Panel classes and where they are.

    Attributes
    ----------
    classes : Classes
    marks, locations : tuple of str
        One per class, one per face of the mesh.
    outlines : tuple of (n, 2) float, mm
        One per class: rounded to 0.001 mm, side 0 along +x from the origin, counter-clockwise from outside.
    handed : tuple of str
        Chirality per class; "none" for all where panels may be turned over.
    edges : (f, 4) int
        Mesh edge under every side.
    packers : (f, 4) float, mm
        Packer thickness on the seat under every side.
    bearing : (f, 4) float, mm
        Width of the seat that every side covers.
    underside : float, mm
        Distance D of the panels' undersides from the mesh faces.
    corners : (f, 4, 3) float, mm
        Corners of the undersides in space, the first at node (i, j).
    normals : (f, 3) float
    slope : (f,) float, rad
        Angle between the panel's normal and the vertical.
    flatness : (f,) float, mm
        Distance of the fourth corner from the plane of the others.
    deviation : (f,) float, mm
        Largest difference of a side or diagonal from the class.
    first_corner : (f,) int
        Which corner (from 0) of the part lies at node (i, j).
    turned_over : (f,) bool
    """

    classes: Classes
    marks: tuple[str, ...]
    locations: tuple[str, ...]
    outlines: tuple[Floats, ...]
    handed: tuple[Handed, ...]
    edges: Ints
    packers: Floats
    bearing: Floats
    underside: float
    corners: Floats
    normals: Floats
    slope: Floats
    flatness: Floats
    deviation: Floats
    first_corner: Ints
    turned_over: Bools

    def __post_init__(self) -> None:
        for value in vars(self).values():
            if isinstance(value, np.ndarray):
                read_only(value)


@dataclass(frozen=True, eq=False)
class _Seats:
    """What panels see of the members under their sides: all (f, 4), vectors (f, 4, 3)."""

    corner: Floats
    along: Floats
    inward: Floats
    normal: Floats
    fall: Floats
    edge: Ints
    boundary: Bools


def make_panels(mesh: Mesh, depth: float, settings: PanelSettings, tolerance: CongruenceSettings) -> PanelParts:
    """Lay the panels on their seats and sort them into classes; `depth` is the members' depth in mm.

    Raises
    ------
    Refused
        If a bearing is too small, or nothing is left of a panel.
    """
    seats = _find_seats(mesh)
    top = _seat_tops(seats, depth, settings)
    underside = settings.spacer + float(top.max())
    bearing = _bearing(seats, settings)
    where = locations("P", mesh.face_ij)
    _refuse_bearing(bearing, where, settings)
    corners = _outlines(seats, _insets(seats, underside, settings))
    _refuse_vanished(corners, _in_plane(seats, seats.along), where)
    numbers, labels = _variants(corners, flippable=settings.flippable)
    spread = np.full(numbers.shape[2], tolerance.length)
    classes = classify(numbers, labels, spread)
    chosen = classes.representative
    return PanelParts(
        classes=classes,
        marks=marks("P", len(chosen)),
        locations=where,
        outlines=tuple(round_outline(_upright(corners[k])) for k in chosen),
        handed=_handedness(corners[chosen], spread, flippable=settings.flippable),
        edges=seats.edge,
        packers=underside - top,
        bearing=bearing,
        underside=underside,
        corners=_in_space(seats, corners, underside),
        normals=seats.normal[:, 0],
        slope=np.arccos(np.clip(seats.normal[:, 0, 2], -1.0, 1.0)),
        flatness=_flatness(mesh),
        deviation=classes.deviation.max(axis=1),
        first_corner=_first_corner(classes.variant),
        turned_over=classes.variant >= _SIDES,
    )


def _find_seats(mesh: Mesh) -> _Seats:
    quads = mesh.quads
    corner = mesh.nodes[quads]
    along = normalised(np.roll(corner, -1, axis=1) - corner)
    normal = normalised(np.cross(corner[:, 2] - corner[:, 0], corner[:, 3] - corner[:, 1]))[:, None].repeat(4, axis=1)
    inward = np.cross(normal, along)
    edge = _edges_of(mesh)
    sum_of_axes = mesh.axes[quads] + mesh.axes[np.roll(quads, -1, axis=1)]
    top = normalised(sum_of_axes - _dot(sum_of_axes, along)[..., None] * along)
    fall = np.arctan2(-_dot(inward, top), _dot(normal, top))
    boundary = np.bincount(edge.ravel(), minlength=len(mesh.edges))[edge] == 1
    return _Seats(corner, along, inward, normal, fall, edge, boundary)


def _dot(a: Floats, b: Floats) -> Floats:
    return np.einsum("...k,...k->...", a, b)


def _edges_of(mesh: Mesh) -> Ints:
    """Mesh edge (f, 4) under every side, found by its pair of nodes."""
    quads, count = mesh.quads, len(mesh.nodes)
    key = np.sort(mesh.edges, axis=1) @ np.array([count, 1])
    asked = np.sort(np.stack([quads, np.roll(quads, -1, axis=1)], axis=-1), axis=-1) @ np.array([count, 1])
    order = np.argsort(key)
    return order[np.searchsorted(key[order], asked)]


def _seat_tops(seats: _Seats, depth: float, settings: PanelSettings) -> Floats:
    """Height (f, 4) of the governing seat corner above the face: `(h/2 + seat height) cos β + q sin β`."""
    low = np.where(seats.boundary, -min(settings.edge_overhang, settings.seat_width / 2), settings.gap / 2)
    reach = np.where(seats.fall >= 0, settings.seat_width / 2, low)
    return (depth / 2 + settings.seat_height) * np.cos(seats.fall) + reach * np.sin(seats.fall)


def _narrowest(seats: _Seats, settings: PanelSettings) -> Floats:
    """Distance u (f, 4) of the underside's edge from the centre plane that keeps the gap clear at every level."""
    return settings.gap / 2 + settings.thickness * np.maximum(0.0, -np.sin(seats.fall))


def _insets(seats: _Seats, underside: float, settings: PanelSettings) -> Floats:
    """How far (f, 4) every side lies inside the mesh edge, in the panel's plane: trace, then gap or overhang."""
    trace = -underside * np.tan(seats.fall)
    clear = _narrowest(seats, settings) / np.cos(seats.fall)
    return trace + np.where(seats.boundary, -settings.edge_overhang, clear)


def _bearing(seats: _Seats, settings: PanelSettings) -> Floats:
    half = settings.seat_width / 2
    outer = half + np.minimum(settings.edge_overhang * np.cos(seats.fall), half)
    return np.where(seats.boundary, outer, half - _narrowest(seats, settings))


def _outlines(seats: _Seats, inset: Floats) -> Floats:
    """Corners (f, 4, 2) of the panels in the frame of their face: x along side 0, origin at node (i, j)."""
    point = _in_plane(seats, seats.corner + inset[..., None] * seats.inward - seats.corner[:, :1])
    along = _in_plane(seats, seats.along)
    before_point, before = np.roll(point, 1, axis=1), np.roll(along, 1, axis=1)
    reach = _cross(point - before_point, along) / _cross(before, along)
    return before_point + reach[..., None] * before


def _in_plane(seats: _Seats, vectors: Floats) -> Floats:
    """Components (f, 4, 2) of vectors (f, 4, 3) in the frames of their faces."""
    return np.stack([_dot(vectors, seats.along[:, :1]), _dot(vectors, seats.inward[:, :1])], axis=-1)


def _in_space(seats: _Seats, corners: Floats, underside: float) -> Floats:
    """Corners (f, 4, 3) mm in space of outlines (f, 4, 2) in the frames of their faces."""
    origin = seats.corner[:, :1] + underside * seats.normal[:, :1]
    return origin + corners[..., :1] * seats.along[:, :1] + corners[..., 1:] * seats.inward[:, :1]


def _cross(a: Floats, b: Floats) -> Floats:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def _upright(corners: Floats) -> Floats:
    """Move a panel (4, 2) to the origin with side 0 along +x (its frame is already parallel to it)."""
    return corners - corners[0]


def _variants(corners: Floats, *, flippable: bool) -> tuple[Floats, Ints]:
    """Sides and diagonals (f, s, 6), started at every corner, and mirrored where a panel may be turned over."""
    orders = [np.roll(np.arange(_SIDES), -k) for k in range(_SIDES)]
    orders += [order[::-1] for order in orders] if flippable else []
    numbers = np.stack([_measures(corners[:, order]) for order in orders], axis=1)
    return numbers, np.zeros((*numbers.shape[:2], 1), dtype=np.int64)


def _measures(corners: Floats) -> Floats:
    """Sides and diagonals (f, 6) mm of quadrilaterals (f, 4, 2), read in the order of their corners."""
    sides = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)
    diagonals = np.linalg.norm(corners[:, [2, 3]] - corners[:, [0, 1]], axis=2)
    return np.concatenate([sides, diagonals], axis=1)


def _first_corner(variant: Ints) -> Ints:
    """Corner (f,) of the part at node (i, j): variant k starts at the k-th corner, backwards if turned over."""
    shift = variant % _SIDES
    return np.where(variant >= _SIDES, (_SIDES - 1 + shift) % _SIDES, (-shift) % _SIDES)


def _handedness(corners: Floats, tolerance: Floats, *, flippable: bool) -> tuple[Handed, ...]:
    """Chirality (k,) of the classes: of a mirrored pair, the one with the smaller description is L."""
    numbers, labels = _variants(corners, flippable=False)
    mirror, tags = _variants(corners[:, ::-1], flippable=False)
    same = agrees_with_mirror(numbers[:, 0], mirror, np.concatenate([labels[:, :1], tags], axis=1), tolerance)
    both = smallest(np.concatenate([numbers, mirror], axis=1), np.concatenate([labels, tags], axis=1))
    left = both < numbers.shape[1]
    return tuple("none" if same[k] or flippable else ("L" if left[k] else "R") for k in range(len(corners)))


def _flatness(mesh: Mesh) -> Floats:
    corner = mesh.nodes[mesh.quads]
    normal = normalised(np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]))
    return np.abs(_dot(corner[:, 3] - corner[:, 0], normal))


def _refuse_bearing(bearing: Floats, where: tuple[str, ...], settings: PanelSettings) -> None:
    face, side = np.unravel_index(int(np.argmin(bearing)), bearing.shape)
    if bearing[face, side] < settings.min_bearing - 1e-9:
        needed = settings.seat_width + 2 * (settings.min_bearing - bearing[face, side])
        raise Refused(
            "E-PANEL-BEARING",
            "panels.seat_width",
            f"side {'abcd'[side]} of {where[face]} bears on {bearing[face, side]:.3f} mm of the seat",
            f"at least panels.min_bearing = {settings.min_bearing:g} mm",
            f"Give seats of {needed:.3f} mm or more, a smaller gap or thinner panels.",
        )


def _refuse_vanished(corners: Floats, along: Floats, where: tuple[str, ...]) -> None:
    """Refuse panels with a side that no longer runs the way (f, 4, 2) of its mesh edge."""
    length = _dot(np.roll(corners, -1, axis=1) - corners, along)
    face, side = np.unravel_index(int(np.argmin(length)), length.shape)
    if length[face, side] <= 0:
        raise Refused(
            "E-PANEL-VANISHED",
            "panels",
            f"nothing is left of side {'abcd'[side]} of {where[face]} between its gaps ({length[face, side]:.3f} mm)",
            "sides of a positive length",
            "Divide the curves more coarsely, or use smaller gaps and lower seats.",
        )
