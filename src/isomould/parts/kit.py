"""Everything that is cut, marked and counted, made from one mesh."""

from dataclasses import dataclass

import numpy as np

from isomould.arrays import Floats
from isomould.errors import Attempt, Gathering, Note
from isomould.form.mesh import Mesh
from isomould.form.trim import Cut
from isomould.parts.arms import Arms, find_arms
from isomould.parts.corners import Stacks
from isomould.parts.details import size_nodes
from isomould.parts.details.joint import Joint
from isomould.parts.members import MemberParts, make_members
from isomould.parts.nodes import NodeParts, classify_nodes
from isomould.parts.panels import PanelParts, make_panels, refuse_bearing
from isomould.parts.quality import beam_mismatch, node_torsion, refuse_torsion
from isomould.parts.settings import CongruenceSettings, MemberSettings, NodeSettings, PanelSettings
from isomould.parts.supports import Base, make_bases, up_directions
from isomould.ties import first_largest


@dataclass(frozen=True)
class KitSettings:
    """The settings of all parts."""

    members: MemberSettings
    nodes: NodeSettings
    panels: PanelSettings
    tolerance: CongruenceSettings
    cuts: tuple[Cut, ...] = ()
    """Planes that trim the surface."""


@dataclass(frozen=True, eq=False)
class Kit:
    """The parts of a design.

    Attributes
    ----------
    mesh, arms
        What they were made from.
    nodes, members, panels
        Classes with marks, instances with locations.
    bases : tuple of Base or None
        Per node class: what a support stands on.
    joints
        The node classes as their detail sizes them.
    mismatch, torsion : (n,) float, mm and rad
        Of every node.
    """

    mesh: Mesh
    arms: Arms
    nodes: NodeParts
    joints: tuple[Joint, ...]
    members: MemberParts
    panels: PanelParts
    bases: tuple[Base | None, ...]
    mismatch: Floats
    torsion: Floats

    @property
    def notes(self) -> tuple[Note, ...]:
        """What should be known about the parts."""
        worst = first_largest(self.mismatch)
        text = f"beams mismatch by up to {self.mismatch[worst]:.3f} mm at a node ({self.nodes.locations[worst]})"
        return (Note("W-NODE-MISMATCH", "surface.kind", text),) if self.mismatch[worst] > 1e-6 else ()


def standing(mesh: Mesh, settings: KitSettings) -> Floats:
    """Give the directions (n, 3) in which supports stand on base plates; zeros for all nodes without."""
    return up_directions(mesh, settings.cuts if settings.nodes.base_plate else ())


def _stacks(nodes: NodeParts, joints: tuple[Joint, ...]) -> Stacks | None:
    """Say what stands proud on the nodes: caps and bolt heads, or faceted drums; plain drums never do."""
    if not any(joint.proud for joint in joints):
        return None
    top = np.array([joint.stack_height for joint in joints])[nodes.classes.of]
    return Stacks(max(joint.stack_radius for joint in joints), top)


def make_kit(mesh: Mesh, settings: KitSettings, nodes: NodeParts | None = None) -> Kit:
    """Sort nodes, members and panels into classes and size one part of each.

    `nodes` are those of the mesh if they were sorted already, together with other meshes.

    Raises
    ------
    Refused
        If a part cannot be made as asked.
    """
    with Gathering() as faults:
        return try_kit(mesh, settings, faults, nodes).kit


@dataclass(frozen=True, eq=False)
class TriedKit:
    """The parts of a design, each as far as it can be made; `seated` if panels cover enough of their seats."""

    mesh: Mesh
    arms: Arms
    nodes: NodeParts
    joints: Attempt[tuple[Joint, ...]]
    members: Attempt[MemberParts]
    panels: Attempt[PanelParts]
    seated: Attempt[None]
    bases: Attempt[tuple[Base | None, ...]]
    torsion: Attempt[Floats]
    depth: float

    @property
    def kit(self) -> Kit:
        """The parts, if all of them can be made.

        Raises
        ------
        Refused
            The first that ended a part.
        """
        _ = self.seated.value
        return Kit(
            mesh=self.mesh,
            arms=self.arms,
            nodes=self.nodes,
            joints=self.joints.value,
            members=self.members.value,
            panels=self.panels.value,
            bases=self.bases.value,
            mismatch=beam_mismatch(self.arms, self.depth),
            torsion=self.torsion.value,
        )


def try_kit(mesh: Mesh, settings: KitSettings, faults: Gathering, nodes: NodeParts | None = None) -> TriedKit:
    """Make the parts of a design as far as they can be made; `faults` gathers what ends the others."""
    arms = find_arms(mesh)
    nodes = nodes or classify_nodes(mesh, arms, settings.tolerance, standing(mesh, settings))
    torsion = faults.run(_torsion, mesh, arms, nodes.locations)
    depth = settings.members.section.depth
    joints = faults.run(size_nodes, nodes, settings.members, settings.nodes)
    members = faults.run(lambda: make_members(mesh, arms, nodes, joints.value, settings.members, settings.tolerance))
    # Panels meet of the nodes what stands proud on them: without nodes they are made as on plain drums.
    stacks = _stacks(nodes, joints.value) if joints.refused is None else None
    panels = faults.run(make_panels, mesh, depth, settings.panels, settings.tolerance, stacks)
    seated = faults.run(lambda: refuse_bearing(panels.value, mesh, settings.panels))
    bases = faults.run(lambda: make_bases(nodes, joints.value, settings.members, settings.nodes.base_plate))
    return TriedKit(mesh, arms, nodes, joints, members, panels, seated, bases, torsion, depth)


def _torsion(mesh: Mesh, arms: Arms, where: tuple[str, ...]) -> Floats:
    torsion = node_torsion(mesh, arms)
    refuse_torsion(torsion, where)
    return torsion
