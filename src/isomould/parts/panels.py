"""Panels on their seats: outlines with clear gaps, packers and bearing (fabrication, Panels).

A panel is a convex polygon. What belongs to its sides is kept in rows like `Mesh.faces`: k in all, side and corner 0 of
a face first, then counter-clockwise from outside; side 0 of a whole panel lies on parallel i. In the section across
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
    edges : (k,) int
        Mesh edge under every side, −1 where a plane cut and there is no sill.
    packers : (k,) float, mm
        Packer thickness on the seat under every side; NaN where there is no seat, along a cut.
    bearing : (k,) float, mm
        Width of the seat that every side covers; infinite where there is no seat.
    underside : float, mm
        Distance D of the panels' undersides from the mesh faces.
    corners : (k, 3) float, mm
        Corners of the undersides in space, the first of a whole panel at node (i, j).
    normals : (f, 3) float
    slope : (f,) float, rad
        Angle between the panel's normal and the vertical.
    flatness : (f,) float, mm
        Distance of the other corners from the plane of the first three.
    deviation : (f,) float, mm
        Largest difference of a side or diagonal from the class.
    first_corner : (f,) int
        Which corner (from 0) of the part lies at the face's first corner.
    lowest_corner : (f,) int
        Which corner (from 0) of the face lies at the part's first corner.
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
    lowest_corner: Ints
    turned_over: Bools

    def __post_init__(self) -> None:
        for value in vars(self).values():
            if isinstance(value, np.ndarray):
                read_only(value)


@dataclass(frozen=True, eq=False)
class _Seats:
    """What panels see of the members under their sides: all (k,), vectors (k, 3).

    `origin`, `x` and `y` are the frame of the face; `ahead`, `behind` lead to the next and the last side of the face.
    A side that a plane cut has no seat; there `upright` is the direction, in the face's cross-section, of that plane's
    normal.
    """

    corner: Floats
    along: Floats
    inward: Floats
    normal: Floats
    fall: Floats
    edge: Ints
    boundary: Bools
    rimmed: Bools
    upright: Floats
    origin: Floats
    x: Floats
    y: Floats
    ahead: Ints
    behind: Ints


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
    where = locations("P", mesh.face_ij, mesh.face_piece)
    sides = [
        f"side {_letter(side)} of {name}" for name, size in zip(where, mesh.sizes, strict=True) for side in range(size)
    ]
    _refuse_bearing(bearing, sides, settings)
    corners = _outlines(seats, _insets(seats, underside, settings))
    _refuse_vanished(seats, corners, sides)
    polygons, sizes = _padded(mesh, corners), mesh.sizes
    numbers, labels = _variants(polygons, sizes, flippable=settings.flippable)
    spread = np.full(numbers.shape[2], tolerance.length)
    classes = classify(numbers, labels, spread)
    chosen, starts = classes.representative, mesh.face_offsets[:-1]
    return PanelParts(
        classes=classes,
        marks=marks("P", len(chosen)),
        locations=where,
        outlines=tuple(round_outline(_upright(polygons[k, : sizes[k]])) for k in chosen),
        handed=_handedness(polygons[chosen], sizes[chosen], spread, flippable=settings.flippable),
        edges=seats.edge,
        packers=np.where(seats.rimmed, np.nan, underside - top),
        bearing=bearing,
        underside=underside,
        corners=_in_space(seats, corners, underside),
        normals=seats.normal[starts],
        slope=np.arccos(np.clip(seats.normal[starts, 2], -1.0, 1.0)),
        flatness=_flatness(mesh),
        deviation=classes.deviation.max(axis=1),
        first_corner=_first_corner(classes.variant, sizes),
        lowest_corner=_orders(sizes, flippable=settings.flippable)[np.arange(len(sizes)), classes.variant, 0],
        turned_over=classes.variant >= sizes.max(),
    )


def _letter(side: int) -> str:
    return "abcdefghijklmnopqrstuvwxyz"[side]


def _find_seats(mesh: Mesh) -> _Seats:
    corner, ahead = mesh.nodes[mesh.faces], mesh.ahead
    along = normalised(corner[ahead] - corner)
    normal = mesh.per_corner(_normals(mesh))
    inward = np.cross(normal, along)
    edge, rimmed = _edges_of(mesh), mesh.rimmed
    axes = mesh.axes[mesh.faces]
    sum_of_axes = axes + axes[ahead]
    top = normalised(sum_of_axes - _dot(sum_of_axes, along)[..., None] * along)
    fall = np.where(rimmed, 0.0, np.arctan2(-_dot(inward, top), _dot(normal, top)))
    boundary = rimmed | (np.bincount(edge[edge >= 0], minlength=len(mesh.edges))[edge] == 1)
    upright = np.stack([_dot(mesh.rims, inward), _dot(mesh.rims, normal)], axis=-1)
    first = mesh.per_corner(mesh.face_offsets[:-1])
    frame = corner[first], along[first], inward[first]
    return _Seats(
        corner, along, inward, normal, fall, edge, boundary, rimmed, upright, *frame, ahead, np.argsort(ahead)
    )


def _normals(mesh: Mesh) -> Floats:
    """Unit normals (f, 3) of convex faces, from two diagonals that cross (a triangle's sides)."""
    corner, starts = mesh.nodes[mesh.faces], mesh.face_offsets[:-1]
    last = corner[mesh.face_offsets[1:] - 1]
    return normalised(np.cross(corner[starts + 2] - corner[starts], last - corner[starts + 1]))


def _dot(a: Floats, b: Floats) -> Floats:
    return np.einsum("...k,...k->...", a, b)


def _edges_of(mesh: Mesh) -> Ints:
    """Mesh edge (k,) under every side, found by its pair of nodes; −1 for none."""
    count = len(mesh.nodes)
    key = np.sort(mesh.edges, axis=1) @ np.array([count, 1])
    asked = np.sort(np.stack([mesh.faces, mesh.faces[mesh.ahead]], axis=-1), axis=-1) @ np.array([count, 1])
    order = np.argsort(key)
    found = order[np.minimum(np.searchsorted(key[order], asked), len(key) - 1)]
    return np.where(key[found] == asked, found, -1)


def _seat_tops(seats: _Seats, depth: float, settings: PanelSettings) -> Floats:
    """Height (k,) of the governing seat corner above the face: `(h/2 + seat height) cos β + q sin β`."""
    low = np.where(seats.boundary, -min(settings.edge_overhang, settings.seat_width / 2), settings.gap / 2)
    reach = np.where(seats.fall >= 0, settings.seat_width / 2, low)
    top = (depth / 2 + settings.seat_height) * np.cos(seats.fall) + reach * np.sin(seats.fall)
    return np.where(seats.rimmed, -np.inf, top)


def _narrowest(seats: _Seats, settings: PanelSettings) -> Floats:
    """Distance u (k,) of the underside's edge from the centre plane that keeps the gap clear at every level."""
    return settings.gap / 2 + settings.thickness * np.maximum(0.0, -np.sin(seats.fall))


def _insets(seats: _Seats, underside: float, settings: PanelSettings) -> Floats:
    """How far (k,) every side lies inside the mesh edge, in the panel's plane: trace, then gap or overhang.

    Along a cut a panel ends square over the face's edge, and further inside where it would reach beyond the plane.
    """
    trace = -underside * np.tan(seats.fall)
    clear = _narrowest(seats, settings) / np.cos(seats.fall)
    inset = trace + np.where(seats.boundary, -settings.edge_overhang, clear)
    towards, away = np.maximum(seats.upright[:, 0], 1e-9), np.maximum(-seats.upright[:, 1], 0.0)
    return np.where(seats.rimmed, (underside + settings.thickness) * away / towards, inset)


def _bearing(seats: _Seats, settings: PanelSettings) -> Floats:
    half = settings.seat_width / 2
    outer = half + np.minimum(settings.edge_overhang * np.cos(seats.fall), half)
    bearing = np.where(seats.boundary, outer, half - _narrowest(seats, settings))
    return np.where(seats.rimmed, np.inf, bearing)


def _outlines(seats: _Seats, inset: Floats) -> Floats:
    """Corners (k, 2) of the panels in the frames of their faces: x along side 0, origin at its first node."""
    point = _in_plane(seats, seats.corner + inset[..., None] * seats.inward - seats.origin)
    along = _in_plane(seats, seats.along)
    before_point, before = point[seats.behind], along[seats.behind]
    reach = _cross(point - before_point, along) / _cross(before, along)
    return before_point + reach[..., None] * before


def _in_plane(seats: _Seats, vectors: Floats) -> Floats:
    """Components (k, 2) of vectors (k, 3) in the frames of their faces."""
    return np.stack([_dot(vectors, seats.x), _dot(vectors, seats.y)], axis=-1)


def _in_space(seats: _Seats, corners: Floats, underside: float) -> Floats:
    """Corners (k, 3) mm in space of outlines (k, 2) in the frames of their faces."""
    origin = seats.origin + underside * seats.normal
    return origin + corners[..., :1] * seats.x + corners[..., 1:] * seats.y


def _cross(a: Floats, b: Floats) -> Floats:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def _upright(corners: Floats) -> Floats:
    """Move a panel (n, 2) to the origin with side 0 along +x (its frame is already parallel to it)."""
    return corners - corners[0]


def _padded(mesh: Mesh, corners: Floats) -> Floats:
    """Polygons (f, v, 2) of the corners (k, 2); NaN beyond the corners of a face."""
    rows = mesh.table(np.arange(len(corners)))
    return np.where(rows[..., None] >= 0, corners[rows], np.nan)


def _orders(sizes: Ints, *, flippable: bool) -> Ints:
    """Ways (f, s, v) to read the corners of polygons: from every corner, and backwards where they may be turned over.

    A polygon of fewer corners than others repeats its first way, and the corners from its first.
    """
    size, most = sizes[:, None, None], int(sizes.max())
    start, step = np.arange(most)[None, :, None], np.arange(most)[None, None, :]
    start = np.where(start < size, start, 0)
    ways = [(start + step) % size, (start - 1 - step) % size]
    return np.concatenate(ways[: 1 + flippable], axis=1)


def _variants(corners: Floats, sizes: Ints, *, flippable: bool) -> tuple[Floats, Ints]:
    """Sides and diagonals (f, s, q) of polygons (f, v, 2), read in all ways; labelled by the number of corners."""
    ways = _orders(sizes, flippable=flippable)
    numbers = np.stack([_measures(corners, ways[:, k], sizes) for k in range(ways.shape[1])], axis=1)
    return numbers, np.broadcast_to((sizes - sizes.max())[:, None, None], (*ways.shape[:2], 1)).astype(np.int64)


def _measures(corners: Floats, order: Ints, sizes: Ints) -> Floats:
    """Sides, then diagonals past one corner (f, 2v − 2) mm of polygons read in an order (f, v); 0 beyond the last."""
    around = np.take_along_axis(corners, order[..., None], axis=1)
    step, size = np.arange(order.shape[1]), sizes[:, None]
    lengths = [_reach(around, (step + skip) % size) for skip in (1, 2)]
    sides = np.where(step < size, lengths[0], 0.0)
    return np.concatenate([sides, np.where(step < size - 2, lengths[1], 0.0)[:, :-2]], axis=1)


def _reach(around: Floats, other: Ints) -> Floats:
    """Distances (f, v) of the corners of polygons (f, v, 2) from other corners (f, v)."""
    return np.linalg.norm(np.take_along_axis(around, other[..., None], axis=1) - around, axis=2)


def _first_corner(variant: Ints, sizes: Ints) -> Ints:
    """Corner (f,) of the part at corner 0 of the face: variant k starts at corner k, backwards if turned over."""
    most = sizes.max()
    shift = variant % most
    return np.where(variant >= most, sizes - 1 + shift, -shift) % sizes


def _handedness(corners: Floats, sizes: Ints, tolerance: Floats, *, flippable: bool) -> tuple[Handed, ...]:
    """Chirality (k,) of the classes: of a mirrored pair, the one with the smaller description is L."""
    numbers, labels = _variants(corners, sizes, flippable=True)
    ways = numbers.shape[1] // 2
    same = agrees_with_mirror(numbers[:, 0], numbers[:, ways:], labels[:, : ways + 1], tolerance)
    left = smallest(numbers, labels) < ways
    return tuple("none" if same[k] or flippable else ("L" if left[k] else "R") for k in range(len(corners)))


def _flatness(mesh: Mesh) -> Floats:
    corner, starts = mesh.nodes[mesh.faces], mesh.face_offsets[:-1]
    first = corner[starts]
    normal = normalised(np.cross(corner[starts + 1] - first, corner[starts + 2] - first))
    off = np.abs(_dot(corner - mesh.per_corner(first), mesh.per_corner(normal)))
    place = np.arange(len(corner)) - mesh.per_corner(starts)
    return np.maximum.reduceat(np.where(place > 2, off, 0.0), starts)


def _refuse_bearing(bearing: Floats, sides: list[str], settings: PanelSettings) -> None:
    worst = int(np.argmin(bearing))
    if bearing[worst] < settings.min_bearing - 1e-9:
        needed = settings.seat_width + 2 * (settings.min_bearing - bearing[worst])
        raise Refused(
            "E-PANEL-BEARING",
            "panels.seat_width",
            f"{sides[worst]} bears on {bearing[worst]:.3f} mm of the seat",
            f"at least panels.min_bearing = {settings.min_bearing:g} mm",
            f"Give seats of {needed:.3f} mm or more, a smaller gap or thinner panels.",
        )


def _refuse_vanished(seats: _Seats, corners: Floats, sides: list[str]) -> None:
    """Refuse panels with a side that no longer runs the way of its mesh edge."""
    length = _dot(corners[seats.ahead] - corners, _in_plane(seats, seats.along))
    worst = int(np.argmin(length))
    if length[worst] <= 0:
        raise Refused(
            "E-PANEL-VANISHED",
            "panels",
            f"nothing is left of {sides[worst]} between its gaps ({length[worst]:.3f} mm)",
            "sides of a positive length",
            "Divide the curves more coarsely, use smaller gaps and lower seats, or move the trimming plane.",
        )
