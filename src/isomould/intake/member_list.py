"""Lists of members as tables or JSON: what is cut from bars."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from isomould.errors import Note
from isomould.intake.bar_grades import keep_grades_apart
from isomould.intake.csv_list import Sheet, heading_names, read_sheet
from isomould.intake.instance import NOTHING, make_stock, parse_json, read_text
from isomould.intake.member_rows import MemberList, read_members, refuse_unlike_ends
from isomould.intake.part_rows import TRAPEZOID, Row, get, mapping, refuse, refuse_unknown, show, to_material
from isomould.intake.table_rows import is_table
from isomould.intake.table_words import MEMBERS, Line, Reading
from isomould.nesting.material import Material

_STOCK = {"bars", "bar_kerf", "bar_trim", "bar_ends"}
_ANGLES = ("end_angle_start", "end_angle_end")


def lists_members(path: Path, asked: Reading | None = None, stock: Mapping[str, Any] = NOTHING) -> bool:
    """Tell a list of members: by its columns `section` and `length`, or in JSON by its key `members`.

    A table that has a width or a height too lists members where the stock has bars alone.
    """
    if path.is_dir():
        return False
    if is_table(path):
        names = heading_names(path, asked or Reading())
        flat = bool({"width", "height"} & names) and ("sheets" in stock or "bars" not in stock)
        return {"section", "length"} <= names and not flat and not {*TRAPEZOID, "points"} & names
    table = parse_json(read_text(path, "a JSON file in UTF-8"), str(path))
    return isinstance(table, dict) and "members" in table


def read_member_list(
    path: Path, stock: Mapping[str, Any], asked: Reading | None = None
) -> tuple[MemberList, tuple[Note, ...]]:
    """Read a list of members, and what should be known of it.

    Parameters
    ----------
    path
        A table, or else JSON.
    stock
        Keys of the `[stock]` table that take the place of the file's own.
    asked
        What the user says of a table.

    Raises
    ------
    Refused
        Naming file, field, what was found, the limit, and a way out.
    OutputFault
        If the file cannot be read.
    """
    if is_table(path):
        sheet = read_sheet(path, MEMBERS, asked)
        return _made(path.stem, [_row(sheet, line) for line in sheet.lines], stock, str(path)), sheet.notes
    file = str(path)
    table = mapping(parse_json(read_text(path, "a JSON file in UTF-8"), file), file)
    refuse_unknown(table, {"name", "members", *_STOCK}, file)
    rows, name = table["members"], get(table, "name", file)
    if not isinstance(rows, list) or not rows:
        refuse(f"{file}: members", show(rows), "a list with at least one member")
    own = {key: table[key] for key in table if key in _STOCK}
    named = [(row, f"{file}: members[{k}]") for k, row in enumerate(rows)]
    return _made(name if isinstance(name, str) else show(name), named, {**own, **stock}, file), ()


def _made(name: str, rows: list[Row], stock: Mapping[str, Any], file: str) -> MemberList:
    members, settings = read_members(rows, file), make_stock(stock, file, "bars")
    refuse_unlike_ends(rows, settings)
    grades = [_grade_of(row, field) for row, field in rows]
    return MemberList(name, *keep_grades_apart(list(zip(members, grades, strict=True)), settings))


def _grade_of(row: object, field: str) -> Material:
    """Give the grade of a member: steel lists have it in a column of materials, alone or before the grade."""
    said = to_material(mapping(row, field), field)
    return Material(grade=" ".join(word for word in (said.material, said.grade) if word))


def _row(sheet: Sheet, line: Line) -> Row:
    depth = {"depth": sheet.number(line, "depth")} if line.cells.get("depth") else {}
    angles = {key: sheet.angle(line, key) for key in _ANGLES}
    own = {"section": line.cells["section"], "id": line.cells["id"], "quantity": sheet.quantity(line)}
    made_of = {name: line.cells[name] for name in ("material", "grade") if line.cells.get(name)}
    return {**own, **made_of, "length": sheet.number(line, "length"), **depth, **angles}, line.field
