"""How `check` prints what it found."""

from collections.abc import Sequence

from rich.table import Table

from isomould.api import Checked
from isomould.cli.console import console, warn
from isomould.documents import table as tables
from isomould.documents.numbers import format_number
from isomould.form.survey import Division


def print_checked(checked: Checked) -> None:
    """Print key figures, arcs and kit on the output, and notes on stderr."""
    table = Table(box=None, show_header=False)
    for item, value, unit in checked.facts:
        table.add_row(item, f"{format_number(value, 6)} {unit}".strip())
    console().print(table)
    console().print(_division_table(checked.divisions))
    if checked.kit is not None:
        console().print(_kit(checked.kit))
    for note in checked.notes:
        warn(f"note: {note}")


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
        table.add_row(part.field, "", "", "", nodes, f"{part.deviation:.3f} mm")
        for number, arc in enumerate(part.arcs, 1):
            steps = "" if arc.steps is None else f"{arc.steps:.4f}"
            near = "" if arc.nearest_deg is None else f"{arc.nearest_deg:.6f}°"
            table.add_row(f"  arc {number}", f"{arc.turning_deg:.6f}°", steps, near, "", "")
    return table
