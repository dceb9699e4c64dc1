"""Plates in lists of steel, named as sections: `PL10*200` is 10 mm thick, and lies on no sheet of 12 mm."""

import re
from fractions import Fraction

from isomould.errors import Note
from isomould.intake.csv_list import Sheet
from isomould.intake.part_rows import refuse
from isomould.units import in_mm

_PLATE = re.compile(
    r"(?:plt?|plate|fpl|bl|blech|fla?|flt|fb|flat|tole|chapa|lamiera|piatto|plat|t ?=)[.:]?\s*"
    r"(?P<sizes>[\d.,/]+(?:\s*[x*×]\s*[\d.,/]+){0,2})\s*(?P<unit>mm|in|\")?",
    re.IGNORECASE,
)
"""A word for plates, and their thickness with other sizes before or behind it."""


def plate_thickness(section: str) -> float | None:
    """Give the thickness of a plate that is named as a section, mm; None for anything else.

    The smallest of its sizes is the thickness. Fractions are inches.

    Examples
    --------
    >>> plate_thickness("PL10*200"), plate_thickness("FL 200x12,5"), plate_thickness("PL1/2"), plate_thickness("HEA200")
    (10.0, 12.5, 12.7, None)
    """
    found = _PLATE.fullmatch(section.strip().replace("ô", "o"))
    if found is None:
        return None
    texts = [text.strip().replace(",", ".") for text in re.split("[xX*×]", found["sizes"])]
    try:
        least = min(map(Fraction, texts))
    except (ValueError, ZeroDivisionError):
        return None
    inches = found["unit"] in ("in", '"') or any("/" in text for text in texts)
    return float(in_mm(least, "in" if inches else "mm"))


def refuse_other_sections(sheet: Sheet) -> None:
    """Refuse sections that are no plates beside plates (E-NEST-11): their thickness is not known."""
    bare = [line for line in sheet.lines if not line.cells.get("thickness")]
    other = [line for line in bare if plate_thickness(line.cells.get("section", "")) is None]
    if other and len(other) < len(bare):
        way_out = "List members apart from plates, or add a column Thickness."
        found = repr(other[0].cells.get("section", ""))
        refuse(f"{other[0].field}: section", found, "plates such as PL10*200, as in other rows", way_out)


def section_note(sheet: Sheet) -> tuple[Note, ...]:
    """Say what is made of the sections of flat parts."""
    sections = [line.cells["section"] for line in sheet.lines if line.cells.get("section")]
    bare = any(not line.cells.get("thickness") for line in sheet.lines)
    if not sections:
        return ()
    if bare and plate_thickness(sections[0]) is not None:
        text = f"thickness is read from the section: {sections[0]} is {plate_thickness(sections[0]):g} mm"
        return (Note("W-PART-SECTION", sheet.file, text),)
    return (Note("W-PART-COLUMNS", sheet.file, f"not read: the section of parts, such as {sections[0]!r}"),)
