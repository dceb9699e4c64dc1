"""What keeps parts of a table apart, material, grade and thickness, and the grain that they have."""

from isomould.errors import Note
from isomould.intake.csv_list import Sheet
from isomould.intake.instance import Instance
from isomould.intake.part_rows import refuse, show
from isomould.intake.plate_sections import plate_thickness
from isomould.intake.table_words import Line
from isomould.intake.vocabulary import says


def material_cells(sheet: Sheet, line: Line) -> dict[str, str | float]:
    """Give what a row says of its material; nothing of cells that are blank."""
    words = {name: line.cells[name] for name in ("material", "grade") if line.cells.get(name)}
    if line.cells.get("thickness"):
        return {**words, "thickness": sheet.number(line, "thickness")}
    plate = plate_thickness(line.cells.get("section", ""))
    return {**words, "thickness": plate} if plate is not None else {**words}


def grain_cell(line: Line, across: str, up: str) -> dict[str, str]:
    """Give the grain of a row as lists of parts have it: along the first size, `length`, or the second, `width`.

    Parameters
    ----------
    across, up
        What the sizes along x and y are called here: length and width, or width and height.

    Raises
    ------
    Refused
        E-NEST-11 for a word that names neither.
    """
    cell = line.cells.get("grain", "")
    if not cell or says(cell, "none"):
        return _kept_straight(line)
    if says(cell, across) or says(cell, "yes"):
        return {"grain": "length"}
    if not says(cell, up):
        limit = f"{across}, {up}, none, or yes for along the {across}"
        refuse(f"{line.field}: grain", show(cell), limit)
    return {"grain": "width"}


def _kept_straight(line: Line) -> dict[str, str]:
    """A part that must not be turned lies as it is listed."""
    cell = line.cells.get("turn", "")
    if cell and not says(cell, "yes") and not says(cell, "no"):
        refuse(f"{line.field}: turn", show(cell), "yes or no")
    return {"grain": "length"} if cell and says(cell, "no") else {}


def grain_note(instance: Instance) -> tuple[Note, ...]:
    """Say along which side of the sheets parts with a grain are laid."""
    held = sum(part.quantity for part in instance.parts if part.grain)
    if not held:
        return ()
    sheets = ", ".join(f"{sheet.width:g} of {sheet.name}" for sheet in instance.stock.sheets[:4])
    text = f"{held} pieces have a grain or must not be turned: it runs along the width of the sheets, mm: {sheets}"
    return (Note("W-PART-GRAIN", instance.name, text),)
