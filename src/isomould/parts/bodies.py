"""Members as solids, in the frame of their outline: x along, y to the outside, z to the front (fabrication)."""

import manifold3d as m3
import numpy as np

from isomould.arrays import Floats
from isomould.parts.catalogue import AnySection, PlateSection, RhsSection
from isomould.parts.features import Face, Hole
from isomould.parts.kernel import facets
from isomould.parts.members import MemberShape

_OVERLAP = 5.0
"""How far (mm) cutters stand out of what they cut."""

_CORNER = 8
"""Chords of a rounded corner."""

_TURNS: dict[Face, tuple[float, float]] = {"front": (0, 1), "top": (-90, 1), "back": (180, -1), "bottom": (90, -1)}
"""Degrees about x that bring the front to a face, and which way the face's y then runs."""


def member_body(shape: MemberShape) -> m3.Manifold:
    """Build a member with its cuts, holes and end plates."""
    blank = _plate(shape, shape.section) if isinstance(shape.section, PlateSection) else _tube(shape, shape.section)
    cutters = [_cutter(hole, shape) for hole in shape.holes]
    return blank - m3.Manifold.batch_boolean(cutters, m3.OpType.Add) if cutters else blank


def _plate(shape: MemberShape, section: PlateSection) -> m3.Manifold:
    face = m3.CrossSection([shape.outline], m3.FillRule.Positive)
    return m3.Manifold.extrude(face, section.thickness).translate((0.0, 0.0, -section.thickness / 2))


def _tube(shape: MemberShape, section: RhsSection) -> m3.Manifold:
    """A tube is its outside without its void; plates in its ends make the void shorter."""
    start, end = float(shape.outline[:, 0].min()), float(shape.outline[:, 0].max())
    (outer, inner), wall = section.radii, section.wall
    inset = [plate.thickness for plate in shape.end_plates] or [-_OVERLAP, -_OVERLAP]
    body = _bar(section.depth, section.width, outer, (start, end))
    void = _bar(section.depth - 2 * wall, section.width - 2 * wall, inner, (start + inset[0], end - inset[1]))
    return body - void - _bolt_holes(shape, start, end)


def _bolt_holes(shape: MemberShape, start: float, end: float) -> m3.Manifold:
    places = zip((start, end), shape.end_plates, strict=False)
    holes = [
        _drill(plate.diameter, 2 * (plate.thickness + _OVERLAP)).rotate((0.0, 90.0, 0.0)).translate((x, y, 0.0))
        for x, plate in places
        for y in plate.bolts
    ]
    return m3.Manifold.batch_boolean(holes, m3.OpType.Add)


def section_outline(section: AnySection) -> tuple[Floats, ...]:
    """Outlines (n, 2) mm of a section, x across and y along its depth: outer counter-clockwise, holes clockwise."""
    if isinstance(section, PlateSection):
        return (_rounded(section.depth, section.thickness, 0.0),)
    outer, inner = section.radii
    void = _rounded(section.depth - 2 * section.wall, section.width - 2 * section.wall, inner)
    return _rounded(section.depth, section.width, outer), void[::-1]


def _rounded(depth: float, width: float, radius: float) -> Floats:
    """Contour of a rectangle with rounded corners, counter-clockwise."""
    steps = _CORNER + 1 if radius else 1
    angle = (np.arange(steps) / _CORNER + np.arange(4)[:, None]).ravel() * np.pi / 2
    signs = np.repeat([[1, 1], [-1, 1], [-1, -1], [1, -1]], steps, axis=0)
    centres = signs * (np.array([width, depth]) / 2 - radius)
    return centres + radius * np.stack([np.cos(angle), np.sin(angle)], axis=-1)


def _bar(depth: float, width: float, radius: float, reach: tuple[float, float]) -> m3.Manifold:
    """A bar along x with rounded corners, its depth along y."""
    face = m3.CrossSection([_rounded(depth, width, radius)], m3.FillRule.Positive)
    along = m3.Manifold.extrude(face, reach[1] - reach[0]).rotate((0.0, 90.0, 0.0))
    return along.translate((reach[0], 0.0, 0.0))


def _cutter(hole: Hole, shape: MemberShape) -> m3.Manifold:
    """A hole through a plate, or through the one wall of a hollow section that its face is."""
    turn, sign = _TURNS[hole.face]
    disc = _drill(hole.diameter, 2 * _depth(shape))
    ends = [disc.translate((hole.x + side * hole.lengthening / 2, sign * hole.y, 0.0)) for side in (-1, 1)]
    upright = m3.Manifold.batch_hull(ends).translate((0.0, 0.0, _level(hole.face, shape)))
    return upright.rotate((turn, 0.0, 0.0))


def _drill(diameter: float, length: float) -> m3.Manifold:
    """A cylinder about z, half of it on either side, as round as all others."""
    return m3.Manifold.cylinder(length, diameter / 2, diameter / 2, facets(diameter / 2), center=True)


def _depth(shape: MemberShape) -> float:
    """Half the length of a cutter: beyond a plate on both sides, through one wall."""
    section = shape.section
    return section.thickness + _OVERLAP if isinstance(section, PlateSection) else section.wall + 1.0


def _level(face: Face, shape: MemberShape) -> float:
    section = shape.section
    return section.width / 2 if face in {"front", "back"} else section.depth / 2
