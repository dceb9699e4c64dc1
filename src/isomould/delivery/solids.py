"""Solids of members and panels, where the project asks for them."""

from pathlib import Path

from isomould.delivery.goods import Delivery
from isomould.writers.solids import write_3mf, write_stl


def write_part_solids(folder: Path, delivery: Delivery) -> None:
    """Write one solid per class of the kinds of parts asked for, beside their part files."""
    kit = delivery.design.kit
    marks = {"members": kit.members.marks, "panels": kit.panels.marks}
    for kind in delivery.design.project.deliver.solids:
        for mark in marks[kind]:
            shape = delivery.bodies[mark]
            write_3mf(folder / kind / f"{mark}.3mf", shape.vertices, shape.triangles, mark)
            write_stl(folder / kind / f"{mark}.stl", shape.vertices, shape.triangles)
