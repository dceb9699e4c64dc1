"""Node details: each sizes all nodes of a design and says what it asks of the members' ends (fabrication)."""

from collections.abc import Iterable

from isomould.parts.details.faceted import size_faceted
from isomould.parts.details.joint import Joint
from isomould.parts.details.slotted import size_slotted
from isomould.parts.nodes import NodeParts
from isomould.parts.settings import FacetedSettings, MemberSettings, NodeSettings, SlottedSettings


def size_nodes(nodes: NodeParts, members: MemberSettings, settings: NodeSettings) -> tuple[Joint, ...]:
    """Size every node class of a design with the detail that the project asks for.

    Raises
    ------
    Refused
        If the detail does not suit the members' sections, or a node breaks one of its limits.
    """
    if isinstance(settings, SlottedSettings):
        return size_slotted(nodes, members, settings)
    return size_faceted(nodes, members, settings)


def share_sizes(shapes: Iterable[NodeParts], members: MemberSettings, settings: NodeSettings) -> NodeSettings:
    """Give settings that make the drums of several designs alike: they suit the nodes of all."""
    shapes = tuple(shapes)
    if isinstance(settings, FacetedSettings):
        distance = max(size_faceted(nodes, members, settings)[0].distance for nodes in shapes)
        settings = settings.model_copy(update={"facet_distance": distance})
    diameter = max(size_nodes(nodes, members, settings)[0].diameter for nodes in shapes)
    return settings.model_copy(update={"drum_diameter": diameter})
