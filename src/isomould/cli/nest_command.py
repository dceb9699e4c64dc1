"""The command `nest`: stock by options, progress, and what a signal does to it."""

import functools
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, get_args

import click

import isomould
from isomould.cli.console import INTERRUPTED, catch_signals, say, warn
from isomould.cli.options import EFFORT, Quantity
from isomould.documents.digits import with_unit
from isomould.errors import Note, Refused
from isomould.intake.columns_found import column_of
from isomould.intake.member_list import lists_members
from isomould.intake.stock import bar_of, length_of, read_stock, sheet_of
from isomould.intake.table_words import Reading
from isomould.nesting.layout import BarLayout, Layout
from isomould.nesting.search import Effort
from isomould.nesting.settings import BarEnds, Turning
from isomould.nesting.stop import Stop
from isomould.progress import Step, Tell
from isomould.units import LengthUnit

_UNITS = click.Choice(get_args(LengthUnit))


_LENGTH, _SHEET = Quantity("length", length_of), Quantity("width x height", sheet_of)
_BAR = Quantity("section=length", bar_of)
_COLUMN = Quantity("name=heading", column_of)


def _stocked(command: Callable[..., None]) -> Callable[..., None]:
    """Give a command options for the keys of the `[stock]` table, as one argument `changes`."""
    arguments = (
        click.option("--stock", type=click.Path(path_type=Path), help="TOML file with a [stock] table, or a project."),
        click.option("--sheet", type=_SHEET, multiple=True, help="Such as 6000x3210, in place of all others."),
        click.option("--gap", type=_LENGTH, help="Clear distance of parts, kerf included; mm or with a unit."),
        click.option("--trim", type=_LENGTH, help="Lost along every edge of a sheet."),
        click.option("--kerf", type=_LENGTH, help="Width of the cut."),
        click.option("--turning", type=click.Choice(get_args(Turning)), help="How parts may be turned."),
        click.option("--bar", type=_BAR, multiple=True, help="Such as 'FL200*12=6 m', in place of all others."),
        click.option("--bar-kerf", type=_LENGTH, help="Width of the saw cut."),
        click.option("--bar-trim", type=_LENGTH, help="Lost at each end of a bar."),
        click.option("--bar-ends", type=click.Choice(get_args(BarEnds)), help="How slanted ends lie."),
    )

    @functools.wraps(command)
    def stocked(**given: Any) -> None:
        said = {key: given.pop(option) for option, key in _KEYS.items()}
        command(**given, changes={key: value for key, value in said.items() if value not in (None, ())})

    return functools.reduce(lambda made, add: add(made), reversed(arguments), stocked)


_KEYS = {
    "sheet": "sheets",
    "gap": "gap",
    "trim": "trim",
    "kerf": "kerf",
    "turning": "turning",
    "bar": "bars",
    **{f"bar_{key}": f"bar_{key}" for key in ("kerf", "trim", "ends")},
}
"""Keys of the `[stock]` table by the options that set them."""

_OF_BARS = {"bar", "bar_kerf", "bar_trim", "bar_ends"}
"""Those that speak of members; the others speak of flat parts."""


@click.command()
@_stocked
@click.argument("instance", type=click.Path(path_type=Path))
@click.option("--out", required=True, type=click.Path(path_type=Path), help="Layout file (JSON) to write.")
@click.option("--effort", type=EFFORT, default="normal", show_default=True)
@click.option("--time-limit", type=click.FloatRange(min=0), help="Stop at the best layout after so many seconds.")
@click.option("--jobs", type=click.IntRange(min=1), help="Processes; they change the time, not the layout.")
@click.option("--sheets", type=click.Path(path_type=Path), help="Folder to write the sheets to, as DXF.")
@click.option("--plan", type=click.Path(path_type=Path), help="Cutting plan (PDF) to write; of members the saw list.")
@click.option("--saw-list", type=click.Path(path_type=Path), help="Saw list of members to write, .csv or .xlsx.")
@click.option("--replace", "overwrite", is_flag=True, help="Replace the sheets of an earlier run.")
@click.option("--units", type=_UNITS, help="Of drawings and tables that do not say their own.")
@click.option("--layer", help="Where drawings have their outline; else CUT, or the only layer.")
@click.option("--inner-layer", "inner_layers", multiple=True, help="Another layer of holes than CUT_INNER and DRILL.")
@click.option("--ignore-layer", "ignored_layers", multiple=True, help="A layer whose closed curves are not cut.")
@click.option("--join", type=_LENGTH, help="How far ends of drawn curves may be apart that join.")
@click.option("--column", "columns", type=_COLUMN, multiple=True, help="Such as id=Label: what a heading means.")
@click.option("--quiet", is_flag=True, help="No progress.")
def nest(
    instance: Path,
    out: Path,
    effort: Effort,
    time_limit: float | None,
    jobs: int | None,
    quiet: bool,
    **files: Any,
) -> None:
    """Nest parts of any origin on sheets, members on bars: JSON, CSV, a folder of drawings (DXF), or a delivery."""
    stop = Stop(time_limit)
    files["columns"] = dict(files["columns"])
    own = read_stock(files["stock"]) if files["stock"] else {}
    members = lists_members(instance, Reading(files["units"], files["columns"]), {**own, **files["changes"]})
    _refuse_stock_of_others(files["changes"], members)
    catch_signals(Interrupting(stop))
    if not quiet:
        warn(f"nesting {instance} (Ctrl-C keeps the best layout so far)")
    with isomould.Progress(quiet, by_itself=False) as shown:
        asked, progress = isomould.NestFiles(**files), _tell_steps("bars" if members else "sheets", shown)
        layout = isomould.nest(instance, out, effort, stop, progress, jobs, asked, _remark)
    say(f"{_worth(layout)}, status {layout.status}: {out}")
    if stop.interrupted:
        sys.exit(INTERRUPTED)


def _refuse_stock_of_others(changes: dict[str, Any], members: bool) -> None:
    """An option that changes nothing misleads: who gives `--kerf` with members means `--bar-kerf`."""
    for option, key in _KEYS.items():
        if key in changes and (option in _OF_BARS) != members:
            listed, others = ("members", "flat parts") if members else ("flat parts", "members")
            ours = [f"--{name.replace('_', '-')}" for name in _KEYS if (name in _OF_BARS) == members]
            way_out = f"Leave it out; the options of such a list are {', '.join(ours)}."
            raise Refused(
                "E-OUT-12", f"--{option.replace('_', '-')}", f"a list of {listed}", f"a list of {others}", way_out
            )


def _worth(layout: Layout | BarLayout) -> str:
    bound = f"lower bound {layout.bound} ({layout.bound_kind})"
    if isinstance(layout, BarLayout):
        return f"{len(layout.bars)} bars, {bound}"
    return f"{len(layout.sheets)} sheets, {bound}, yield {with_unit(layout.yield_percent, '%')}"


def _remark(note: Note) -> None:
    warn(f"note: {note}")


def _tell_steps(what: str, tell: Tell) -> Callable[[int, int, int, int], None]:
    """Give a progress that tells the number of sheets, or of bars, and how much of the search is done."""

    def progress(done: int, total: int, number: int, bound: int) -> None:
        above = f", at least {bound} needed, {number - bound} above that" if bound > 0 else ""
        share = done / total if total else None
        tell(Step(f"{number} {what}{above}", done=done, total=total, share=share))

    return progress


class Interrupting:
    """What a signal does to a nest: the first ends the search, one that comes a second or more later ends all."""

    def __init__(self, stop: Stop) -> None:
        self.stop, self.since = stop, 0.0

    def __call__(self, *_: Any) -> None:
        """Handle a signal."""
        # Those who start us may send a signal twice, to us and to our group.
        if self.stop.interrupted and time.monotonic() - self.since > 1:
            raise KeyboardInterrupt
        self.since = self.since if self.stop.interrupted else time.monotonic()
        self.stop.interrupt()
