"""The folder `nodes/`: one solid per node class."""

import json
from pathlib import Path

from isomould.arrays import Floats, Ints
from isomould.delivery.goods import Delivery
from isomould.delivery.machine import plates_of_bases
from isomould.documents.flat_parts import flat_drawing
from isomould.documents.node_plans import node_plan
from isomould.parts.solid import Solid
from isomould.progress import Told, count_for_nobody, counted
from isomould.writers.disk import write_bytes
from isomould.writers.dxf import write_dxf
from isomould.writers.solids import write_3mf, write_stl


def write_nodes(folder: Path, delivery: Delivery, told: Told = count_for_nobody) -> None:
    """Write the solids, counted, and what was measured of them."""
    marks = delivery.design.kit.nodes.marks
    for mark, solid in counted(list(zip(marks, delivery.solids, strict=True)), told):
        write_3mf(folder / f"{mark}.3mf", solid.vertices, solid.triangles, mark)
        write_stl(folder / f"{mark}.stl", solid.vertices, solid.triangles)
    _write_plans(folder, delivery)
    for fitting in delivery.fittings:
        if fitting.solid:
            write_3mf(folder.parent / "fittings" / f"{fitting.mark}.3mf", *_surface(fitting.solid), fitting.mark)
    records = {mark: _solid_record(solid) for mark, solid in zip(marks, delivery.solids, strict=True)}
    write_bytes(folder / "solids.json", (json.dumps(records, indent=1, allow_nan=False) + "\n").encode())


def _write_plans(folder: Path, delivery: Delivery) -> None:
    """Write the plans of drums and hubs, and of supports their base plates: those carry the mark alone."""
    kit, project = delivery.design.kit, delivery.design.project
    for mark, joint, base in zip(kit.nodes.marks, kit.joints, kit.bases, strict=True):
        drawn = node_plan(mark, joint)
        if drawn:
            write_dxf(folder / f"{mark}{'-drum' if base else ''}.dxf", drawn, project.deliver.layers)
    for part in plates_of_bases(delivery):
        write_dxf(folder.parent / f"{part.file}.dxf", flat_drawing(part), project.deliver.layers)


def _surface(solid: Solid) -> tuple[Floats, Ints]:
    return solid.vertices, solid.triangles


def _solid_record(solid: Solid) -> dict[str, float | int | str]:
    """What the maker measured, for the certificate (V20–V22)."""
    return {
        "status": solid.status,
        "genus": solid.genus,
        "components": solid.components,
        "volume_mm3": solid.volume,
        "analytic_volume_mm3": solid.analytic_volume,
        "inclusion_exclusion": solid.inclusion_exclusion,
        "commutativity": solid.commutativity,
    }
