"""Part lists of any origin: a JSON file, a CSV file, or a folder of drawings becomes one value."""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NoReturn, get_args

from isomould.intake.csv_list import Sheet, read_sheet
from isomould.intake.drawn_part import PartDrawing, read_part_drawing
from isomould.intake.drawn_rows import drawn_rows, with_drawings
from isomould.intake.instance import Instance, make_stock, read_instance
from isomould.intake.material_cells import grain_cell, grain_note, material_cells
from isomould.intake.numbers import to_count
from isomould.intake.part_layers import LayerChoice
from isomould.intake.part_list import PartList
from isomould.intake.part_rows import TRAPEZOID, Row, read_parts, refuse
from isomould.intake.plate_sections import refuse_other_sections, section_note
from isomould.intake.rectangles import Sides, box_note, names_of, rectangle, sides_of
from isomould.intake.table_rows import is_table
from isomould.intake.table_words import PARTS, Line, Reading
from isomould.intake.words import listed
from isomould.nesting.settings import StockSettings
from isomould.units import LengthUnit

QUANTITIES = "parts.csv"
"""The table of a folder of drawings."""

_NAMED = re.compile(r"(?P<id>.+?)[ _-](?:x(?P<after>\d+)|(?P<before>\d+)x)", re.IGNORECASE)


@dataclass(frozen=True)
class Asked:
    """What a user says beside the part list: keys of the `[stock]` table, units, columns, and of drawings.

    `layer` is that of outlines, else CUT or the only one; `inner_layers` hold holes, `ignored_layers` what is not cut;
    `join` is how far ends may be apart that join, mm.
    """

    stock: Mapping[str, Any] = field(default_factory=dict[str, Any])
    units: LengthUnit | None = None
    layer: str | None = None
    columns: Mapping[str, str] = field(default_factory=dict[str, str])
    inner_layers: tuple[str, ...] = ()
    ignored_layers: tuple[str, ...] = ()
    join: float | None = None

    @property
    def reading(self) -> Reading:
        """What of it concerns tables."""
        return Reading(self.units, self.columns)

    @property
    def choice(self) -> LayerChoice:
        """What of it concerns drawings."""
        return LayerChoice(self.layer, self.inner_layers, self.ignored_layers, self.units, self.join)


def read_part_list(path: Path, asked: Asked | None = None) -> PartList:
    """Read a part list: a folder of drawings, a delivered folder (its panels), a table, or else JSON.

    Raises
    ------
    Refused
        Naming file, field, what was found, the limit, and a way out.
    OutputFault
        If a file cannot be read.
    """
    asked = asked or Asked()
    _refuse_units(asked)
    if path.is_dir():
        delivered = path / "panels"
        return _read_folder(delivered if (path / "tables" / "panels.csv").is_file() else path, asked)
    if is_table(path):
        return _read_table(path, asked)
    return PartList(read_instance(path, asked.stock))


def _refuse_units(asked: Asked) -> None:
    if asked.units not in (None, *get_args(LengthUnit)):
        refuse("--units", repr(asked.units), f"one of {', '.join(get_args(LengthUnit))}", "Name a unit.")


# --- tables


def _read_table(path: Path, asked: Asked) -> PartList:
    sheet = read_sheet(path, PARTS, asked.reading)
    return _made(path.stem, sheet, {line.field: file for line, file in _files(sheet, path.parent)}, asked)


def _files(sheet: Sheet, folder: Path) -> Iterator[tuple[Line, Path]]:
    """Give the rows that name a drawing, and where it lies: beside the table, or beside its folder."""
    for line in sheet.lines:
        named = [name.strip() for name in line.cells.get("files", "").split(";")]
        drawing = next((name for name in named if name.lower().endswith(".dxf")), None)
        if drawing is not None:
            places = [folder / drawing, folder.parent / drawing]
            found = next((place for place in places if place.is_file()), None)
            if found is None:
                limit = f"a drawing in {folder} or {folder.parent}"
                refuse(f"{line.field}: files", f"{drawing} is no file", limit, "Put the drawing there.")
            yield line, found


def _made(name: str, sheet: Sheet, files: Mapping[str, Path], asked: Asked) -> PartList:
    """Make the parts of a table, some of them drawn; `files` by the field of their line."""
    refuse_other_sections(sheet)
    sides, stock = sides_of(sheet), make_stock(asked.stock, sheet.file)
    held = {line.field for line in sheet.lines if line.field in files and grain_cell(line, *_DRAWN)}
    drawn = {key: _drawing(file, asked, stock, held=key in held) for key, file in files.items()}
    rows = [row for line in sheet.lines for row in _rows(sheet, line, drawn.get(line.field), sides)]
    instance = Instance(name, read_parts(rows, sheet.file), stock)
    notes = (*sheet.notes, *box_note(sheet, sides), *section_note(sheet), *grain_note(instance))
    return with_drawings(instance, {line.cells["id"]: drawn.get(line.field) for line in sheet.lines}, notes)


def _drawing(file: Path, asked: Asked, stock: StockSettings, *, held: bool = False) -> PartDrawing:
    """Read a drawing; where material has a direction, or the part is held, it stays as it is drawn."""
    free = stock.turning == "quarter" and not held and not any(sheet.grain for sheet in stock.sheets)
    return read_part_drawing(file, asked.choice, turns=free)


def _rows(sheet: Sheet, line: Line, drawing: PartDrawing | None, sides: Sides | None) -> list[Row]:
    group = {"row": line.cells["row"]} if line.cells.get("row") else {}
    shared = {**material_cells(sheet, line), **grain_cell(line, *_axes(sheet, line, drawing, sides))}
    table = {"id": line.cells["id"], "quantity": sheet.quantity(line), **group, **shared}
    if drawing is not None:
        return drawn_rows(table, drawing, line.field)
    return [({**table, **_shape(sheet, line, sides)}, line.field)]


_DRAWN = ("length", "width")
"""What the sizes along x and y of outlines are called that have no sizes."""


def _axes(sheet: Sheet, line: Line, drawing: PartDrawing | None, sides: Sides | None) -> tuple[str, str]:
    """Give what the sizes along x and y are called."""
    drawn = drawing is not None or bool(line.cells.get("points"))
    if sides is None or drawn or all(line.cells.get(key) for key in TRAPEZOID):
        return _DRAWN
    return names_of(sheet, line, sides)


def _shape(sheet: Sheet, line: Line, sides: Sides | None) -> dict[str, Any]:
    """Give the outline of a row that is not drawn: corners, a trapezoid, or a rectangle."""
    if line.cells.get("points"):
        return {"points": sheet.points(line)}
    missing = [key for key in TRAPEZOID if not line.cells.get(key)]
    if missing and sides is not None:
        return rectangle(sheet, line, sides)
    if missing and set(TRAPEZOID) <= set(line.cells):
        limit = "files, or points, or all of a, b, h, ol, orr"
        refuse(line.field, f"no {', no '.join(missing)}", limit, "Describe the part in one of these ways.")
    if missing:
        _refuse_shapeless(sheet, line)
    return {key: sheet.number(line, key) for key in TRAPEZOID}


def _refuse_shapeless(sheet: Sheet, line: Line) -> NoReturn:
    """Say what was found of a shape, and what is missing."""
    sizes = [name for name in ("length", "width", "height") if name in line.cells]
    found = f"{f'{sizes[0]} alone' if sizes else 'no size'}, in columns {', '.join(sheet.headings)}"
    limit = "two of length, width and height, or a, b, h, ol and orr, or points, or files"
    way_out = f"Say --column {'width' if 'length' in sizes else 'length'}=HEADING, or name the column so."
    refuse(sheet.file, found, limit, way_out)


# --- a folder of drawings


def _read_folder(folder: Path, asked: Asked) -> PartList:
    drawings = sorted(path for path in folder.iterdir() if path.suffix.lower() == ".dxf")
    if not drawings:
        refuse(str(folder), "no DXF file", "a drawing (DXF) per class of parts", "Give the folder that holds them.")
    table = _table_of(folder)
    return _read_listed(table, drawings, asked) if table else _read_named(folder, drawings, asked)


def _table_of(folder: Path) -> Path | None:
    """Give the table of quantities: in the folder, or that of the delivery whose part files these are."""
    places = (folder / QUANTITIES, folder.parent / "tables" / f"{folder.name}.csv")
    return next((place for place in places if place.is_file()), None)


def _read_listed(table: Path, drawings: Sequence[Path], asked: Asked) -> PartList:
    """Read the drawings that a table counts: named there, or called like the part."""
    sheet = read_sheet(table, PARTS, asked.reading)
    by_name = {path.stem: path for path in drawings}
    named = {line.field: file for line, file in _files(sheet, table.parent)}
    files = {line.field: named.get(line.field) or by_name.get(line.cells["id"]) for line in sheet.lines}
    for line in sheet.lines:
        if files[line.field] is None:
            limit = f"a drawing in {drawings[0].parent}"
            refuse(
                f"{line.field}: id",
                f"{line.cells['id']}.dxf is no file",
                limit,
                "Add the drawing, or files to the table.",
            )
    left = {path.resolve() for path in drawings} - {file.resolve() for file in files.values() if file}
    if left:
        found = f"no row for {listed(sorted(path.name for path in left))}"
        refuse(str(table), found, "every drawing of the folder", "Add the rows, or move the drawings away.")
    return _made(drawings[0].parent.name, sheet, {key: file for key, file in files.items() if file}, asked)


def _read_named(folder: Path, drawings: Sequence[Path], asked: Asked) -> PartList:
    """Read drawings whose names say how many there are: P01_x4.dxf or P01_4x.dxf."""
    names = {path: _NAMED.fullmatch(path.stem) for path in drawings}
    silent = [path.name for path, match in names.items() if match is None]
    if silent:
        way_out = f"Add {QUANTITIES} with the columns id and quantity, or name the files like P01_x4.dxf."
        refuse(str(folder), f"how many of {listed(silent)}?", "a quantity for every drawing", way_out)
    stock = make_stock(asked.stock, str(folder))
    drawn, rows = dict[str, PartDrawing | None](), list[Row]()
    for path, match in names.items():
        if match is not None:
            quantity = to_count(match["after"] or match["before"], str(path))
            drawn[match["id"]] = drawing = _drawing(path, asked, stock)
            rows += drawn_rows({"id": match["id"], "quantity": quantity}, drawing, str(path))
    return with_drawings(Instance(folder.resolve().name, read_parts(rows, str(folder)), stock), drawn, ())
