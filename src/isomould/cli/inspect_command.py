"""The command `inspect`: what is read of a drawing, a model or a part list."""

from __future__ import annotations

from pathlib import Path
from typing import get_args

import click

import isomould
from isomould.cli.console import say, warn
from isomould.cli.options import Quantity
from isomould.units import LengthUnit


def _length(text: str) -> float:
    from isomould.intake.stock import length_of

    return length_of(text)


_UNITS = click.Choice(get_args(LengthUnit))
_LENGTH = Quantity("length", _length)


@click.command()
@click.argument("file", type=click.Path(path_type=Path))
@click.option("--layer", help="Read its one curve as a project does; without, all layers are listed.")
@click.option("--units", type=_UNITS, help="Of files that do not say their own, or say it wrong.")
@click.option("--join", type=_LENGTH, help="Join ends this near, such as 0.1mm; default 0.01 mm.")
@click.option("--json", "as_json", is_flag=True, help="Print data for programs.")
@click.option("--out", type=click.Path(path_type=Path), help="Picture (SVG) of the curves to write.")
def inspect(
    file: Path, layer: str | None, units: LengthUnit | None, join: float | None, as_json: bool, out: Path | None
) -> None:
    """Say what is read of a drawing, a model or a part list."""
    found = isomould.inspect(file, layer, units, join, out)

    from isomould.intake.inspection import json_text

    if as_json:
        say(json_text(found))
        return
    for note in found.notes:
        warn(f"note: {note}")
    for line in found.lines:
        say(line)
