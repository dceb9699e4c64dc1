"""V27: what a shop needs on its drawings beside outlines: orientation marks, plans of nodes, solids of flat parts."""

import numpy as np

from isomould.verify.checks.solids import leaks, member_volume, volume
from isomould.verify.delivery import Delivery
from isomould.verify.read.dxf import Drawing, Outline, net_area, one_outline, outlines_on
from isomould.verify.read.solid import read_3mf
from isomould.verify.read.tables import numbers, pairs, texts
from isomould.verify.rules import Floats, Measured, NotApplicable, Rule, faults, worst_of

ROUNDING = 0.003
SHORT = 40.0
"""Sides shorter than this, mm, may have no room for an arrow."""
CHORD = 0.0021
"""Facets of round surfaces stay within 0.002 mm of them; plans have true arcs, mm."""


def orientation(delivery: Delivery) -> Measured:
    """Distance of the arrow's shaft from the middle normal of side a, which its tip must be nearer to."""
    if not delivery.design.raw["panel"].get("orientation_mark", False):
        raise NotApplicable("the project asks for no orientation marks")
    off = {mark: _arrow_off(drawing) for mark, drawing in delivery.panels.items()}
    return worst_of(list(off.values()), list(off))


def _arrow_off(drawing: Drawing) -> float:
    points = one_outline(drawing).points
    along, middle = points[1] - points[0], (points[0] + points[1]) / 2
    length = float(np.linalg.norm(along))
    shafts = [o.points - middle for o in outlines_on(drawing, "ENGRAVE") if len(o.points) == 2]
    off = [_shaft_off(shaft, along / length) for shaft in shafts]
    return min(off, default=np.inf) if length >= SHORT or off else 0.0


def _shaft_off(shaft: Floats, along: Floats) -> float:
    """How far a stroke (2, 2) is off the normal through the origin; infinite if it does not point to the side."""
    height = shaft @ np.array([-along[1], along[0]])
    return float(abs(shaft @ along).max()) if height[0] > height[1] > 0 else np.inf


def node_plans(delivery: Delivery) -> Measured:
    """Distance of the slots' floors from the arms' directions, and volume of the solid against plan × height."""
    plans, table = delivery.node_drawings, delivery.table("nodes")
    if delivery.design.raw["node"]["detail"] != "slotted" or delivery.design.raw["node"].get("cap"):
        raise NotApplicable("nodes are no plain slotted drums: a plan does not describe facets or grooves")
    height = dict(zip(texts(table, "mark"), numbers(table, "drum_height_mm").tolist(), strict=True))
    off, names = list[float](), list[str]()
    for row, mark in enumerate(texts(table, "mark")):
        plan = plans[f"{mark}-drum" if f"{mark}-drum" in plans else mark]
        off += [_slots_off(plan, delivery, row), _volume_off(plan, volume(delivery.solids[mark]), height[mark])]
        names += [mark, f"{mark} volume"]
    return worst_of(off, names)


def _slots_off(plan: Drawing, delivery: Delivery, row: int) -> float:
    """Largest distance of the middle of a slot's floor from where its arm wants it, both in order; mm."""
    table, node = delivery.table("nodes"), delivery.design.raw["node"]
    families = [texts(table, f"family_{k}")[row] for k in range(1, 1 + int(numbers(table, "valence")[row]))]
    azimuth = [numbers(table, f"azimuth_{k}_deg", blank=True)[row] for k in range(1, len(families) + 1)]
    angle = np.radians([a for a, family in zip(azimuth, families, strict=True) if family != "sill"])
    wanted = float(node["slot_floor_mm"]) * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    floors = _floors(one_outline(plan), float(node["drum_diameter_mm"]) / 2)
    if floors.shape != wanted.shape:
        return np.inf
    return float(np.linalg.norm(floors - wanted, axis=1).max(initial=0.0))


def _floors(outline: Outline, radius: float) -> Floats:
    """Middles (s, 2) of the sides with both ends inside the rim."""
    inside = np.linalg.norm(outline.points, axis=1) < radius - 1
    both = inside & np.roll(inside, -1)
    return ((outline.points + np.roll(outline.points, -1, axis=0)) / 2)[both]


def _volume_off(plan: Drawing, solid: float, height: float) -> float:
    """Difference of the volumes as a distance of the round surfaces, mm."""
    arcs = [o for o in plan.outlines if o.layer in {"CUT", "CUT_INNER"}]
    around = sum(float(_arc_lengths(outline).sum()) for outline in arcs)
    return max(0.0, abs(net_area(plan) - solid / height) / around - CHORD)


def _arc_lengths(outline: Outline) -> Floats:
    chord = np.linalg.norm(np.roll(outline.points, -1, axis=0) - outline.points, axis=1)
    return np.where(outline.bulges == 0, 0.0, chord * (1 + outline.bulges**2))


def part_solids(delivery: Delivery) -> Measured:
    """Solids of members and panels: watertight, and as large as their outlines times their thickness."""
    files = {kind: delivery.files(kind, "3mf") for kind in delivery.design.raw["solids"]}
    if not files:
        raise NotApplicable("the project asks for no solids of members and panels")
    problems: list[str] = []
    for kind, paths in files.items():
        drawings = delivery.drawings(kind)
        for path in paths:
            solid, drawing = read_3mf(path), drawings[path.stem]
            problems += [f"{path.stem}: {fault}" for fault in leaks(solid)]
            wanted, slack = _wanted(delivery, kind, drawing)
            if abs(volume(solid) - wanted) > 1e-9 * wanted + slack:
                problems.append(f"{path.stem}: {volume(solid):.3f} mm³, its outline gives {wanted:.3f}")
        if {path.stem for path in paths} != drawings.keys():
            problems.append(f"{kind}: not one solid per class")
    return faults(sum(map(len, files.values())), problems)


def _wanted(delivery: Delivery, kind: str, drawing: Drawing) -> tuple[float, float]:
    """Volume of a part from its outline, and what chords of round holes and corners leave, mm³."""
    design = delivery.design.raw
    if kind == "panels":
        thickness = float(design["panel"]["thickness_mm"])
        return net_area(drawing) * thickness, _hole_slack(drawing) * thickness
    section = design["member"]["sections"][pairs(delivery.table("members"), "mark", "section")[drawing.name]]
    wanted = member_volume(delivery, drawing.name)
    return wanted, _hole_slack(drawing) * float(section["thickness"]) if section["kind"] == "plate" else 2e-3 * wanted


def _hole_slack(drawing: Drawing) -> float:
    """Area that the chords of round holes leave, mm²."""
    circles = sum(2 * np.pi * entity.radius for entity in drawing.entities if entity.layer == "DRILL")
    inner = sum(float(_arc_lengths(outline).sum()) for outline in outlines_on(drawing, "CUT_INNER"))
    return CHORD * (float(circles) + inner)


RULES = (
    Rule("V27", "panels' orientation marks point to side a", ROUNDING, "mm", orientation),
    Rule("V27b", "node plans have their slots at the arms and give the solids' volumes", ROUNDING, "mm", node_plans),
    Rule("V27c", "solids of members and panels are their outlines", 0, "faults", part_solids),
)
