"""The command `compare`: mesh families side by side."""

from collections.abc import Sequence
from pathlib import Path

import click
from rich.table import Table

import isomould
from isomould.cli.console import console
from isomould.cli.options import CHANGES, PROJECT
from isomould.comparison import families_table
from isomould.documents import table as tables
from isomould.documents.numbers import format_number


@click.command()
@PROJECT
@CHANGES
@click.option("--out", type=click.Path(path_type=Path), help="File to write, .csv or .xlsx.")
def compare(project: Path, changes: Sequence[str], out: Path | None) -> None:
    """Compare mesh families on the project's surface: the same rail, generatrix and counts."""
    compared = isomould.compare(project, changes, out)
    console().print(_families(families_table(compared)))
    for family in compared:
        if family.reason:
            click.echo(f"no {family.family} mesh: {family.reason}", err=True)


def _families(families: tables.Table) -> Table:
    """One column per family, one row per measure."""
    columns = [(column.header, tables.cells(families, column)) for column in families.columns]
    table = Table("", *(str(name) for name in columns[0][1]), box=None)
    for header, cells in columns[1:-1]:
        table.add_row(header, *("–" if cell is None else _short(cell) for cell in cells))
    return table


def _short(cell: tables.Cell) -> str:
    return format_number(cell) if isinstance(cell, int | float) else str(cell)
