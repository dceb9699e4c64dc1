"""How `compare` prints what it measured."""

from collections.abc import Sequence

import click
from rich.table import Table

from isomould.cli.console import console
from isomould.comparison import Compared, families_table
from isomould.documents import table as tables
from isomould.documents.numbers import format_number


def print_families(compared: Sequence[Compared]) -> None:
    """Print a column per family on the output; on stderr why families are missing."""
    console().print(_families(families_table(tuple(compared))))
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
