"""The command `check`: the design and its counts, without files."""

from collections.abc import Sequence
from pathlib import Path

import click

import isomould
from isomould.cli.options import CHANGES, PROJECT

_PATIENCE = 3.0
"""Seconds that need no progress."""


@click.command()
@PROJECT
@CHANGES
@click.option("--json", "as_json", is_flag=True, help="Facts and notes for programs.")
def check(project: Path, changes: Sequence[str], as_json: bool) -> None:
    """Compute the design and print its sizes; no files are written."""
    with isomould.Progress(patience=_PATIENCE) as progress:
        checked = isomould.check(project, changes, progress)

    from isomould.cli.check_printing import print_checked, print_json

    (print_json if as_json else print_checked)(checked)
