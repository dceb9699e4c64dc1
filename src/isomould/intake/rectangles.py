"""Rectangles of part lists: which two of length, width and height are the sides, and which the thickness."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from isomould.errors import Note
from isomould.intake.csv_list import Sheet
from isomould.intake.part_rows import refuse
from isomould.intake.table_words import Line

_SIZES = ("length", "width", "height")


@dataclass(frozen=True)
class Sides:
    """The columns of the sides: the first lies along x. `boxed` where a third says the thickness."""

    first: str
    second: str
    boxed: bool = False


def sides_of(sheet: Sheet) -> Sides | None:
    """Tell which columns give the sides of rectangles; None where there are less than two.

    Raises
    ------
    Refused
        E-NEST-11: three sizes beside a thickness.
    """
    names = [name for name in _SIZES if name in sheet.style.units]
    if len(names) < 2:
        return None
    if len(names) == 3 and "thickness" in sheet.style.units:
        way_out = "Say --column height=HEADING and so on for two of them, and rename the third."
        refuse(sheet.file, "length, width, height and thickness", "two sizes beside the thickness", way_out)
    return Sides(names[0], names[1], boxed=len(names) == 3)


def box_note(sheet: Sheet, sides: Sides | None) -> tuple[Note, ...]:
    """Say that the smallest of three sizes is taken for the thickness, as exports of solids have it."""
    if sides is None or not sides.boxed:
        return ()
    text = "length, width and height: the smallest of the three is read as the thickness of the part"
    return (Note("W-PART-BOX", sheet.file, text),)


def rectangle(sheet: Sheet, line: Line, sides: Sides) -> dict[str, float]:
    """Give a rectangle as a trapezoid, and its thickness where the table has three sizes of a box, mm."""
    sizes = _sizes(sheet, line, sides)
    across, up, *rest = sizes.values()
    thickness = {"thickness": rest[0]} if rest else {}
    return {"a": across, "b": across, "h": up, "ol": 0.0, "orr": 0.0, **thickness}


def names_of(sheet: Sheet, line: Line, sides: Sides) -> tuple[str, str]:
    """Give what the sides along x and y are called."""
    first, second, *_ = _sizes(sheet, line, sides)
    return first, second


def _sizes(sheet: Sheet, line: Line, sides: Sides) -> Mapping[str, float]:
    """Give the sizes by name, those of the sides first: of three, the smallest (the last of equal ones) comes last."""
    names = _SIZES if sides.boxed else (sides.first, sides.second)
    blank = [name for name in names if not line.cells.get(name)]
    if blank:
        refuse(line.field, f"no {', no '.join(blank)}", f"{_and(names)} of every part")
    sizes = {name: sheet.number(line, name) for name in names}
    for name, size in sizes.items():
        if size <= 0:
            refuse(f"{line.field}: {name}", f"{size:g} mm", "greater than zero")
    if not sides.boxed:
        return sizes
    least = min(reversed(names), key=lambda name: sizes[name])
    return {**{name: size for name, size in sizes.items() if name != least}, least: sizes[least]}


def _and(names: Sequence[str]) -> str:
    return f"{', '.join(names[:-1])} and {names[-1]}"
