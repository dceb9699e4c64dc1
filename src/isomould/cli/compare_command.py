"""The command `compare`: mesh families side by side."""

from collections.abc import Sequence
from pathlib import Path

import click

import isomould
from isomould.cli.options import CHANGES, PROJECT


@click.command()
@PROJECT
@CHANGES
@click.option("--out", type=click.Path(path_type=Path), help="File to write, .csv or .xlsx.")
def compare(project: Path, changes: Sequence[str], out: Path | None) -> None:
    """Compare mesh families on the project's surface: the same rail, generatrix and counts."""
    compared = isomould.compare(project, changes, out)

    from isomould.cli.compare_printing import print_families

    print_families(compared)
