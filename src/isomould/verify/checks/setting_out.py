"""V46: the setting out is the model, moved to the datum of the site."""

from itertools import pairwise

import numpy as np
from scipy.spatial import cKDTree

from isomould.verify.delivery import Delivery
from isomould.verify.read.dxf import Entity
from isomould.verify.read.mesh import edge_vectors
from isomould.verify.read.tables import half_unit, numbers, texts
from isomould.verify.rules import Floats, Measured, Rule, faults, worst_of

DRAWN = 2e-6
"""Coordinates of the drawing have six decimals, mm."""
_ULPS = 4


def coordinates(delivery: Delivery) -> Measured:
    """Work points, tops and bottoms of the table against the model, in the order of the locations, mm."""
    table, row = delivery.table("setting_out"), _rows(delivery)
    asked = [row[where] for where in texts(table, "location")]
    off = np.zeros(len(asked))
    for name, expected in zip(("", "top_", "bottom_"), _expected(delivery), strict=True):
        found = np.stack([numbers(table, f"{name}{axis}_mm") for axis in "xyz"], axis=1)
        off = np.maximum(off, np.abs(found - expected[asked]).max(axis=1))
    return worst_of(off, texts(table, "location"), limit=half_unit("x_mm") + _noise(delivery))


def names(delivery: Delivery) -> Measured:
    """Every node stands in the table once, with its mark."""
    table, mesh = delivery.table("setting_out"), delivery.mesh
    found = sorted(zip(texts(table, "location"), texts(table, "mark"), strict=True))
    wanted = sorted(zip(mesh.node_location.tolist(), mesh.node_mark.tolist(), strict=True))
    return faults(len(wanted), [str(pair) for pair in sorted(set(found) ^ set(wanted))] or _doubled(found))


def _doubled(found: list[tuple[str, str]]) -> list[str]:
    return [str(pair) for pair, after in pairwise(found) if pair == after]


def drawing(delivery: Delivery) -> Measured:
    """Lines of the drawing against system lines and axes of the model, and its labels against marks and tops, mm."""
    mesh, (points, tops, bottoms) = delivery.mesh, _expected(delivery)
    entities = delivery.drawings(".")["setting-out"].entities
    wanted = np.vstack((points[mesh.edges].reshape(-1, 6), np.hstack((bottoms, tops))))
    lines = np.array([np.ravel(entity.points) for entity in entities if entity.kind == "LINE"]).reshape(-1, 6)
    labels = [entity for entity in entities if entity.kind == "TEXT"]
    if len(lines) != len(wanted) or len(labels) != len(tops):
        return Measured(len(wanted), np.inf, "number of lines or labels")
    off = [*_apart(wanted, lines), *_labels_off(delivery, labels, tops)]
    where = [*mesh.edge_location, *mesh.node_location, *mesh.node_location]
    return worst_of(off, where, limit=DRAWN + _noise(delivery))


def _labels_off(delivery: Delivery, labels: list[Entity], tops: Floats) -> list[float]:
    """Distance of every node's label from the top of its axis; infinite for a label that is not there."""
    mesh = delivery.mesh
    found = {label.text: np.array(label.points[0]) for label in labels}
    wanted = [f"{mark} {where}" for mark, where in zip(mesh.node_mark, mesh.node_location, strict=True)]
    return [float(np.abs(found[text] - top).max()) if text in found else np.inf
            for text, top in zip(wanted, tops, strict=True)]  # fmt: skip


def _apart(wanted: Floats, found: Floats) -> list[float]:
    """Distance of everything wanted from the nearest that was found, each taken once or infinitely far."""
    middle = wanted.mean(axis=0)
    distance, nearest = map(np.atleast_1d, cKDTree(found - middle).query(wanted - middle))
    return distance.tolist() if len(np.unique(nearest)) == len(wanted) else [np.inf] * len(wanted)


def _rows(delivery: Delivery) -> dict[str, int]:
    return {where: k for k, where in enumerate(delivery.mesh.node_location.tolist())}


def _expected(delivery: Delivery) -> tuple[Floats, Floats, Floats]:
    """Work points, tops and bottoms (n, 3) in the datum."""
    mesh = delivery.mesh
    reach = _reach(delivery)[:, None] * mesh.node_axes
    return _placed(mesh.nodes, delivery), _placed(mesh.nodes + reach, delivery), _placed(mesh.nodes - reach, delivery)


def _reach(delivery: Delivery) -> Floats:
    """How far the members' edges reach along the axes: `h/2 / sin` of the angle between, the largest at every node."""
    mesh, half = delivery.mesh, float(delivery.design.raw["member"]["depth"]) / 2
    vectors, regular = edge_vectors(mesh), mesh.edge_family != "sill"
    found = np.zeros(len(mesh.nodes))
    for end in mesh.edges.T:
        sine = np.linalg.norm(np.cross(vectors, mesh.node_axes[end]), axis=1) / np.linalg.norm(vectors, axis=1)
        np.maximum.at(found, end[regular], half / sine[regular])
    return found


def _placed(points: Floats, delivery: Delivery) -> Floats:
    """Turn as complex numbers, then shift."""
    datum = delivery.design.raw["datum"]
    turned = (points[:, 0] + 1j * points[:, 1]) * np.exp(1j * np.radians(float(datum["rotation_deg"])))
    return np.stack([turned.real, turned.imag, points[:, 2]], axis=1) + np.array(datum["origin"], dtype=np.float64)


def _noise(delivery: Delivery) -> float:
    """What floats resolve at the largest coordinate, some times over, mm."""
    return _ULPS * float(np.spacing(np.abs(_expected(delivery)[0]).max()))


TABLE_RULES = (
    Rule("V46", "setting-out coordinates = model in the datum", half_unit("x_mm"), "mm", coordinates),
    Rule("V46b", "setting out names every node once", 0, "faults", names),
)
"""What the table says, and the model."""

RULES = (*TABLE_RULES, Rule("V46c", "setting-out drawing = model in the datum", DRAWN, "mm", drawing))
