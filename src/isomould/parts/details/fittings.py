"""Made parts that go with nodes and members: caps of slotted drums, plates in hollow sections, fins of hubs."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from isomould.arrays import Floats
from isomould.form.mesh import Family
from isomould.parts.catalogue import AnySection, RhsSection
from isomould.parts.details.caps import Cap
from isomould.parts.details.joint import Fin, Joint
from isomould.parts.details.slotted import SlottedJoint
from isomould.parts.features import EndPlate, Hole
from isomould.parts.marks import marks
from isomould.parts.members import MemberParts, MemberShape
from isomould.parts.nodes import NodeArms, NodeParts
from isomould.parts.outline import area
from isomould.parts.solid import Solid, make_solid


@dataclass(frozen=True, eq=False)
class Fitting:
    """One kind of made part.

    Attributes
    ----------
    mark, kind, size
        The size as a shop writes it: diameter, or depth and width, by thickness.
    quantity : int
        In the whole design.
    volume : float, mm³
    surface : float, mm², optional
        What is coated of it; nothing for fins, which are coated on their hubs.
    solid : Solid, optional
        Of a turned part, in its own frame.
    outline : (n, 2) float and bulges (n,), optional
        Of a flat part, its y along the section's depth.
    thickness : float, mm
        Of a flat part.
    holes : tuple of Hole
    fin : Fin, optional
        What a fin is made of.
    """

    mark: str
    kind: Literal["cap", "end-plate", "fin"]
    size: str
    quantity: int
    volume: float
    surface: float | None
    solid: Solid | None = None
    outline: tuple[Floats, Floats] | None = None
    thickness: float = 0.0
    holes: tuple[Hole, ...] = ()
    fin: Fin | None = None


def make_fittings(nodes: NodeParts, joints: tuple[Joint, ...], members: MemberParts) -> tuple[Fitting, ...]:
    """Give the caps and fins of all nodes and the end plates of all members."""
    caps = {joint.cap for joint in joints if isinstance(joint, SlottedJoint) and joint.cap}
    plates, fins = _end_plates(members), count_fins(nodes, joints)
    names = iter(marks("F", len(caps) + len(plates) + len(fins)))
    count = 2 * int(nodes.classes.quantity.sum())
    turned = [_cap(next(names), cap, count) for cap in caps]
    inside = [_plate(next(names), *key, quantity) for key, quantity in plates]
    return (*turned, *inside, *(_fin(next(names), fin, quantity) for fin, quantity in fins.items()))


def count_fins(nodes: NodeParts, joints: tuple[Joint, ...]) -> dict[Fin, int]:
    """Count the fins of all nodes, in the order of the nodes and their arms: two per arm."""
    found: dict[Fin, int] = {}
    for joint, quantity in zip(joints, nodes.classes.quantity.tolist(), strict=True):
        for fin in joint.fins:
            found[fin] = found.get(fin, 0) + 2 * quantity
    return found


def name_fins(joint: Joint, arms: NodeArms, fittings: tuple[Fitting, ...]) -> dict[int, str]:
    """Give the mark of the fins by the number of their arm, counted from 1; none of details without, and of sills."""
    named = {fitting.fin: fitting.mark for fitting in fittings if fitting.fin}
    held = (np.flatnonzero(arms.family != Family.SILL) + 1).tolist()
    return dict(zip(held, (named[fin] for fin in joint.fins), strict=False))


def _end_plates(members: MemberParts) -> list[tuple[tuple[RhsSection, EndPlate], int]]:
    """Count the end plates of every section, in the order of the members."""
    found: dict[str, tuple[tuple[RhsSection, EndPlate], int]] = {}
    for shape, quantity in zip(members.shapes, members.classes.quantity.tolist(), strict=True):
        for section, plate in _plated(shape):
            _, count = found.get(section.name, (None, 0))
            found[section.name] = (section, plate), count + quantity
    return list(found.values())


def _plated(shape: MemberShape) -> list[tuple[RhsSection, EndPlate]]:
    section: AnySection = shape.section
    return [(section, plate) for plate in shape.end_plates] if isinstance(section, RhsSection) else []


def _cap(mark: str, cap: Cap, quantity: int) -> Fitting:
    solid = make_solid(cap.carve(), 1, mark)
    size = f"Ø{2 * cap.radius:g}x{cap.thickness:g}"
    return Fitting(mark, "cap", size, quantity, solid.volume, solid.surface, solid)


def _plate(mark: str, section: RhsSection, plate: EndPlate, quantity: int) -> Fitting:
    depth, width = section.depth - 2 * section.wall, section.width - 2 * section.wall
    face = section.void - plate.hole_area
    radius = section.radii[1]
    around = 2 * (depth + width) - (8 - 2 * np.pi) * radius + len(plate.bolts) * np.pi * plate.diameter
    return Fitting(
        mark=mark,
        kind="end-plate",
        size=f"{depth:g}x{width:g}x{plate.thickness:g}",
        quantity=quantity,
        volume=face * plate.thickness,
        surface=float(2 * face + around * plate.thickness),
        outline=_rounded(width / 2, depth / 2, radius),
        thickness=plate.thickness,
        holes=tuple(Hole(0.0, y, plate.diameter) for y in plate.bolts),
    )


def _fin(mark: str, fin: Fin, quantity: int) -> Fitting:
    outline = np.array(fin.corners)
    length, height = np.ptp(outline, axis=0).tolist()
    drilled = sum(hole.area for hole in fin.holes)
    return Fitting(
        mark=mark,
        kind="fin",
        size=f"{length:g}x{height:g}x{fin.thickness:g}",
        quantity=quantity,
        volume=(area(outline) - drilled) * fin.thickness,
        surface=None,
        outline=(outline, np.zeros(len(outline))),
        thickness=fin.thickness,
        holes=fin.holes,
        fin=fin,
    )


def _rounded(x: float, y: float, radius: float) -> tuple[Floats, Floats]:
    """Contour and bulges of a rectangle of half width x and half height y with rounded corners, counter-clockwise."""
    a, b = x - radius, y - radius
    points = np.array([[x, -b], [x, b], [a, y], [-a, y], [-x, b], [-x, -b], [-a, -y], [a, -y]])
    quarter = np.tan(np.pi / 8)
    if radius == 0:
        return np.array([[x, -y], [x, y], [-x, y], [-x, -y]]), np.zeros(4)
    return points, np.tile([0.0, quarter], 4)
