"""Slotted drums: the sizes that arms, plates and tools ask for (fabrication, Node solids)."""

from dataclasses import dataclass

import numpy as np

from isomould.arrays import Floats, read_only
from isomould.errors import Refused
from isomould.parts.nodes import NodeArms
from isomould.parts.settings import NodeSettings, PlateSection


@dataclass(frozen=True, eq=False)
class Drum:
    """One drum diameter for the whole design, one height per node class. Lengths in mm.

    Attributes
    ----------
    diameter, bore : float
    height : (k,) float
    slot_width : float
    slot_floor : float
        Distance ρ of the slot's floor from the axis.
    plate_end : float
        Distance s of the plates' ends from the axis.
    shoulder : float
        Distance of the plates' shoulders from the axis: drum radius and end gap.
    web : float
        Smallest web between neighbouring slots.
    """

    diameter: float
    bore: float
    height: Floats
    slot_width: float
    slot_floor: float
    plate_end: float
    shoulder: float
    web: float

    def __post_init__(self) -> None:
        read_only(self.height)

    @property
    def radius(self) -> float:
        """Half the diameter."""
        return self.diameter / 2


def size_drum(arms: tuple[NodeArms, ...], section: PlateSection, settings: NodeSettings) -> Drum:
    """Give the smallest drum that suits every node class, or the one asked for.

    Raises
    ------
    Refused
        If a given diameter or slot depth is too small, or a drum would be lower than 0.6 of the section's depth.
    """
    engagement = max(25.0, 2 * section.thickness)
    depth = settings.slot_depth or settings.end_gap + engagement
    if depth - settings.end_gap < engagement - 1e-9:
        _refuse_depth(depth, settings.end_gap + engagement)
    gaps = np.minimum(np.concatenate([each.slot_gap for each in arms]), np.pi)
    width = section.thickness + settings.clearance
    nose = width / 2 if settings.slot_end == "round" else 0.0
    floor = max(_floor_for_web(gaps, width, nose, settings.min_web), settings.bore / 2 + settings.min_core + nose)
    diameter = _diameter(2 * (floor + depth), settings)
    radius = diameter / 2
    shoulder = radius + settings.end_gap
    return Drum(
        diameter=diameter,
        bore=settings.bore,
        height=np.array([_height(each.slotted, section, shoulder) for each in arms]),
        slot_width=width,
        slot_floor=radius - depth,
        plate_end=radius - depth + settings.end_gap,
        shoulder=shoulder,
        web=_smallest_web(gaps, width, nose, radius - depth),
    )


def _half_width(gaps: Floats, width: float, nose: float) -> Floats:
    """What half a slot takes of the distance between neighbours: its corner's share, or its round nose."""
    return np.full_like(gaps, nose) if nose else width / 2 * np.cos(gaps / 2)


def _floor_for_web(gaps: Floats, width: float, nose: float, web: float) -> float:
    """Smallest slot floor ρ with `2(ρ sin(γ/2) − (w/2) cos(γ/2)) ≥ web` for all azimuth gaps γ."""
    return float(np.max((web / 2 + _half_width(gaps, width, nose)) / np.sin(gaps / 2)))


def _smallest_web(gaps: Floats, width: float, nose: float, floor: float) -> float:
    return float(np.min(2 * (floor * np.sin(gaps / 2) - _half_width(gaps, width, nose))))


def _diameter(needed: float, settings: NodeSettings) -> float:
    if settings.drum_diameter is None:
        return settings.diameter_step * float(np.ceil(round(needed / settings.diameter_step, 9)))
    if settings.drum_diameter < needed - 1e-9:
        raise Refused(
            "E-NODE-DRUM",
            "nodes.drum_diameter",
            f"a drum of {settings.drum_diameter:.3f} mm leaves no room for the slots of its arms",
            f"at least {needed:.3f} mm",
            f"Give {np.ceil(needed):g} mm or more, or leave the field out for the smallest drum that fits.",
        )
    return settings.drum_diameter


def _refuse_depth(depth: float, needed: float) -> None:
    raise Refused(
        "E-NODE-SLOT",
        "nodes.slot_depth",
        f"a slot of {depth:.3f} mm holds too little of the plate",
        f"at least {needed:.3f} mm (end gap and an engagement of 25 mm or twice the thickness)",
        f"Give {needed:g} mm or more, or leave the field out.",
    )


def _height(arms: NodeArms, section: PlateSection, shoulder: float) -> float:
    """Drum height: `H/2 = min over arms [(h/2)/cos e − (R + end gap) tan|e|]`, rounded down to 0.001 mm.

    A drum without slots, where sills meet and nothing else, is as high as a level arm would make it.
    """
    if not len(arms.elevation):
        return section.depth
    half = section.depth / 2 / np.cos(arms.elevation) - shoulder * np.tan(np.abs(arms.elevation))
    height = float(np.floor(round(2 * half.min() / 0.001, 3)) * 0.001)
    if height < 0.6 * section.depth:
        steepest = np.degrees(np.abs(arms.elevation).max())
        raise Refused(
            "E-NODE-HEIGHT",
            "nodes",
            f"a drum between arms of up to {steepest:.3f}° elevation would be {height:.3f} mm high",
            f"at least {0.6 * section.depth:.3f} mm, 0.6 of the section's depth",
            "Divide the curves more finely (flatter arms), or use a smaller drum or a deeper section.",
        )
    return round(height, 3)
