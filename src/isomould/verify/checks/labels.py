"""V48: every piece has one label with its mark, its location and its crate."""

from collections import Counter

from isomould.verify.delivery import Delivery
from isomould.verify.read.labels import read_label_texts
from isomould.verify.rules import Measured, NotApplicable, Rule, faults

_LINES = 4
"""Mark, location, crate and project stand on a label, in this order."""


def labels(delivery: Delivery) -> Measured:
    """Compare the labels with the marks, locations and rows of the model."""
    if not delivery.design.raw["labels"]:
        raise NotApplicable("the project asks for no labels")
    found = Counter(label for page in read_label_texts(delivery.folder / "labels.pdf") for label in _labels(page))
    wanted = Counter(_wanted(delivery))
    return faults(len(wanted), [" ".join(label) for label in sorted((found - wanted) + (wanted - found))])


def _labels(texts: tuple[str, ...]) -> list[tuple[str, ...]]:
    """Mark, location and crate without leading zeros of every label of a page."""
    rows = [texts[first : first + _LINES] for first in range(0, len(texts), _LINES)]
    return [(mark, where, f"R-{int(crate.removeprefix('R-'))}") for mark, where, crate, _ in rows]


def _wanted(delivery: Delivery) -> list[tuple[str, ...]]:
    mesh = delivery.mesh
    kinds = (
        (mesh.node_mark, mesh.node_location, mesh.node_ij[:, 0]),
        (mesh.edge_mark, mesh.edge_location, mesh.node_ij[mesh.edges[:, 0], 0]),
        (mesh.face_mark, mesh.face_location, mesh.face_ij[:, 0]),
    )
    return [(str(mark), str(where), f"R-{row}") for kind in kinds for mark, where, row in zip(*kind, strict=True)]


RULES = (Rule("V48", "labels name every piece once, with its crate", 0, "labels", labels),)
