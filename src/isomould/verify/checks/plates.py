"""V42f, V42g: the NC1 files of fittings and bases say what drawings, schedule and design say."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from isomould.verify.checks.machines import FORMAT, holes_off, in_plain_letters
from isomould.verify.delivery import Delivery
from isomould.verify.read.dxf import Drawing, Outline, one_outline
from isomould.verify.read.nc1 import NcFile
from isomould.verify.read.tables import number, pairs, texts
from isomould.verify.rules import Floats, Measured, NotApplicable, Rule, Unreadable, faults, worst_of


@dataclass(frozen=True, eq=False)
class _Plate:
    """A plate that must have both files, its mark, how many there are, its thickness in mm and density in kg/m³."""

    drawing: Drawing
    file: NcFile
    mark: str
    quantity: str
    thickness: float
    density: float


def _plates(delivery: Delivery) -> dict[str, _Plate]:
    """Give all flat fittings, and plate and stem of every base, by the path of their files."""
    wanted = (*_fittings(delivery), *_bases(delivery))
    found = {path: _Plate(*_files(delivery, path), *numbered) for path, numbered in wanted}
    if not found:
        raise NotApplicable("there are no flat fittings and no bases")
    return found


def _files(delivery: Delivery, path: str) -> tuple[Drawing, NcFile]:
    folder, _, name = path.partition("/")
    drawings = delivery.node_drawings if folder == "nodes" else delivery.fitting_drawings
    files = delivery.plate_nc1[folder]
    missing = [f"{path}.{ending}" for ending, there in (("dxf", drawings), ("nc1", files)) if name not in there]
    if missing:
        message = f"{missing[0]} is missing"
        raise Unreadable(message)
    return drawings[name], files[name]


_Numbered = tuple[str, str, float, float]
"""Mark, quantity, thickness and density of a plate."""


def _fittings(delivery: Delivery) -> Iterator[tuple[str, _Numbered]]:
    """Give the path of what is not turned, its thickness the last number of its size."""
    if "fittings" not in delivery.tables:
        return
    table, density = delivery.table("fittings"), float(delivery.design.raw["member"]["density_kg_m3"])
    rows = zip(*(texts(table, name) for name in ("mark", "quantity", "kind", "size")), strict=True)
    for mark, quantity, kind, size in rows:
        if kind != "cap":
            yield f"fittings/{mark}", (mark, quantity, number(size.split("x")[-1]), density)


def _bases(delivery: Delivery) -> Iterator[tuple[str, _Numbered]]:
    node, counts = delivery.design.raw["node"], pairs(delivery.table("nodes"), "mark", "quantity")
    asked, density = node.get("base_plate"), float(node["density_kg_m3"])
    if asked is None:
        return
    for mark in (mark for mark, kind in delivery.node_kinds.items() if kind == "support"):
        yield f"nodes/{mark}", (mark, counts[mark], float(asked["thickness_mm"]), density)
        yield f"nodes/{mark}-stem", (f"{mark}-STEM", counts[mark], float(asked["stem_thickness_mm"]), density)


def contours(delivery: Delivery) -> Measured:
    """Contours with their radii and holes against the part drawings, the largest difference of any number, mm."""
    plates = _plates(delivery)
    off = [_contour_off(plate.file, plate.drawing) for plate in plates.values()]
    return worst_of(off, list(plates))


def _contour_off(file: NcFile, drawing: Drawing) -> float:
    drawn = one_outline(drawing)
    if len(file.outer) != 1 or file.inner or len(file.outer[0]) != len(drawn.points):
        return np.inf
    corner = drawn.points.min(axis=0)
    wanted = np.column_stack([drawn.points - corner, _radii(drawn)])
    turns = [np.abs(np.roll(file.outer[0], k, axis=0) - wanted).max() for k in range(len(wanted))]
    return max(float(min(turns)), holes_off(file, drawing, corner))


def _radii(outline: Outline) -> Floats:
    """Radii (n,) of the arcs after the corners: the chord over twice the sine of 2 atan b; 0 where it is straight."""
    chord = np.linalg.norm(np.roll(outline.points, -1, axis=0) - outline.points, axis=1)
    sine = np.sin(2 * np.arctan(outline.bulges))
    return np.divide(chord, 2 * sine, out=np.zeros_like(chord), where=sine != 0)


def headers(delivery: Delivery) -> Measured:
    """Marks, quantities, grade, order, sizes and masses of the headers against schedule and design."""
    plates, order = _plates(delivery), delivery.design.raw["nc1"]
    problems = [f"{path}.nc1: {fault}" for path, plate in plates.items() for fault in _header_faults(plate, order)]
    known = {f"{folder}/{name}" for folder, files in delivery.plate_nc1.items() for name in files}
    problems += [f"{path}.nc1 is of no plate" for path in sorted(known - plates.keys())]
    return faults(len(plates), problems)


def _header_faults(plate: _Plate, order: dict[str, str]) -> list[str]:
    file, (length, height) = plate.file, np.ptp(one_outline(plate.drawing).points, axis=0).tolist()
    wanted = {key: in_plain_letters(order[key]) for key in ("order", "drawing", "phase", "grade")}
    wanted |= {"mark": plate.mark, "quantity": plate.quantity, "code": "B"}
    told = {**file.texts, "quantity": str(file.quantity), "code": file.code}
    found = [f"{key} {told[key]!r}, not {value!r}" for key, value in wanted.items() if told[key] != value]
    found += [f"stamped {stamp.text}" for stamp in file.stamps if stamp.text != plate.mark]
    across = height / 1e3 if order["plate_mass"] == "kg/m" else 1.0
    sizes = {"height": height, **dict.fromkeys(("width", "flange", "web"), plate.thickness)}
    sizes |= {"mass": across * plate.thickness / 1e3 * plate.density}
    off = {name: abs(file.sizes[name] - value) for name, value in sizes.items()}
    off |= {"length": abs(file.length - length), "saw length": abs(file.saw_length - length)}
    return found + [f"{name} is off by {by:.3f}" for name, by in off.items() if by > FORMAT]


RULES = (
    Rule("V42f", "contours and holes of plates' NC1 files = drawings", FORMAT, "mm", contours),
    Rule("V42g", "marks, quantities and sizes of plates' NC1 files = schedule", 0, "faults", headers),
)
