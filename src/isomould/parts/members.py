"""Members: plates between two nodes, with end cuts and tongues (fabrication, Constant-height beams)."""

from dataclasses import dataclass

import numpy as np

from isomould.arrays import Floats, Ints, read_only, round_um
from isomould.errors import Refused
from isomould.form.mesh import Family, Mesh
from isomould.parts.arms import Arms
from isomould.parts.congruence import Classes, classify
from isomould.parts.drum import Drum
from isomould.parts.features import Hole
from isomould.parts.marks import locations, marks
from isomould.parts.nodes import NodeParts
from isomould.parts.outline import area, round_outline, sides
from isomould.parts.settings import CongruenceSettings, MemberSettings
from isomould.parts.sills import set_backs

TURNED = ("none", "end_for_end", "upside_down", "both")
"""How an instance lies compared with its class, by variant."""


@dataclass(frozen=True, eq=False)
class MemberShape:
    """One member class. The outline has x along the system line from the start node and y to the outside.

    Lengths in mm, angles in rad; `end_angle` is 0 for a square end and positive where the top is longer.
    """

    outline: Floats
    system_length: float
    top_length: float
    bottom_length: float
    end_angle: tuple[float, float]
    set_back: tuple[float, float]
    holes: tuple[Hole, ...] = ()

    @property
    def cut_length(self) -> float:
        """Extent along the member's axis, tongues included."""
        return float(np.ptp(self.outline[:, 0]))

    @property
    def area(self) -> float:
        """Area of the side face, mm²."""
        return area(self.outline)

    @property
    def perimeter(self) -> float:
        """Length of the outline, mm."""
        return float(sides(self.outline).sum())


@dataclass(frozen=True, eq=False)
class MemberParts:
    """Member classes and where they are.

    Attributes
    ----------
    classes : Classes
    marks, locations : tuple of str
        One per class, one per edge of the mesh.
    shapes : tuple of MemberShape
        One per class.
    family : (k,) int
        A `Family` per class.
    deviation : (e,) float, mm
        Largest difference of an instance from its class: in length, or at the ends of its end cuts.
    """

    classes: Classes
    marks: tuple[str, ...]
    locations: tuple[str, ...]
    shapes: tuple[MemberShape, ...]
    family: Ints
    deviation: Floats

    def __post_init__(self) -> None:
        read_only(self.family)
        read_only(self.deviation)


def make_members(
    mesh: Mesh,
    arms: Arms,
    nodes: NodeParts,
    drum: Drum,
    settings: MemberSettings,
    tolerance: CongruenceSettings,
) -> MemberParts:
    """Sort the members into classes and cut one of each.

    Raises
    ------
    Refused
        If a member is too short for its nodes, or an end cut too sharp for the saw.
    """
    length = np.linalg.norm(mesh.nodes[mesh.edges[:, 1]] - mesh.nodes[mesh.edges[:, 0]], axis=1)
    elevation = end_elevations(arms, len(length))
    height = drum.height[nodes.classes.of[mesh.edges]]
    sill = mesh.family == Family.SILL
    clear = set_backs(mesh, arms, height, drum, settings.section)
    elevation[sill], height[sill] = 0.0, 0.0
    numbers, labels = _variants(length, elevation, clear, height, mesh.family)
    spread = np.array([tolerance.length, *[np.radians(tolerance.angle_deg)] * 2, *[tolerance.length] * 2])
    classes = classify(numbers, labels, spread)
    where = member_locations(mesh)
    chosen = classes.representative
    shapes = tuple(
        _cut_sill(length[k], clear[k], settings, where[k])
        if sill[k]
        else _cut(length[k], elevation[k], height[k], drum, settings, where[k])
        for k in chosen
    )
    lever = np.array([1.0, settings.section.depth / 2, settings.section.depth / 2, 1.0, 1.0])
    return MemberParts(
        classes=classes,
        marks=marks("M", len(chosen)),
        locations=where,
        shapes=shapes,
        family=mesh.family[chosen],
        deviation=(classes.deviation * lever).max(axis=1),
    )


def end_elevations(arms: Arms, count: int) -> Floats:
    """Elevations (e, 2) rad of every edge at its start and its end."""
    elevation = np.empty((count, 2))
    elevation[arms.edge, arms.end] = arms.elevation
    return elevation


def member_locations(mesh: Mesh) -> tuple[str, ...]:
    """Give the locations of all mesh edges: `MG-ii-jj` and `MP-ii-jj`, and `MS-kkk` of the sills, which come last."""
    split, sills = np.searchsorted(mesh.family, [Family.PARALLEL, Family.SILL])
    ij, piece = (np.concatenate([values[:sills], values[:1]]) for values in (mesh.edge_ij, mesh.edge_piece))
    ij[-1] = mesh.edge_ij[:sills].max(axis=0)
    generatrices = locations("MG", ij[[*range(split), -1]], piece[[*range(split), -1]])
    parallels = locations("MP", ij[split:], piece[split:])
    return generatrices[:-1] + parallels[:-1] + tuple(f"MS-{k:03d}" for k in range(len(mesh.edges) - sills))


def _variants(length: Floats, elevation: Floats, clear: Floats, height: Floats, family: Ints) -> tuple[Floats, Ints]:
    """Descriptions of a plate as it stands, end for end, upside down, and both (geometry §7)."""
    (start, end), (here, there) = elevation.T, clear.T
    rows = [(start, end, here, there), (end, start, there, here), (-start, -end, here, there)]
    rows += [(-end, -start, there, here)]
    numbers = np.stack([np.stack([length, *row], axis=-1) for row in rows], axis=1)
    first, last = np.round(height * 1000).astype(np.int64).T
    tags = [(family, first, last), (family, last, first)] * 2
    return numbers, np.stack([np.stack(tag, axis=-1) for tag in tags], axis=1)


def _cut(
    length: float, elevation: Floats, height: Floats, drum: Drum, settings: MemberSettings, where: str
) -> MemberShape:
    """Cut one plate at both ends."""
    _refuse_sharp(elevation, settings, where)
    depth = settings.section.depth
    start, end = (_end(e, h, depth, drum) for e, h in zip(elevation, height, strict=True))
    end = np.stack([length - end[::-1, 0], end[::-1, 1]], axis=-1)
    bottom, top = (round_um(end[k]) - round_um(start[-1 - k]) for k in (0, -1))
    _refuse_short(float(min(bottom[0], top[0])), length, settings, where)
    outline = round_outline(np.concatenate([start, end]))
    return MemberShape(
        outline=outline,
        system_length=float(length),
        top_length=float(top[0]),
        bottom_length=float(bottom[0]),
        end_angle=(-float(elevation[0]), -float(elevation[1])),
        set_back=(float(drum.plate_end / np.cos(elevation[0])), float(drum.plate_end / np.cos(elevation[1]))),
    )


def _cut_sill(length: float, clear: Floats, settings: MemberSettings, where: str) -> MemberShape:
    """Cut one sill square, clear of its nodes."""
    half, (start, end) = settings.section.depth / 2, (float(clear[0]), float(round_um(length - clear[1])))
    _refuse_short(end - start, length, settings, where)
    return MemberShape(
        outline=round_outline(np.array([[start, half], [start, -half], [end, -half], [end, half]])),
        system_length=float(length),
        top_length=end - start,
        bottom_length=end - start,
        end_angle=(0.0, 0.0),
        set_back=(float(clear[0]), float(clear[1])),
    )


def _end(elevation: float, height: float, depth: float, drum: Drum) -> Floats:
    """Start end of an outline from top to bottom: body corner, shoulder, tongue, shoulder, body corner.

    r is measured from the node axis, z along it. A shoulder lower than 0.002 mm is left out: there the tongue is
    as high as the body.
    """
    sine, cosine = np.sin(elevation), np.cos(elevation)
    top, bottom = ((side * depth / 2 + drum.shoulder * sine) / cosine for side in (1, -1))
    points = [(drum.shoulder, top)]
    points += [(drum.shoulder, height / 2)] if top - height / 2 > 0.002 else []
    points += [(drum.plate_end, height / 2), (drum.plate_end, -height / 2)]
    points += [(drum.shoulder, -height / 2)] if -height / 2 - bottom > 0.002 else []
    r, z = np.array([*points, (drum.shoulder, bottom)]).T
    return np.stack([r * cosine + z * sine, -r * sine + z * cosine], axis=-1)


def _refuse_short(clear: float, length: float, settings: MemberSettings, where: str) -> None:
    if clear < settings.min_clear:
        raise Refused(
            "E-MEMBER-SHORT",
            f"members ({where})",
            f"{clear:.3f} mm of a system line of {length:.3f} mm are left between the end cuts",
            f"at least members.min_clear = {settings.min_clear:g} mm: a system line of "
            f"{length + settings.min_clear - clear:.3f} mm",
            "Divide the curves more coarsely, use smaller drums, or lower members.min_clear.",
        )


def _refuse_sharp(elevation: Floats, settings: MemberSettings, where: str) -> None:
    sharpest = float(np.degrees(np.abs(elevation).max()))
    if sharpest > settings.max_end_angle_deg:
        raise Refused(
            "E-MEMBER-SHARP",
            f"members ({where})",
            f"an end cut of {sharpest:.3f}°",
            f"at most members.max_end_angle_deg = {settings.max_end_angle_deg:g}°",
            "Divide the curves more finely, or raise the limit if the saw allows it.",
        )
