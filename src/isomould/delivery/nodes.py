"""The folder `nodes/`: one solid per node class."""

import json
from pathlib import Path

from isomould.delivery.goods import Delivery
from isomould.parts.solid import Solid
from isomould.writers.disk import write_bytes
from isomould.writers.solids import write_3mf, write_stl


def write_nodes(folder: Path, delivery: Delivery) -> None:
    """Write the solids and what was measured of them."""
    marks = delivery.design.kit.nodes.marks
    for mark, solid in zip(marks, delivery.solids, strict=True):
        write_3mf(folder / f"{mark}.3mf", solid.vertices, solid.triangles, mark)
        write_stl(folder / f"{mark}.stl", solid.vertices, solid.triangles)
    records = {mark: _solid_record(solid) for mark, solid in zip(marks, delivery.solids, strict=True)}
    write_bytes(folder / "solids.json", (json.dumps(records, indent=1, allow_nan=False) + "\n").encode())


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
