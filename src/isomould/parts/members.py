"""Members between two nodes, with the ends that the node detail asks for (fabrication, Constant-height beams)."""

from dataclasses import dataclass, replace

import numpy as np

from isomould.arrays import Floats, Ints, read_only, round_um
from isomould.errors import Refused
from isomould.form.mesh import Family, Mesh
from isomould.parts.arms import Arms
from isomould.parts.catalogue import AnySection, PlateSection
from isomould.parts.congruence import Classes, classify
from isomould.parts.details.joint import Joint, MemberEnd
from isomould.parts.features import EndPlate, Hole
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

    Lengths in mm, angles in rad; `end_angle` is 0 for a square end and positive where the top is longer. A hollow
    section may have a plate in both ends.
    """

    section: AnySection
    outline: Floats
    system_length: float
    top_length: float
    bottom_length: float
    end_angle: tuple[float, float]
    set_back: tuple[float, float]
    holes: tuple[Hole, ...] = ()
    end_plates: tuple[EndPlate, ...] = ()

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

    @property
    def volume(self) -> float:
        """Volume without the holes, end plates included, mm³."""
        holes = sum(hole.area for hole in self.holes)
        if isinstance(self.section, PlateSection):
            return (self.area - holes) * self.section.thickness
        plates = sum(plate.thickness * (self.section.void - plate.hole_area) for plate in self.end_plates)
        return self.section.area * self.cut_length - holes * self.section.wall + plates

    @property
    def paint_area(self) -> float:
        """Area that is coated, mm²: all of a plate, the outside of a hollow section."""
        holes = sum(hole.area for hole in self.holes)
        if isinstance(self.section, PlateSection):
            rims = self.perimeter + sum(hole.perimeter for hole in self.holes)
            return 2 * (self.area - holes) + rims * self.section.thickness
        return self.section.girth * self.cut_length - holes


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
    joints: tuple[Joint, ...],
    settings: MemberSettings,
    tolerance: CongruenceSettings,
) -> MemberParts:
    """Sort the members into classes and cut one of each as its nodes ask.

    Raises
    ------
    Refused
        If a member is too short for its nodes, or an end cut too sharp for the saw.
    """
    length = np.linalg.norm(mesh.nodes[mesh.edges[:, 1]] - mesh.nodes[mesh.edges[:, 0]], axis=1)
    there = [joints[k] for k in nodes.classes.of]
    clear = set_backs(mesh, arms, there, settings)
    elevation, tags = _end_cuts(mesh, arms, there)
    numbers, labels = _variants(length, elevation, clear, tags, mesh.family)
    spread = np.array([tolerance.length, *[np.radians(tolerance.angle_deg)] * 2, *[tolerance.length] * 2])
    classes = classify(numbers, labels, spread)
    where = member_locations(mesh)
    shapes = tuple(
        _cut_sill(length[k], clear[k], settings, where[k])
        if mesh.family[k] == Family.SILL
        else _cut(length[k], _ends(mesh, there, elevation, settings, k), settings, where[k])
        for k in classes.representative
    )
    lever = np.array([1.0, settings.section.depth / 2, settings.section.depth / 2, 1.0, 1.0])
    return MemberParts(
        classes=classes,
        marks=marks("M", len(shapes)),
        locations=where,
        shapes=shapes,
        family=mesh.family[classes.representative],
        deviation=(classes.deviation * lever).max(axis=1),
    )


def _end_cuts(mesh: Mesh, arms: Arms, joints: list[Joint]) -> tuple[Floats, Ints]:
    """Elevations (e, 2) rad that end cuts follow, and tags (e, 2) of what else of the nodes shapes the ends."""
    square = (mesh.family == Family.SILL) | (not joints[0].leans)
    elevation = np.where(square[:, None], 0.0, end_elevations(arms, len(mesh.edges)))
    tags = np.array([joint.tag for joint in joints])[mesh.edges]
    return elevation, np.where((mesh.family == Family.SILL)[:, None], 0, tags)


def _ends(mesh: Mesh, joints: list[Joint], elevation: Floats, settings: MemberSettings, edge: int) -> list[MemberEnd]:
    """What both nodes of a member ask of its ends."""
    section = settings.of(mesh.family[edge])
    return [joints[mesh.edges[edge, end]].end(section, float(elevation[edge, end])) for end in (0, 1)]


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


def _variants(length: Floats, elevation: Floats, clear: Floats, tag: Ints, family: Ints) -> tuple[Floats, Ints]:
    """Descriptions of a plate as it stands, end for end, upside down, and both (geometry §7)."""
    (start, end), (here, there) = elevation.T, clear.T
    rows = [(start, end, here, there), (end, start, there, here), (-start, -end, here, there)]
    rows += [(-end, -start, there, here)]
    numbers = np.stack([np.stack([length, *row], axis=-1) for row in rows], axis=1)
    first, last = tag.T
    tags = [(family, first, last), (family, last, first)] * 2
    return numbers, np.stack([np.stack(tag, axis=-1) for tag in tags], axis=1)


def _cut(length: float, ends: list[MemberEnd], settings: MemberSettings, where: str) -> MemberShape:
    """Cut one member at both ends."""
    _refuse_sharp(ends, settings, where)
    start, end = ends[0].outline, _mirrored(ends[1].outline, length)
    bottom, top = (round_um(end[k]) - round_um(start[-1 - k]) for k in (0, -1))
    _refuse_short(min(bottom[0], top[0], length - ends[0].reach - ends[1].reach), length, settings, where)
    return MemberShape(
        section=ends[0].section,
        outline=round_outline(np.concatenate([start, end])),
        system_length=float(length),
        top_length=float(top[0]),
        bottom_length=float(bottom[0]),
        end_angle=(ends[0].angle, ends[1].angle),
        set_back=(ends[0].set_back, ends[1].set_back),
        holes=(*ends[0].holes, *(_moved(hole, length) for hole in reversed(ends[1].holes))),
        end_plates=tuple(end.plate for end in ends if end.plate),
    )


def _mirrored(outline: Floats, length: float) -> Floats:
    """An end as seen from the member's start, from bottom to top."""
    return np.stack([length - outline[::-1, 0], outline[::-1, 1]], axis=-1)


def _moved(hole: Hole, length: float) -> Hole:
    return replace(hole, x=float(round_um(np.array(length - hole.x))))


def _cut_sill(length: float, clear: Floats, settings: MemberSettings, where: str) -> MemberShape:
    """Cut one sill square, clear of its nodes."""
    section = settings.of(Family.SILL)
    half, (start, end) = section.depth / 2, (float(clear[0]), float(round_um(length - clear[1])))
    _refuse_short(end - start, length, settings, where)
    return MemberShape(
        section=section,
        outline=round_outline(np.array([[start, half], [start, -half], [end, -half], [end, half]])),
        system_length=float(length),
        top_length=end - start,
        bottom_length=end - start,
        end_angle=(0.0, 0.0),
        set_back=(float(clear[0]), float(clear[1])),
    )


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


def _refuse_sharp(ends: list[MemberEnd], settings: MemberSettings, where: str) -> None:
    sharpest = float(np.degrees(max(abs(end.angle) for end in ends)))
    if sharpest > settings.max_end_angle_deg:
        raise Refused(
            "E-MEMBER-SHARP",
            f"members ({where})",
            f"an end cut of {sharpest:.3f}°",
            f"at most members.max_end_angle_deg = {settings.max_end_angle_deg:g}°",
            "Divide the curves more finely, or raise the limit if the saw allows it.",
        )
