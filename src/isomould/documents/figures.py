"""The figures that `check` begins with: what an architect asks of a design, each with a name for programs."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from isomould.form.mesh import Family, NodeKind
from isomould.parts.kit import Kit
from isomould.parts.panel_sizes import PanelSizes


@dataclass(frozen=True)
class Figure:
    """A figure: `name` is the contract of `check --json`, `label` what people read, `where` names a part."""

    name: str
    label: str
    value: float
    unit: str
    where: str = ""


def panel_figures(sizes: PanelSizes) -> Iterator[Figure]:
    """Give the largest and the smallest panel by area, and the worst by aspect and by corner."""
    for word, chosen in (("largest", sizes.area.argmax()), ("smallest", sizes.area.argmin())):
        number, where = int(chosen), sizes.where(int(chosen))
        label = f"{word.capitalize()} panel"
        yield Figure(f"panel_{word}_width", f"{label}, width", sizes.width[number], "mm", where)
        yield Figure(f"panel_{word}_height", f"{label}, height", sizes.height[number], "mm", where)
        yield Figure(f"panel_{word}_area", f"{label}, area", sizes.area[number], "m²", where)
        yield Figure(f"panel_{word}_mass", f"{label}, mass", sizes.mass[number], "kg", where)
    slender, sharp = int(np.round(sizes.aspect, 6).argmax()), int(np.round(sizes.corner_deg, 6).argmin())
    yield Figure("panel_worst_aspect", "Most slender panel, 1 to", sizes.aspect[slender], "", sizes.where(slender))
    yield Figure("panel_sharpest_corner", "Sharpest corner", sizes.corner_deg[sharp], "°", sizes.where(sharp))


def edge_figures(kit: Kit) -> Iterator[Figure]:
    """Give the longest and the shortest edge of every family, on system lines, and where it is."""
    ends = kit.mesh.nodes[kit.mesh.edges]
    lengths = np.round(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1), 6)
    for family in (family for family in Family if (kit.mesh.family == family).any()):
        rows = np.flatnonzero(kit.mesh.family == family)
        for word, row in (("longest", rows[lengths[rows].argmax()]), ("shortest", rows[lengths[rows].argmin()])):
            where = f"{kit.members.marks[kit.members.classes.of[row]]} at {kit.members.locations[row]}"
            label = f"{word.capitalize()} edge, {family.word}"
            yield Figure(f"{word}_edge_{family.word}", label, float(lengths[row]), "mm", where)


def class_figures(kit: Kit) -> Iterator[Figure]:
    """Give the numbers of classes, of nodes by their kind; flat nodes are interior ones too."""
    kinds = {"interior": (NodeKind.INTERIOR, NodeKind.FLAT), "boundary": (NodeKind.BOUNDARY,)}
    kinds["support"] = (NodeKind.SUPPORT,)
    yield Figure("node_classes", "Node classes", len(kit.nodes.marks), "")
    for word, members in kinds.items():
        count = int(np.isin(kit.nodes.kind, members).sum())
        yield Figure(f"node_classes_{word}", f"Node classes, {word}", count, "")
    flat = int((kit.nodes.kind == NodeKind.FLAT).sum())
    yield Figure("node_classes_flat", "Node classes, flat ones of the interior", flat, "")
    yield Figure("member_classes", "Member classes", len(kit.members.marks), "")
    yield Figure("panel_classes", "Panel classes", len(kit.panels.marks), "")


def count_figures(kit: Kit) -> Iterator[Figure]:
    """Give the numbers of parts, and how well beams meet."""
    yield Figure("parallels", "Parallels", kit.mesh.shape[0], "")
    yield Figure("generatrices", "Generatrices", kit.mesh.shape[1], "")
    yield Figure("nodes", "Nodes", len(kit.mesh.nodes), "")
    yield Figure("members", "Members", len(kit.mesh.edges), "")
    yield Figure("panels", "Panels", len(kit.mesh.face_ij), "")
    worst = int(np.round(kit.mismatch, 9).argmax())
    yield Figure("mismatch", "Largest beam mismatch", float(kit.mismatch[worst]), "mm", kit.nodes.locations[worst])
