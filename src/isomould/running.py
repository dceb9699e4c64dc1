"""How verbs are run, and what comes of it: what callers know before any stage is loaded."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from isomould.progress import Step, Tell, tell_nobody

if TYPE_CHECKING:
    from pathlib import Path

    from isomould.design import Design
    from isomould.documents.figures import Figure
    from isomould.documents.overview import Fact
    from isomould.documents.table import Table
    from isomould.errors import Note
    from isomould.form.survey import Division
    from isomould.nesting.search import Effort
    from isomould.units import LengthUnit
    from isomould.verify import Certificate

Report = Callable[[str], None]
"""Told the name of every stage as it begins."""


@dataclass(frozen=True, eq=False)
class Built:
    """A delivery that was written, proved and published."""

    folder: Path
    design: Design
    tables: tuple[Table, ...]
    certificate: Certificate


@dataclass(frozen=True)
class Run:
    """How a build is run: `jobs` processes (None: one per core) change the time, never the result.

    `report` is told the name of every stage as it begins; `progress` every `Step`, such as one more drawing.
    `previous` is a former delivery of the project: unchanged classes keep its marks.
    """

    overwrite: bool = False
    effort: Effort = "normal"
    jobs: int | None = None
    report: Report = lambda stage: None
    progress: Tell = tell_nobody
    previous: Path | None = None

    def tell(self, step: Step) -> None:
        """Tell a step to both."""
        self.progress(step)
        if step.total == 0:
            self.report(step.stage)


@dataclass(frozen=True, eq=False)
class Checked:
    """A design that was computed without writing files, its key figures, and what should be known about it.

    `divisions` says of rail and generatrix how their arcs turn, which angles are nearest, and how far the polygon
    lies off the curve. `kit` proves that the shapes of a project are made of one kit of nodes: a row per class, its
    quantity in every shape, and whether all have it; None for a project of one shape. `figures` are the sizes that
    are asked for first, with the names of `check --json`.
    """

    design: Design
    facts: tuple[Fact, ...]
    divisions: tuple[Division, ...]
    notes: tuple[Note, ...]
    kit: Table | None = None
    figures: tuple[Figure, ...] = ()


@dataclass(frozen=True)
class NestFiles:
    """What `nest` reads and writes beside part list and layout.

    Attributes
    ----------
    stock
        A TOML file with a `[stock]` table, such as a project: its keys take the place of the part list's.
    changes
        Keys of that table, which take the place of both, such as `{"gap": 5, "sheets": [...]}`.
    sheets
        A folder for the sheets as DXF.
    plan
        A PDF file for the cutting plan, or of members for the saw list.
    saw_list
        A file for the saw list of members, `.csv` or `.xlsx`.
    overwrite
        Whether a folder of earlier sheets may be replaced.
    units, layer
        Of drawings and tables that do not say their unit; where drawings have their outline: else CUT, or the only
        layer.
    columns
        Headings of a table by what they mean, such as `{"id": "Label"}`; others are found by the words of the trade.
    inner_layers, ignored_layers
        Layers of drawings with holes, beside CUT_INNER and DRILL, and with closed curves that are not cut.
    join
        How far ends of drawn curves may be apart that join, mm; else 0.01 or what the file's digits lose.
    """

    stock: Path | None = None
    changes: Mapping[str, Any] = field(default_factory=dict[str, Any])
    sheets: Path | None = None
    plan: Path | None = None
    saw_list: Path | None = None
    overwrite: bool = False
    units: LengthUnit | None = None
    layer: str | None = None
    columns: Mapping[str, str] = field(default_factory=dict[str, str])
    inner_layers: tuple[str, ...] = ()
    ignored_layers: tuple[str, ...] = ()
    join: float | None = None
