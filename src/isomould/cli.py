"""The command line: parses, calls the verbs, prints.

Exit codes: 0 done, 1 certificate failed, 2 input refused, 3 I/O fault, 130 interrupted.
"""

import functools
import os
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import click
from rich.table import Table

import isomould
from isomould.api import View
from isomould.comparison import families_table
from isomould.console import EFFORT, INTERRUPTED, Progress, catch_signals, console, say, warn
from isomould.documents import table as tables
from isomould.documents.numbers import format_number
from isomould.errors import IsomouldError
from isomould.form.survey import Division
from isomould.nest_command import nest
from isomould.templates import describe_template, template_names
from isomould.verify import Check

_VIEW = click.Choice(["axonometry", "plan", "elevation", "developed", "curvature"])
_STATUS = {"pass": "pass", "fail": "FAIL", "not_applicable": "none"}


@click.group(context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="isomould")
def cli() -> None:
    """From two curves to everything a shop needs to build a free-form gridshell."""


cli.add_command(nest)


@cli.command()
@click.argument("name", required=False)
@click.option("--template", default="barrel-vault", show_default=True, help="The shape to start from.")
@click.option("--list", "list_", is_flag=True, help="List the templates.")
def new(name: str | None, template: str, list_: bool) -> None:
    """Start a project file NAME.toml from a template."""
    if list_:
        for known in template_names():
            say(f"{known:20}  {describe_template(known)}")
        return
    if name is None:
        raise click.UsageError("give the new project a NAME, or --list for the templates")
    for path in isomould.new(name, template):
        say(f"wrote {path}")


@cli.command()
@click.argument("project", type=click.Path(path_type=Path))
@click.option("--set", "changes", multiple=True, metavar="KEY=VALUE", help='Such as rail.curve.rise="8 m".')
def check(project: Path, changes: Sequence[str]) -> None:
    """Compute the design and print its counts; no files are written."""
    checked = isomould.check(project, changes)
    table = Table(box=None, show_header=False)
    for item, value, unit in checked.facts:
        table.add_row(item, f"{format_number(value, 6)} {unit}".strip())
    console().print(table)
    console().print(_division_table(checked.divisions))
    if checked.kit is not None:
        console().print(_kit(checked.kit))
    for note in checked.notes:
        warn(f"note: {note}")


def _building(command: Callable[..., None]) -> Callable[..., None]:
    """Give a command the arguments of everything that builds a project into a folder."""
    arguments = (
        click.argument("project", type=click.Path(path_type=Path)),
        click.option("--out", type=click.Path(path_type=Path), help="Folder to write; default below outputs/."),
        click.option("--replace", is_flag=True, help="Replace an earlier delivery in that folder."),
        click.option(
            "--previous", type=click.Path(path_type=Path), help="Former delivery: unchanged parts keep its marks."
        ),
        click.option("--set", "changes", multiple=True, metavar="KEY=VALUE", help='Such as rail.curve.rise="8 m".'),
        click.option("--effort", type=EFFORT, default="normal", show_default=True, help="How long to nest."),
        click.option("--jobs", type=click.IntRange(min=1), help="Processes; default one per core, result the same."),
        click.option("--quiet", is_flag=True, help="No progress."),
    )
    return functools.reduce(lambda made, add: add(made), reversed(arguments), command)


@cli.command()
@_building
def build(project: Path, out: Path | None, changes: Sequence[str], quiet: bool, **run: Any) -> None:
    """Build a project: cut sheets, schedules, solids, models, and the certificate that proves them."""
    with Progress(quiet) as report:
        _built(isomould.build(project, out, changes, _run_of(report, **run)))


@cli.command()
@_building
def schedule(project: Path, out: Path | None, changes: Sequence[str], quiet: bool, **run: Any) -> None:
    """Write the workbook and the tables of a project, without drawings and solids."""
    with Progress(quiet) as report:
        _built(isomould.schedule(project, out, changes, _run_of(report, **run)))


def _run_of(report: Callable[[str], None], replace: bool, **run: Any) -> isomould.Run:
    return isomould.Run(overwrite=replace, report=report, **run)


def _built(built: isomould.Built) -> None:
    """Say what was published, and what should be known about it."""
    passed = sum(check.status == "pass" for check in built.certificate.checks)
    say(f"built {built.folder} ({passed} checks passed)")
    for note in built.design.notes:
        warn(f"note: {note}")


@cli.command()
@click.argument("folder", type=click.Path(path_type=Path))
@click.option("--sheets", type=click.Path(path_type=Path), help="Of a layout file: the folder of its sheets.")
@click.option("--plan", type=click.Path(path_type=Path), help="Of a layout file: its cutting plan (PDF).")
@click.option("--saw-list", type=click.Path(path_type=Path), help="Of a layout file of bars: its saw list.")
def verify(folder: Path, **nested: Any) -> None:
    """Prove a delivered folder, or the layout file of a nest, again from its files alone."""
    certificate = isomould.verify(folder, **nested)
    passed = sum(check.status == "pass" for check in certificate.checks)
    click.echo(f"{folder}: {passed} checks passed, {len(certificate.failures)} failed")
    for check in certificate.failures:
        click.echo(f"failed: {check.id} {check.what}: {check.reason or check.where}")
    for one in certificate.checks:
        say(f"{_STATUS[one.status]}  {one.id:<5} {one.what}\n{_measured(one)}")
    if not certificate.passed:
        raise isomould.CertificateFailed(f"E-CERTIFICATE {folder}: {len(certificate.failures)} checks failed")


@cli.command()
@click.argument("project", type=click.Path(path_type=Path))
@click.option("--set", "changes", multiple=True, metavar="KEY=VALUE", help='Such as rail.curve.rise="8 m".')
@click.option("--out", type=click.Path(path_type=Path), help="File to write, .csv or .xlsx.")
def compare(project: Path, changes: Sequence[str], out: Path | None) -> None:
    """Compare mesh families on the project's surface: the same rail, generatrix and counts."""
    compared = isomould.compare(project, changes, out)
    console().print(_families(families_table(compared)))
    for family in compared:
        if family.reason:
            click.echo(f"no {family.family} mesh: {family.reason}", err=True)


@cli.command()
@click.argument("project", type=click.Path(path_type=Path))
@click.option("--out", required=True, type=click.Path(path_type=Path), help="Picture (SVG) to write.")
@click.option("--view", type=_VIEW, default="axonometry", show_default=True)
@click.option("--set", "changes", multiple=True, metavar="KEY=VALUE", help='Such as rail.curve.rise="8 m".')
@click.option("--shape", default="main", show_default=True, help="Which of the project's shapes.")
def draw(project: Path, out: Path, view: View, changes: Sequence[str], shape: str) -> None:
    """Draw the design; no other files are written."""
    isomould.draw(project, out, view, changes, shape)
    click.echo(f"wrote {out}")


def _families(families: tables.Table) -> Table:
    """One column per family, one row per measure."""
    columns = [(column.header, tables.cells(families, column)) for column in families.columns]
    table = Table("", *(str(name) for name in columns[0][1]), box=None)
    for header, cells in columns[1:-1]:
        table.add_row(header, *("–" if cell is None else _short(cell) for cell in cells))
    return table


def _kit(kit: tables.Table) -> Table:
    """One row per node class, and a line that says how many of them all shapes share."""
    shared, all_ = int(kit.frame["shared"].sum()), len(kit.frame)
    caption = f"{shared} of {all_} node classes are in every shape: one kit of nodes"
    table = Table(*(column.header for column in kit.columns), box=None, caption=caption, caption_justify="left")
    for cells in zip(*(tables.cells(kit, column) for column in kit.columns), strict=True):
        table.add_row(*({True: "yes", False: "no"}.get(c, "") if isinstance(c, bool) else str(c) for c in cells))
    return table


def _short(cell: tables.Cell) -> str:
    return format_number(cell) if isinstance(cell, int | float) else str(cell)


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


def _measured(check: Check) -> str:
    """Say below a check what it found, or why it could not; two short lines fit every terminal."""
    worst = "" if check.worst is None else f"worst {f'{check.worst:.3g} {check.unit}'.strip()}"
    limit = "" if check.limit is None or check.worst is None else f"limit {check.limit:.3g}"
    counted = f"{check.count} tested" if check.count else ""
    where = f"at {check.where}" if check.where and check.worst else ""
    said = ", ".join(part for part in (f"{worst} {where}".strip(), limit, counted, check.reason) if part)
    return f"{'':<12}{said}"


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line; every failure that users can meet is one message and an exit code."""
    catch_signals(_terminate, "SIGTERM", "SIGBREAK")
    code = _run(arguments)
    if code == INTERRUPTED:
        # Threads of a pool of workers may hold locks that the interrupt left closed: do not wait for them.
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)
    sys.exit(code)


def _terminate(*_: Any) -> None:
    raise KeyboardInterrupt


def _run(arguments: Sequence[str] | None) -> int:
    try:
        result = cli.main(arguments, standalone_mode=False)
    except click.ClickException as error:
        error.show()
        return error.exit_code
    except IsomouldError as error:
        warn(f"isomould: {error}")
        return error.exit_code
    except (KeyboardInterrupt, click.Abort):
        warn("isomould: interrupted; nothing was published")
        return INTERRUPTED
    except OSError as error:
        warn(f"isomould: E-PRINT: the output cannot be written ({error.strerror or error}).")
        return 3
    except MemoryError:
        warn("isomould: E-MEMORY: not enough memory. Divide the curves more coarsely, or lower limits.max_panels.")
        return 2
    return result if isinstance(result, int) else 0
