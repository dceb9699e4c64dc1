"""Panels on their seats: outlines with clear gaps, packers and bearing (fabrication, Panels).

A panel is a convex polygon. What belongs to its sides is kept in rows like `Mesh.faces`: k in all, side and corner 0 of
a face first, then counter-clockwise from outside; side 0 of a whole panel lies on parallel i. In the section across
an edge, u points from the member's centre plane to the panel and v along the member's top direction; β is the
angle by which the panel falls away from the member's top.
"""

from dataclasses import dataclass

import numpy as np

from isomould.arrays import Bools, Floats, Ints, read_only, round_um
from isomould.errors import Refused
from isomould.form.mesh import Family, Mesh
from isomould.parts.arms import normalised
from isomould.parts.congruence import Classes, Handed, classify, handedness, joined
from isomould.parts.corners import Stacks, Undersides, chamfer_legs, chamfered, refuse_long_chamfers
from isomould.parts.marks import locations, marks
from isomould.parts.outline import round_outline
from isomould.parts.settings import CongruenceSettings, EdgeDeduction, PanelSettings


@dataclass(frozen=True, eq=False)
class PanelParts:
    """Panel classes and where they are.

    Attributes
    ----------
    classes : Classes
    marks, locations : tuple of str
        One per class, one per face of the mesh.
    outlines : tuple of (n, 2) float, mm
        One per class: rounded to 0.001 mm, side 0 along +x, counter-clockwise from outside. Corners may be chamfered.
    blanks : tuple of (n, 2) float, mm
        The outlines without chamfers, corner 0 at the origin: what is nested.
    handed : tuple of str
        Chirality per class; "none" for all where panels may be turned over.
    edges : (k,) int
        Mesh edge under every side, −1 where there is none: on radial sides of caps, and on cuts without sills.
    packers : (k,) float, mm
        Packer thickness on the seat under every side; NaN where there is no seat: on radial sides and along cuts.
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
    blanks: tuple[Floats, ...]
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
    Bare sides have no seat: the radial ones of caps, and those that a plane cut. Along these `upright` is the
    direction, in the face's cross-section, of that plane's normal.
    """

    corner: Floats
    along: Floats
    inward: Floats
    normal: Floats
    fall: Floats
    edge: Ints
    boundary: Bools
    rimmed: Bools
    bare: Bools
    upright: Floats
    origin: Floats
    x: Floats
    y: Floats
    ahead: Ints
    behind: Ints


def make_panels(
    mesh: Mesh,
    depth: float,
    settings: PanelSettings,
    tolerance: CongruenceSettings,
    stacks: Stacks | None = None,
) -> PanelParts:
    """Lay the panels on their seats and sort them into classes; `depth` is the members' depth in mm.

    `stacks` are what stands proud on the nodes: corners that it reaches are chamfered.

    Raises
    ------
    Refused
        If nothing is left of a panel, or too little beside its chamfers.
    """
    seats = _find_seats(mesh)
    top = _seat_tops(seats, depth, settings)
    underside = settings.spacer + float(top.max())
    deduction = _deductions(mesh, seats, settings.edge_deduction)
    bearing = _bearing(seats, deduction, settings)
    where = locations("P", mesh.face_ij, mesh.face_piece)
    sides = _side_names(mesh, where)
    corners = _outlines(seats, _insets(seats, underside, settings) + deduction)
    _refuse_vanished(seats, corners, sides)
    polygons, sizes = _padded(mesh, corners), mesh.sizes
    placed = _in_space(seats, corners, underside)
    legs = _legs(mesh, Undersides(placed, seats.normal, settings.thickness), stacks, settings, sides)
    classes = _classify(polygons, sizes, legs, tolerance.length, flippable=settings.flippable)
    chosen, starts = classes.representative, mesh.face_offsets[:-1]
    over = classes.variant >= sizes
    blanks = tuple(round_outline(_upright(polygons[k, : sizes[k]])) for k in chosen)
    return PanelParts(
        classes=classes,
        marks=marks("P", len(chosen)),
        locations=where,
        outlines=tuple(chamfered(blank, legs[k, : sizes[k]]) for k, blank in zip(chosen, blanks, strict=True)),
        blanks=blanks,
        handed=_handedness(
            polygons[chosen], sizes[chosen], legs[chosen], tolerance.length, flippable=settings.flippable
        ),
        edges=seats.edge,
        packers=np.where(seats.bare, np.nan, underside - top),
        bearing=bearing,
        underside=underside,
        corners=placed,
        normals=seats.normal[starts],
        slope=np.arccos(np.clip(seats.normal[starts, 2], -1.0, 1.0)),
        flatness=_flatness(mesh),
        deviation=classes.deviation.max(axis=1),
        first_corner=np.where(over, classes.variant - 1, -classes.variant) % sizes,
        lowest_corner=(classes.variant - over) % sizes,
        turned_over=over,
    )


def _side_names(mesh: Mesh, where: tuple[str, ...]) -> list[str]:
    """Name all sides (k,) of the panels at these locations."""
    sizes = zip(where, mesh.sizes, strict=True)
    return [f"side {_letter(side)} of {name}" for name, size in sizes for side in range(size)]


def _letter(side: int) -> str:
    """Name side 0 "a", and those of panels with many sides "aa" and so on after "z"."""
    more, last = divmod(side, 26)
    return (_letter(more - 1) if more else "") + "abcdefghijklmnopqrstuvwxyz"[last]


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
    boundary = rimmed | _outermost(mesh)
    upright = np.stack([_dot(mesh.rims, inward), _dot(mesh.rims, normal)], axis=-1)
    first = mesh.per_corner(mesh.face_offsets[:-1])
    frame = corner[first], along[first], inward[first]
    return _Seats(
        corner, along, inward, normal, fall, edge, boundary, rimmed, rimmed | (edge < 0), upright, *frame, ahead,
        np.argsort(ahead),
    )  # fmt: skip


def _outermost(mesh: Mesh) -> Bools:
    """Whether a side (k,) belongs to one face only."""
    low, high = np.sort(mesh.sides, axis=1).T
    _, of, times = np.unique(low * len(mesh.nodes) + high, return_inverse=True, return_counts=True)
    return times[of] == 1


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
    asked = np.sort(mesh.sides, axis=-1) @ np.array([count, 1])
    order = np.argsort(key)
    found = order[np.minimum(np.searchsorted(key[order], asked), len(key) - 1)]
    return np.where(key[found] == asked, found, -1)


def _seat_tops(seats: _Seats, depth: float, settings: PanelSettings) -> Floats:
    """Height (k,) of the governing seat corner above the face: `(h/2 + seat height) cos β + q sin β`."""
    low = np.where(seats.boundary, -min(settings.edge_overhang, settings.seat_width / 2), settings.gap / 2)
    reach = np.where(seats.fall >= 0, settings.seat_width / 2, low)
    top = (depth / 2 + settings.seat_height) * np.cos(seats.fall) + reach * np.sin(seats.fall)
    return np.where(seats.bare, -np.inf, top)


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


def _deductions(mesh: Mesh, seats: _Seats, asked: EdgeDeduction) -> Floats:
    """Distance (k,) in the panel's plane that every side keeps beyond gap or overhang."""
    inner = np.where(mesh.family[seats.edge] == Family.GENERATRIX, asked.generatrix, asked.parallel)
    return np.where(seats.rimmed, asked.cut, np.where(seats.boundary, asked.boundary, inner))


def _bearing(seats: _Seats, deduction: Floats, settings: PanelSettings) -> Floats:
    half, level = settings.seat_width / 2, np.cos(seats.fall)
    outer = half + np.minimum((settings.edge_overhang - deduction) * level, half)
    bearing = np.where(seats.boundary, outer, half - _narrowest(seats, settings) - deduction * level)
    return np.where(seats.bare, np.inf, bearing)


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


def _classify(polygons: Floats, sizes: Ints, legs: Floats, tolerance: float, *, flippable: bool) -> Classes:
    """Sort polygons into classes, those of each number of corners apart; variants count the ways to read a polygon."""
    groups = [np.flatnonzero(sizes == size) for size in np.unique(sizes)]
    own = [slice(sizes[rows[0]]) for rows in groups]
    sorted_apart = [
        _variants(polygons[rows, size], legs[rows, size], flippable=flippable)
        for rows, size in zip(groups, own, strict=True)
    ]
    spread = [np.full(numbers.shape[2], tolerance) for numbers, _ in sorted_apart]
    found = [classify(*each, limit) for each, limit in zip(sorted_apart, spread, strict=True)]
    return joined(groups, found)


def _orders(size: int, *, flippable: bool) -> Ints:
    """Ways (s, v) to read the corners of a polygon: from every corner, and backwards where it may be turned over."""
    start, step = np.arange(size)[:, None], np.arange(size)
    ways = [(start + step) % size, (start - 1 - step) % size]
    return np.concatenate(ways[: 1 + flippable])


def _legs(mesh: Mesh, panels: Undersides, stacks: Stacks | None, settings: PanelSettings, sides: list[str]) -> Floats:
    """Legs (f, v) of the chamfers at all corners; 0 for none and beyond the corners of a face."""
    if stacks is None:
        return np.zeros((len(mesh.sizes), int(mesh.sizes.max())))
    legs = chamfer_legs(mesh, panels, stacks, settings.corner_clearance)
    refuse_long_chamfers(mesh, panels.corners, legs, sides)
    rows = mesh.table(np.arange(len(legs)))
    return np.where(rows >= 0, round_um(legs)[rows], 0.0)


def _variants(corners: Floats, legs: Floats, *, flippable: bool) -> tuple[Floats, Ints]:
    """Sides, diagonals past one corner, chamfers (f, s, 3v − 2) of polygons (f, v, 2), read in all ways; no labels."""
    ways = _orders(corners.shape[1], flippable=flippable)
    around = corners[:, ways]
    lengths = [np.linalg.norm(np.roll(around, -skip, axis=2) - around, axis=3) for skip in (1, 2)]
    numbers = np.concatenate([lengths[0], lengths[1][..., :-2], legs[:, ways]], axis=2)
    return numbers, np.zeros((*numbers.shape[:2], 1), dtype=np.int64)


def _handedness(corners: Floats, sizes: Ints, legs: Floats, tolerance: float, *, flippable: bool) -> tuple[Handed, ...]:
    """Chirality (k,) of the classes; none where panels may be turned over."""
    found: list[Handed] = ["none"] * len(sizes)
    for row in range(0 if flippable else len(sizes)):
        numbers, labels = _variants(
            corners[row : row + 1, : sizes[row]], legs[row : row + 1, : sizes[row]], flippable=True
        )
        own, mirror = ((numbers[:, half], labels[:, half]) for half in (slice(sizes[row]), slice(sizes[row], None)))
        found[row] = handedness(own, mirror, np.full(numbers.shape[2], tolerance))[0]
    return tuple(found)


def _flatness(mesh: Mesh) -> Floats:
    corner, starts = mesh.nodes[mesh.faces], mesh.face_offsets[:-1]
    first = corner[starts]
    normal = normalised(np.cross(corner[starts + 1] - first, corner[starts + 2] - first))
    off = np.abs(_dot(corner - mesh.per_corner(first), mesh.per_corner(normal)))
    place = np.arange(len(corner)) - mesh.per_corner(starts)
    return np.maximum.reduceat(np.where(place > 2, off, 0.0), starts)


def refuse_bearing(panels: PanelParts, mesh: Mesh, settings: PanelSettings) -> None:
    """Refuse panels that cover too little of a seat.

    Raises
    ------
    Refused
        E-PANEL-BEARING, with the narrowest seat that would do.
    """
    bearing, sides = panels.bearing, _side_names(mesh, panels.locations)
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
