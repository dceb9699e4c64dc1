"""`schedules.xlsx` through openpyxl: formulas and their cached values side by side."""

from dataclasses import dataclass
from pathlib import Path

from openpyxl import load_workbook
from openpyxl.worksheet.formula import ArrayFormula

from isomould.verify.read.text import refusing

Value = str | int | float | bool | None


@dataclass(frozen=True)
class Cell:
    """A cell: its value as shown, and its formula or an empty text."""

    value: Value
    formula: str = ""


@dataclass(frozen=True)
class NamedTable:
    """An Excel table: its sheet, header texts, first column and first and last data row (from 1)."""

    sheet: str
    headers: tuple[str, ...]
    column: int
    first: int
    last: int


@dataclass(frozen=True)
class Workbook:
    """Cells by sheet and (row, column) from 1; named tables; defined names as 'Sheet!$A$1'."""

    sheets: dict[str, dict[tuple[int, int], Cell]]
    tables: dict[str, NamedTable]
    names: dict[str, str]


@refusing
def read_workbook(path: Path) -> Workbook:
    """Read the workbook twice: formulas, then the values that viewers show."""
    formulas, values = load_workbook(path), load_workbook(path, data_only=True)
    sheets = {sheet.title: _cells(sheet, values[sheet.title]) for sheet in formulas.worksheets}
    tables = {t.name: _table(sheet, t) for sheet in formulas.worksheets for t in sheet.tables.values()}
    names = {str(name): str(defined.value) for name, defined in formulas.defined_names.items()}
    return Workbook(sheets, tables, names)


def _cells(formulas: object, values: object) -> dict[tuple[int, int], Cell]:
    rows = zip(formulas.iter_rows(), values.iter_rows(), strict=True)  # pyright: ignore[reportAttributeAccessIssue]
    pairs = (pair for above, below in rows for pair in zip(above, below, strict=True))
    return {(f.row, f.column): _cell(f, v) for f, v in pairs if f.value is not None}


def _cell(formula: object, value: object) -> Cell:
    if formula.data_type != "f":  # pyright: ignore[reportAttributeAccessIssue]
        return Cell(value.value)  # pyright: ignore[reportAttributeAccessIssue]
    written = formula.value  # pyright: ignore[reportAttributeAccessIssue]
    text = written.text if isinstance(written, ArrayFormula) else written
    return Cell(value.value, str(text))  # pyright: ignore[reportAttributeAccessIssue]


def _table(sheet: object, table: object) -> NamedTable:
    cells = sheet[table.ref]  # pyright: ignore
    headers = tuple(str(cell.value) for cell in cells[0])
    last = cells[-1][0].row - int(table.totalsRowCount or 0)  # pyright: ignore
    return NamedTable(sheet.title, headers, cells[0][0].column, cells[0][0].row + 1, last)  # pyright: ignore
