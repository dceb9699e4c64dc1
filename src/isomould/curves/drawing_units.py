"""The unit of a drawing or model: what its file says, what the user says, which of them counts (failure mode A3)."""

from dataclasses import dataclass
from typing import Literal

from isomould.errors import Note, Refused
from isomould.units import MM_PER_UNIT, LengthUnit


@dataclass(frozen=True)
class FoundUnit:
    """The unit that coordinates are read in."""

    name: str
    mm: float
    """Millimetres in one unit."""
    said_by: Literal["file", "asked"]


INSUNITS = {
    1: ("in", 25.4), 2: ("ft", 304.8), 3: ("miles", 1_609_344.0), 4: ("mm", 1.0), 5: ("cm", 10.0),
    6: ("m", 1000.0), 7: ("km", 1e6), 8: ("microinches", 25.4e-6), 9: ("mils", 0.0254), 10: ("yd", 914.4),
    13: ("microns", 1e-3), 14: ("dm", 100.0), 21: ("US survey feet", 1_200_000 / 3937),
}  # fmt: skip
"""$INSUNITS of a DXF file: name and mm. Its units of light, atoms and planets are no units of buildings."""

RHINO_SYSTEMS = {
    "Microns": ("microns", 1e-3), "Millimeters": ("mm", 1.0), "Centimeters": ("cm", 10.0), "Decimeters": ("dm", 100.0),
    "Meters": ("m", 1000.0), "Kilometers": ("km", 1e6), "Mils": ("mils", 0.0254), "Inches": ("in", 25.4),
    "Feet": ("ft", 304.8), "Yards": ("yd", 914.4), "Miles": ("miles", 1_609_344.0),
}  # fmt: skip


def unit_of(
    said: tuple[str, float] | None, asked: LengthUnit | None, field: str
) -> tuple[FoundUnit | None, tuple[Note, ...]]:
    """Give the unit that counts: the one asked for, else the file's, else none.

    A unit that was asked for wins over another in the file, with a note that names both.
    """
    if asked is None:
        return (None if said is None else FoundUnit(*said, said_by="file")), ()
    unit = FoundUnit(asked, MM_PER_UNIT[asked], "asked")
    if said is None or said[1] == unit.mm:
        return unit, ()
    text = f"read in {unit.name} as asked, although the file says {said[0]}"
    return unit, (Note("W-DRAWN-UNITS", f"{field}.units", text),)


def refuse_no_unit(code: str, found: str, field: str) -> Refused:
    """Give the refusal of coordinates whose unit nobody said."""
    way_out = 'Set units, such as units = "mm" in the curve\'s table, or --units mm.'
    return Refused(code, f"{field}.units", found, f"one of {', '.join(MM_PER_UNIT)}", way_out)
