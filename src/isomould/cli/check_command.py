"""The command `check`: the design and its counts, without files."""

from collections.abc import Sequence
from pathlib import Path

import click

import isomould
from isomould.cli.options import CHANGES, PROJECT


@click.command()
@PROJECT
@CHANGES
def check(project: Path, changes: Sequence[str]) -> None:
    """Compute the design and print its counts; no files are written."""
    checked = isomould.check(project, changes)

    from isomould.cli.check_printing import print_checked

    print_checked(checked)
