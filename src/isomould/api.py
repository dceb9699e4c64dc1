"""The verbs of the command line as functions of the same names.

Every verb imports its rooms when it is called: a program that asks for one waits for that one alone.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from isomould.documents.viewing import Seen, View
from isomould.errors import Note, Refused
from isomould.progress import Tell, tell_nobody
from isomould.running import Built, Checked, NestFiles, Run
from isomould.verify import Certificate  # loaded here, before its name is given to the verb

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from typing import TypeVar

    import pandas as pd

    from isomould.comparison import Compared
    from isomould.delivery.nested import Targets
    from isomould.documents.picture import Picture
    from isomould.intake.inspection import Inspection
    from isomould.intake.member_rows import MemberList
    from isomould.nesting.layout import BarLayout, Layout
    from isomould.nesting.search import Effort, Progress, Search
    from isomould.nesting.stop import Stop
    from isomould.study import Study
    from isomould.units import LengthUnit

    AnyLayout = TypeVar("AnyLayout", Layout, BarLayout)


def new(name: str, template: str = "barrel-vault") -> tuple[Path, ...]:
    """Start a project: copy a template to `NAME.toml`, with the drawings that it names.

    Raises
    ------
    Refused
        If the template is unknown, a file is in the way, or some system cannot hold a file of that name.
    """
    from isomould.templates import copy_template
    from isomould.writers.names import check_file_name

    path = Path(name)
    if not path.name:
        raise Refused("E-NEW", "NAME", repr(name), "a file name", "Name the project: isomould new roof.")
    file = path if path.suffix == ".toml" else path.with_name(f"{path.name}.toml")
    check_file_name(file.name)
    return copy_template(template, file)


def check(project: str | Path, changes: Sequence[str] = (), progress: Tell = tell_nobody) -> Checked:
    """Compute a design and its counts, and hold it to all that `build` asks before it searches; no files are written.

    Parameters
    ----------
    project
        A project file.
    changes
        Overrides such as `'rail.curve.rise="8 m"'`.
    progress
        Told every step, such as one more node solid.
    """
    from isomould.checking import check_file

    return check_file(Path(project), changes, progress)


def explore(project: str | Path, changes: Sequence[str] = ()) -> Study:
    """Start a study of a project: change its values and see what follows, fast enough for a slider.

    Parameters
    ----------
    project
        A project file; of several shapes the first.
    changes
        Overrides such as `'rail.curve.rise="8 m"'`.
    """
    from isomould.project.load import read_tables
    from isomould.study import make_study

    path = Path(project)
    return make_study(read_tables(path, changes), path.resolve().parent)


def build(
    project: str | Path, out: str | Path | None = None, changes: Sequence[str] = (), run: Run | None = None
) -> Built:
    """Build a project into a folder; the default is `outputs/<slug of the project's name>`.

    Parameters
    ----------
    project
        A project file.
    out
        The folder to publish.
    changes
        Overrides such as `'rail.curve.rise="8 m"'`.
    run
        Whether an earlier delivery may be replaced, effort, jobs, and who is told of the progress.

    Raises
    ------
    Refused, CertificateFailed, OutputFault
        With nothing published.
    """
    from isomould.project.load import load_project
    from isomould.writers.names import safe_name

    loaded = load_project(Path(project), changes)
    target = Path(out) if out is not None else Path("outputs") / safe_name(loaded.project.project.name)

    from isomould.pipeline import build_folder

    return build_folder(loaded, target, run or Run())


def schedule(
    project: str | Path, out: str | Path | None = None, changes: Sequence[str] = (), run: Run | None = None
) -> Built:
    """Write workbook and tables without drawings and solids; the default is `outputs/<slug>-schedules`.

    Parameters and errors are those of `build`.
    """
    from isomould.project.load import load_project
    from isomould.writers.names import safe_name

    loaded = load_project(Path(project), changes)
    slug = f"{safe_name(loaded.project.project.name)}-schedules"
    target = Path(out) if out is not None else Path("outputs") / slug

    from isomould.pipeline import schedule_folder

    return schedule_folder(loaded, target, run or Run())


def verify(
    folder: str | Path,
    jobs: int | None = None,
    sheets: Path | None = None,
    plan: Path | None = None,
    saw_list: Path | None = None,
) -> Certificate:
    """Prove a delivered folder again, or what `nest` wrote, from the files alone.

    Parameters
    ----------
    folder
        A delivered folder, or a layout file.
    jobs
        Processes, None for one per core.
    sheets, plan, saw_list
        Of a layout file: the folder of its sheets, its cutting plan, its saw list.
    """
    from isomould.verify.folder import verify_folder
    from isomould.verify.nested import verify_nest
    from isomould.workers import workers

    path = Path(folder)
    if path.is_dir() and (sheets or plan or saw_list):
        way_out = "Give the layout file instead of the folder."
        raise Refused(
            "E-VERIFY", "--sheets, --plan, --saw-list", f"beside the folder {path}", "a layout file of nest", way_out
        )
    with workers(jobs) as spread:
        if path.is_file():
            return verify_nest(path, sheets, plan, saw_list, spread)
        return verify_folder(path, spread=spread)


def nest(
    instance: str | Path,
    out: str | Path,
    effort: Effort = "normal",
    stop: Stop | None = None,
    progress: Progress | None = None,
    jobs: int | None = None,
    files: NestFiles | None = None,
    remark: Callable[[Note], None] | None = None,
) -> Layout | BarLayout:
    """Nest a part list of any origin and write the layout as JSON, and sheets and cutting plan where asked for.

    A list of members is nested on bars: its layout, and the saw list where asked for.

    Parameters
    ----------
    instance
        A list of parts or of members (a table or JSON), a folder of drawings, or a delivered folder, whose panels are
        nested.
    out
        The layout file. It and the others are proved before they are published, each whole or not at all.
    effort
        Iterations of the search.
    stop
        A time limit, or a way to interrupt: the best layout so far is written and marked.
    progress
        Told iterations done, iterations in all, sheets (or bars) so far and their lower bound.
    jobs
        Processes, None for one per core: they change the time, never the result.
    files
        Stock, sheets and plan.
    remark
        Told what of the part list is not read or not as drawn.

    Raises
    ------
    Refused
        Naming file and field, if part list, stock or targets are not as they should be; nothing is written.
    CertificateFailed
        If what was written does not show the layout; nothing is published.
    """
    from isomould.delivery.nested import Targets, check_targets, publish_nest, refuse_overwriting
    from isomould.intake.member_list import lists_members, read_member_list
    from isomould.intake.read import Asked, read_part_list
    from isomould.intake.stock import read_stock
    from isomould.nesting.grouped import nest_materials
    from isomould.nesting.search import Search
    from isomould.nesting.stop import Stop
    from isomould.workers import workers

    stop, files = stop or Stop(), files or NestFiles()
    targets = Targets(Path(out), files.sheets, files.plan, files.saw_list, files.overwrite)
    stock = {**(read_stock(files.stock) if files.stock else {}), **files.changes}
    layers = (files.inner_layers, files.ignored_layers)
    asked = Asked(stock, files.units, files.layer, files.columns, *layers, files.join)
    members = lists_members(Path(instance), asked.reading, stock)
    check_targets(targets, "members" if members else "parts")
    refuse_overwriting(targets, [Path(instance), *([files.stock] if files.stock else [])])
    search = Search(effort, progress, stop, jobs)
    if members:
        listed = read_member_list(Path(instance), stock, asked.reading)
        return _nest_members(listed, (search, stop), targets, remark or _ignore)
    given = read_part_list(Path(instance), asked)
    for note in given.notes:
        (remark or _ignore)(note)
    found = nest_materials(given.instance.parts, given.instance.stock, search)
    for note in found.notes:
        (remark or _ignore)(note)
    layout, given = _marked(found.layout, stop), replace(given, instance=replace(given.instance, stock=found.stock))
    with workers(jobs) as spread:
        publish_nest(targets, layout, given, spread)
    return layout


def _nest_members(
    listed: tuple[MemberList, tuple[Note, ...]],
    run: tuple[Search, Stop],
    targets: Targets,
    remark: Callable[[Note], None],
) -> BarLayout:
    from isomould.delivery.nested import publish_bars
    from isomould.nesting.bars import nest_bars

    given, notes = listed
    for note in notes:
        remark(note)
    search, stop = run
    layout = _marked(nest_bars(given.members, given.stock, search), stop)
    publish_bars(targets, layout, given)
    return layout


def _marked(layout: AnyLayout, stop: Stop) -> AnyLayout:
    """Say of a layout that its search was interrupted; one that had ended before lost nothing and keeps its status."""
    return replace(layout, status="interrupted") if stop.interrupted and not layout.reproducible else layout


def _ignore(_: Note) -> None:
    """Tell nobody."""


def inspect(
    file: str | Path,
    layer: str | None = None,
    units: LengthUnit | None = None,
    join: float | None = None,
    out: str | Path | None = None,
) -> Inspection:
    """Say what is read of a drawing (.dxf), a Rhino model (.3dm), a part list or a folder of part drawings.

    Parameters
    ----------
    file
        The file; nothing of it is changed.
    layer
        The layer whose one curve is read as a project reads it; None lists the curves of all layers. Of a folder of
        part drawings the layer of outlines, else CUT or the only one.
    units
        Of coordinates and numbers; None takes what the file says.
    join
        Ends of curves this near are joined, mm; None for 0.01 mm, or what the file's printing loses.
    out
        A picture of the curves to write, `.svg`; it is written whole or not at all.

    Raises
    ------
    Refused
        Naming file, field or entity, what was found, the limit and a way out.
    OutputFault
        If the file cannot be read, or the picture not be written.
    """
    from isomould.intake.inspect_file import inspect_file

    return inspect_file(Path(file), layer, units, join, None if out is None else Path(out))


def compare(project: str | Path, changes: Sequence[str] = (), out: str | Path | None = None) -> tuple[Compared, ...]:
    """Build a design as every mesh family and measure them alike (paper Tables 1 and 5).

    Parameters
    ----------
    project
        A project file.
    changes
        Overrides such as `'rail.curve.rise="8 m"'`.
    out
        A file to write, `.csv` or `.xlsx`; it is written whole or not at all.
    """
    from isomould.project.load import load_project

    loaded = load_project(Path(project), changes)

    from isomould.comparison import compare_families
    from isomould.design import make_design
    from isomould.families_file import write_families

    compared = compare_families(make_design(loaded.project, loaded.folder))
    if out is not None:
        write_families(Path(out), compared, loaded)
    return compared


def draw(
    project: str | Path,
    out: str | Path,
    view: View = "axonometry",
    changes: Sequence[str] = (),
    shape: str = "main",
    seen: Seen | None = None,
) -> Picture:
    """Draw a design as SVG or PNG.

    Parameters
    ----------
    project
        A project file.
    out
        The picture file, `.svg` or `.png`; it is written whole or not at all.
    view
        "axonometry", "plan", "front" (along +y), "side" (along -x), "section" (the front half way in), "developed"
        (strips between generatrices) or "curvature" (of the rail, with its points of tangency).
    changes
        Overrides such as `'rail.curve.rise="8 m"'`.
    shape
        Which of the project's shapes, by the name of its folder.
    seen
        View, style and angles together, in the place of `view`.
    """
    if Path(out).suffix.lower() not in (".svg", ".png"):
        limit = "a file that ends in .svg or .png"
        raise Refused("E-DRAW-FILE", "--out", str(out), limit, "Write --out picture.svg.")
    from isomould.project.load import load_project

    loaded = load_project(Path(project), changes)

    from isomould.delivery.pictures import design_picture
    from isomould.family import make_designs
    from isomould.writers.picture_file import write_picture

    designs = make_designs(loaded)
    if shape not in designs:
        limit = f"one of {', '.join(designs)}"
        raise Refused("E-DRAW-SHAPE", "--shape", repr(shape), limit, "Name a shape of the project.")
    picture = design_picture(designs[shape], seen or Seen(view))
    write_picture(Path(out), picture)
    return picture


def frames(built: Built) -> dict[str, pd.DataFrame]:
    """Give the schedules of a build as DataFrames by table name, with the columns of the CSV files."""
    return {table.name: table.frame for table in built.tables}
