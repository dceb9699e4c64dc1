"""The command `draw`: a picture of the design."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

import isomould
from isomould.cli.options import CHANGES, PROJECT

if TYPE_CHECKING:
    from isomould.delivery.pictures import View

_VIEW = click.Choice(["axonometry", "plan", "elevation", "developed", "curvature"])


@click.command()
@PROJECT
@click.option("--out", required=True, type=click.Path(path_type=Path), help="Picture (SVG) to write.")
@click.option("--view", type=_VIEW, default="axonometry", show_default=True)
@CHANGES
@click.option("--shape", default="main", show_default=True, help="Which of the project's shapes.")
def draw(project: Path, out: Path, view: View, changes: Sequence[str], shape: str) -> None:
    """Draw the design; no other files are written."""
    isomould.draw(project, out, view, changes, shape)
    click.echo(f"wrote {out}")
