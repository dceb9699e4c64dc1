"""Node details: each sizes all nodes of a design and says what it asks of the members' ends (fabrication)."""

from collections.abc import Iterable

from isomould.parts.details.faceted import size_faceted
from isomould.parts.details.finned import size_finned
from isomould.parts.details.joint import Joint
from isomould.parts.details.slotted import size_slotted
from isomould.parts.nodes import NodeParts
from isomould.parts.settings import FacetedSettings, FinnedSettings, MemberSettings, NodeSettings, SlottedSettings


def size_nodes(nodes: NodeParts, members: MemberSettings, settings: NodeSettings) -> tuple[Joint, ...]:
    """Size every node class of a design with the detail that the project asks for.

    Raises
    ------
    Refused
        If the detail does not suit the members' sections, or a node breaks one of its limits.
    """
    if isinstance(settings, SlottedSettings):
        return size_slotted(nodes, members, settings)
    if isinstance(settings, FinnedSettings):
        return size_finned(nodes, members, settings)
    return size_faceted(nodes, members, settings)


def share_sizes(shapes: Iterable[NodeParts], members: MemberSettings, settings: NodeSettings) -> NodeSettings:
    """Give settings that make the drums of several designs alike: they suit the nodes of all."""
    shapes = tuple(shapes)
    if isinstance(settings, FacetedSettings):
        distance = max(size_faceted(nodes, members, settings)[0].distance for nodes in shapes)
        settings = settings.model_copy(update={"facet_distance": distance})
    diameter = max(size_nodes(nodes, members, settings)[0].diameter for nodes in shapes)
    settings = settings.model_copy(update={"drum_diameter": diameter})
    return _share_forks(shapes, members, settings) if isinstance(settings, FinnedSettings) else settings


def _share_forks(shapes: tuple[NodeParts, ...], members: MemberSettings, settings: FinnedSettings) -> FinnedSettings:
    """Make the forks on hubs of one diameter alike: the furthest bolts, the lowest fins."""
    joints = [size_finned(nodes, members, settings)[0] for nodes in shapes]
    distance, height = max(joint.distance for joint in joints), min(joint.fin_height for joint in joints)
    return settings.model_copy(update={"bolt_distance": distance, "fin_height": height})
