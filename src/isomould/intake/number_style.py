"""How the numbers of a table are written: their signs, and the unit of every column of lengths."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from isomould.errors import Note
from isomould.intake.columns_found import Found
from isomould.intake.numbers import Signs, find_signs, unit_in
from isomould.intake.part_rows import TRAPEZOID, refuse
from isomould.intake.table_rows import Row
from isomould.intake.table_words import Line, Reading
from isomould.intake.units_said import unit_of_titles
from isomould.units import MM_PER_UNIT, UNIT_WORDS, LengthUnit

_LENGTHS = (*TRAPEZOID, "length", "width", "height", "thickness", "depth")
_OURS = {*TRAPEZOID, "points"}
"""Columns of our own format, whose unit is known to be mm."""

_OTHER_UNITS = {"kg", "t", "g", "lb", "lbs", "pcs", "pc", "stk", "m2", "m²", "m3", "m³", "-", "°", "deg", "no", "nr"}


@dataclass(frozen=True)
class NumberStyle:
    """Signs, units by column, and what was assumed of them."""

    signs: Signs
    units: Mapping[str, LengthUnit]
    notes: tuple[Note, ...]


def unit_row(found: Found) -> tuple[dict[str, LengthUnit], tuple[Row, ...]]:
    """Take a row of units, nothing but mm, kg and the like, from below the heading."""
    if not found.rows:
        return {}, found.rows
    bare = [cell.strip("()[] .").casefold() for cell in found.rows[0][1]]
    wordy = all(cell in UNIT_WORDS or cell in _OTHER_UNITS for cell in bare if cell)
    if not wordy or not any(cell in UNIT_WORDS for cell in bare):
        return {}, found.rows
    named = {meaning: bare[at] for meaning, at in found.columns.items() if at < len(bare)}
    return {meaning: UNIT_WORDS[cell] for meaning, cell in named.items() if cell in UNIT_WORDS}, found.rows[1:]


def find_style(
    found: Found, lines: Sequence[Line], units: Mapping[str, LengthUnit], asked: Reading, file: str
) -> NumberStyle:
    """Find out how a table writes its numbers, from all of them together.

    Parameters
    ----------
    units
        From a row of units below the heading.

    Raises
    ------
    Refused
        E-NEST-11: signs or units that the table does not settle.
    """
    columns = [name for name in (*_LENGTHS, "points") if name in found.columns]
    said: dict[str, LengthUnit] = {**_heading_units(found, columns), **units}
    smallest = sorted(_all_units(columns, said, asked.units or "mm").values(), key=_mm)[0] if columns else "mm"
    signs = find_signs(_numbers(lines), _other_numbers(found), found.separator, smallest, file)
    cells = [(line, name) for line in lines for name in columns if name != "points" and line.cells[name]]
    found_units: list[LengthUnit | None] = [unit_in(line.cells[name], signs) for line, name in cells]
    own: set[LengthUnit] = {unit for unit in found_units if unit}
    shared = next(iter(own)) if len(own) == 1 else None
    titled = unit_of_titles(found.before)
    fallback: LengthUnit = asked.units or shared or titled or "mm"
    bare = [(line, name) for line, name in cells if name not in said and not unit_in(line.cells[name], signs)]
    if not asked.units:
        _refuse_bare(bare, own, titled)
    foreign = bool(bare) and not asked.units and bool({name for _, name in bare} - _OURS)
    notes = (_note(file, shared, titled),) if foreign else ()
    return NumberStyle(signs, _all_units(columns, said, fallback), notes)


def _all_units(columns: Sequence[str], said: Mapping[str, LengthUnit], default: LengthUnit) -> dict[str, LengthUnit]:
    units = dict[str, LengthUnit]()
    for name in columns:
        units[name] = said.get(name, default)
    return units


def _mm(unit: LengthUnit) -> float:
    return MM_PER_UNIT[unit]


def _heading_units(found: Found, columns: Sequence[str]) -> dict[str, LengthUnit]:
    units: list[tuple[str, LengthUnit | None]] = [(name, found.headings[found.columns[name]].unit) for name in columns]
    return {name: unit for name, unit in units if unit is not None}


def _numbers(lines: Sequence[Line]) -> list[str]:
    """Give every cell that is read as a number."""
    names = (*_LENGTHS, "quantity", "end_angle_start", "end_angle_end")
    cells = [line.cells.get(name, "") for line in lines for name in names]
    return [*cells, *_blank_pairs(lines)]


def _blank_pairs(lines: Sequence[Line]) -> list[str]:
    """Give the numbers of corners that are written with blanks between."""
    cells = [cell for line in lines for cell in line.cells.get("points", "").split(";")]
    return [number for cell in cells if len(cell.split()) == 2 and ", " not in cell for number in cell.split()]


def _other_numbers(found: Found) -> list[str]:
    """Give the cells of columns that are not read, where they are plain numbers: they show how numbers are written."""
    unread = [at for at in range(len(found.headings)) if at not in found.columns.values()]
    cells = [cells[at] for _, cells in found.rows for at in unread if at < len(cells)]
    return [cell for cell in cells if cell and not cell.strip("0123456789.,")]


def _refuse_bare(bare: Iterable[tuple[Line, str]], own: set[LengthUnit], titled: LengthUnit | None) -> None:
    """Refuse numbers without a unit beside several units, and fractions without any: nobody writes them of mm."""
    for line, name in bare:
        field, cell = f"{line.field}: {name}", line.cells[name]
        if len(own) > 1:
            found = f"{cell!r} without a unit, beside cells in {' and '.join(sorted(own))}"
            refuse(field, found, "a unit in every cell or heading", "Say --units for cells without one.")
        if "/" in cell and "in" not in (*own, titled):
            way_out = "Say --units in, or write the unit into the heading."
            refuse(field, f"{cell!r}, a fraction without a unit", "a unit", way_out)


def _note(file: str, shared: LengthUnit | None, titled: LengthUnit | None) -> Note:
    if shared:
        return Note("W-PART-UNITS", file, f"lengths without a unit are read in {shared}, as the others say")
    if titled:
        return Note("W-PART-UNITS", file, f"lengths are read in {titled}, as a title before the heading says")
    return Note("W-PART-UNITS", file, "lengths are read in mm: neither the list nor --units names a unit")
