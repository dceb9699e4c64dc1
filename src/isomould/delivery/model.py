"""The folder `model/`: arrays, meshes and the building in one file."""

import json
from pathlib import Path

import numpy as np

from isomould.delivery.goods import Delivery
from isomould.design import kit_settings
from isomould.form.mesh import Family
from isomould.measure.offsets import DoubleLayer
from isomould.parts.building import place_bases, place_parts
from isomould.parts.marks import locations
from isomould.parts.members import MemberParts
from isomould.parts.nodes import NodeParts
from isomould.parts.panels import PanelParts
from isomould.record import describe_design
from isomould.writers.disk import write_bytes
from isomould.writers.model import Instance, write_glb, write_npz, write_obj


def write_model(folder: Path, delivery: Delivery) -> None:
    """Write mesh, design record and placed solids."""
    kit = delivery.design.kit
    write_record(folder, delivery)
    groups = [f"{mark}_{where}" for mark, where in zip(_marks(kit.panels), kit.panels.locations, strict=True)]
    write_obj(folder / "mesh.obj", kit.mesh.nodes, kit.mesh.faces, kit.mesh.face_offsets, groups)
    surfaces = {mark: (shape.vertices, shape.triangles) for mark, shape in delivery.bodies.items()}
    write_glb(folder / "model.glb", surfaces, _instances(delivery))
    if delivery.design.layers is not None:
        _write_layers(folder / "double-layer.obj", delivery.design.layers)


def write_record(folder: Path, delivery: Delivery) -> None:
    """Write the mesh as arrays, and what was asked and decided."""
    record = describe_design(delivery.design, delivery.cutting.stock)
    write_npz(folder / "geometry.npz", _geometry(delivery))
    write_bytes(folder / "design.json", (json.dumps(record, indent=1, allow_nan=False) + "\n").encode())


def _write_layers(path: Path, layers: DoubleLayer) -> None:
    """Write both layers, the first one's nodes first, and the members that connect them."""
    first, second = layers.first, layers.second
    count = len(first.nodes)
    nodes = np.concatenate([first.nodes, second.nodes])
    faces = np.concatenate([first.faces, second.faces + count])
    offsets = np.concatenate([first.face_offsets, second.face_offsets[1:] + len(first.faces)])
    groups = [f"{layer}_{where}" for layer in ("L1", "L2") for where in locations("P", first.face_ij)]
    ends = np.arange(count)[:, None] + np.array([0, count])
    lines = {f"L12_{where}": pair for where, pair in zip(locations("N", first.node_ij), ends, strict=True)}
    write_obj(path, nodes, faces, offsets, groups, lines)


def _marks(parts: NodeParts | MemberParts | PanelParts) -> list[str]:
    return [parts.marks[k] for k in parts.classes.of]


def _geometry(delivery: Delivery) -> dict[str, np.ndarray]:
    kit = delivery.design.kit
    mesh = kit.mesh
    arrays: dict[str, np.ndarray] = {
        "nodes": mesh.nodes,
        "node_axes": mesh.axes,
        "node_ij": mesh.node_ij.astype(np.int32),
        "edges": mesh.edges.astype(np.int32),
        "edge_family": np.array([family.word for family in Family])[mesh.family],
        "faces": mesh.faces.astype(np.int32),
        "face_offsets": mesh.face_offsets,
        "face_ij": mesh.face_ij.astype(np.int32),
    }
    for name, parts in (("node", kit.nodes), ("edge", kit.members), ("face", kit.panels)):
        arrays |= {f"{name}_mark": np.array(_marks(parts)), f"{name}_location": np.array(parts.locations)}
    return arrays


def _instances(delivery: Delivery) -> list[Instance]:
    kit = delivery.design.kit
    standing = (*place_parts(kit, kit_settings(delivery.design.project)), place_bases(kit))
    return [
        Instance(mark, where, pose)
        for parts in standing
        for mark, where, pose in zip(parts.marks, parts.locations, parts.poses, strict=True)
    ]
