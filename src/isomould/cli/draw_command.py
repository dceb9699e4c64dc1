"""The command `draw`: a picture of the design."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click

import isomould
from isomould.cli.options import CHANGES, PROJECT
from isomould.documents.viewing import Style

_VIEW = click.Choice(["axonometry", "plan", "front", "elevation", "side", "section", "developed", "curvature"])
_STYLE = click.Choice(["classes", "building"])


@click.command()
@PROJECT
@click.option("--out", required=True, type=click.Path(path_type=Path), help="Picture to write, .svg or .png.")
@click.option("--view", type=_VIEW, default="axonometry", show_default=True)
@click.option("--style", type=_STYLE, help="Nodes by class, or the building as it will stand (default of sections).")
@click.option("--azimuth", "azimuth_deg", type=float, help="Where the eye stands, degrees from x towards y.")
@click.option("--elevation", "elevation_deg", type=float, help="How high the eye stands, degrees.")
@CHANGES
@click.option("--shape", default="main", show_default=True, help="Which of the project's shapes.")
def draw(project: Path, out: Path, changes: Sequence[str], shape: str, style: Style | None, **seen: Any) -> None:
    """Draw the design; no other files are written."""
    isomould.draw(project, out, changes=changes, shape=shape, seen=isomould.Seen(style=style or "classes", **seen))
    click.echo(f"wrote {out}")
