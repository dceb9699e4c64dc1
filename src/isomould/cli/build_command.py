"""The commands `build` and `schedule`: a delivery, whole or its tables alone."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click

import isomould
from isomould.cli.console import say, warn
from isomould.cli.options import building
from isomould.progress import Tell
from isomould.showing import Progress


@click.command()
@building
def build(project: Path, out: Path | None, changes: Sequence[str], quiet: bool, **run: Any) -> None:
    """Build a project: cut sheets, schedules, solids, models, and the certificate that proves them."""
    with Progress(quiet) as progress:
        _built(isomould.build(project, out, changes, _run_of(progress, **run)))


@click.command()
@building
def schedule(project: Path, out: Path | None, changes: Sequence[str], quiet: bool, **run: Any) -> None:
    """Write the workbook and the tables of a project, without drawings and solids."""
    with Progress(quiet) as progress:
        _built(isomould.schedule(project, out, changes, _run_of(progress, **run)))


def _run_of(progress: Tell, replace: bool, **run: Any) -> isomould.Run:
    return isomould.Run(overwrite=replace, progress=progress, **run)


def _built(built: isomould.Built) -> None:
    """Say what was published, and what should be known about it."""
    passed = sum(check.status == "pass" for check in built.certificate.checks)
    say(f"built {built.folder} ({passed} checks passed)")
    for note in built.design.notes:
        warn(f"note: {note}")
