"""How `compare` prints what it measured."""

from collections.abc import Sequence

import click
from rich.table import Table

from isomould.cli.console import console
from isomould.comparison import Compared, families_table
from isomould.documents import table as tables
from isomould.documents.columns import unit
from isomould.documents.digits import shown


def print_families(compared: Sequence[Compared]) -> None:
    """Print a column per family on the output; on stderr why families are missing."""
    console().print(_families(families_table(tuple(compared))))
    for family in compared:
        if family.reason:
            click.echo(f"no {family.family} mesh: {family.reason}", err=True)


def _families(families: tables.Table) -> Table:
    """One column per family, one row per measure."""
    names, *measures, _ = families.columns
    table = Table("", *map(str, tables.cells(families, names)), box=None)
    for column in measures:
        cells = tables.cells(families, column)
        table.add_row(column.header, *(_short(cell, unit(column.name)) for cell in cells))
    return table


def _short(cell: tables.Cell, of: str) -> str:
    if cell is None:
        return "–"
    return shown(cell, of) if isinstance(cell, int | float) else str(cell)
