"""How `check` prints what it found."""

import json
from collections.abc import Sequence

import click
from rich.table import Table

from isomould.api import Checked
from isomould.cli.console import console, warn
from isomould.documents import table as tables
from isomould.documents.digits import with_unit
from isomould.documents.figures import Figure
from isomould.form.survey import Division


def print_checked(checked: Checked) -> None:
    """Print sizes, arcs and kit on the output, and notes on stderr."""
    table = Table(box=None, show_header=False)
    for figure in checked.figures:
        table.add_row(figure.label, with_unit(figure.value, figure.unit), figure.where)
    console().print(table)
    console().print(_division_table(checked.divisions))
    if checked.kit is not None:
        console().print(_kit(checked.kit))
    for note in checked.notes:
        warn(f"note: {note}")


def print_json(checked: Checked) -> None:
    """Print facts and notes for programs: unrounded values, notes too are on the output."""
    facts = {figure.name: _fact(figure) for figure in checked.figures}
    notes = [{"code": note.code, "field": note.field, "text": note.text} for note in checked.notes]
    click.echo(json.dumps({"facts": facts, "notes": notes}, indent=1, ensure_ascii=False))


def _fact(figure: Figure) -> dict[str, object]:
    where = {"where": figure.where} if figure.where else {}
    value = figure.value if isinstance(figure.value, int) else float(figure.value)
    return {"value": value, "unit": figure.unit, **where}


def _kit(kit: tables.Table) -> Table:
    """One row per node class, and a line that says how many of them all shapes share."""
    shared, all_ = int(kit.frame["shared"].sum()), len(kit.frame)
    caption = f"{shared} of {all_} node classes are in every shape: one kit of nodes"
    table = Table(*(column.header for column in kit.columns), box=None, caption=caption, caption_justify="left")
    for cells in zip(*(tables.cells(kit, column) for column in kit.columns), strict=True):
        table.add_row(*({True: "yes", False: "no"}.get(c, "") if isinstance(c, bool) else str(c) for c in cells))
    return table


def _division_table(divisions: Sequence[Division]) -> Table:
    """One row per arc, after the curve's own row: its nodes by angle and the deviation of its polygon."""
    table = Table(box=None)
    for heading in ("curve", "turning", "steps", "nearest angle", "nodes", "deviation"):
        table.add_column(heading, overflow="fold")
    for part in divisions:
        nodes = "; ".join(f"{angle.nodes} of {angle.angle_deg:.6f}°" for angle in part.angles)
        table.add_row(part.field, "", "", "", nodes, with_unit(part.deviation, "mm"))
        for number, arc in enumerate(part.arcs, 1):
            steps = "" if arc.steps is None else f"{arc.steps:.4f}"
            near = "" if arc.nearest_deg is None else f"{arc.nearest_deg:.6f}°"
            table.add_row(f"  arc {number}", f"{arc.turning_deg:.6f}°", steps, near, "", "")
    return table
