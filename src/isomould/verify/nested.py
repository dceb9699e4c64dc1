"""What `isomould nest` wrote, proved from its files: a layout, its sheets, its cutting plan."""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from isomould.verify.certificate import Certificate
from isomould.verify.checks import nested, nested_bars, nesting, scoring, sheet_marks, sheet_materials
from isomould.verify.checks.nesting import LENGTH
from isomould.verify.checks.saw_list import paper_faults
from isomould.verify.delivery import Delivery
from isomould.verify.read.dxf import Drawing, Entity, Outline, read_dxf
from isomould.verify.read.layout import Layout, read_layout
from isomould.verify.read.pdf import Book, read_pdf
from isomould.verify.read.text import Json, read_json
from isomould.verify.rules import Measured, NotApplicable, Rule, judge, order
from isomould.workers import Spread, one_by_one

_SHARED = {"V31b", "V32", "V33", "V33b", "V35b", "V35c"}
"""Checks of nests in builds that hold here as they are."""

RULES = tuple(
    sorted(
        (
            *nested.RULES,
            *sheet_materials.RULES,
            *sheet_marks.RULES,
            *scoring.RULES,
            *(rule for rule in nesting.RULES if rule.id in _SHARED),
        ),
        key=order,
    )
)
"""Every check of a nest, in the order of the certificate."""


@dataclass(frozen=True)
class Nested(Delivery):
    """The files of a nest instead of a delivered folder: `folder` is the layout, what was not written is None."""

    sheet_folder: Path | None = None
    plan_file: Path | None = None

    @cached_property
    def layout(self) -> Layout:
        """The layout file."""
        return read_layout(self.folder)

    @property
    def nesting(self) -> Json:
        """What the layout says that was asked for."""
        return self.layout.raw["nesting"]

    @property
    def flippable(self) -> bool:
        """Whether parts may be turned over."""
        return bool(self.nesting["turn_over"])

    @cached_property
    def panels(self) -> dict[str, Drawing]:
        """The parts of the list, as drawings."""
        return {str(part["id"]): _part(part) for part in self.layout.raw["parts"]}

    @cached_property
    def sheets(self) -> dict[str, Drawing]:
        """The cut sheets by name."""
        if self.sheet_folder is None:
            raise NotApplicable("no sheets were written")
        paths = sorted(self.sheet_folder.glob("*.dxf"))
        return {path.stem: drawing for path, drawing in zip(paths, self.spread(read_dxf, paths), strict=True)}

    @cached_property
    def plan(self) -> Book:
        """The cutting plan."""
        if self.plan_file is None:
            raise NotApplicable("no cutting plan was written")
        return read_pdf(self.plan_file)


def _part(part: Json) -> Drawing:
    outer = np.array(part["points"], dtype=np.float64)
    holes: list[Json] = part.get("holes", [])
    inner = [Outline("CUT_INNER", np.array(h["points"]), np.array(h["bulges"]), True) for h in holes if "points" in h]
    drilled = [Entity("CIRCLE", "DRILL", ((*h["centre"], 0.0),), h["radius"]) for h in holes if "centre" in h]
    return Drawing(str(part["id"]), 4, (), (Outline("CUT", outer, np.zeros(len(outer)), True), *inner), tuple(drilled))


@dataclass(frozen=True)
class NestedBars(Delivery):
    """The files of a nest of members: `folder` is the layout, what was not written is None."""

    saw_file: Path | None = None
    plan_file: Path | None = None

    @cached_property
    def raw(self) -> Json:
        """The layout file."""
        return read_json(self.folder)

    def bar_rules(self) -> tuple[Rule, ...]:
        """Give the checks of these files."""
        return (
            Rule("V34c", "bars: pieces, kerf, trim and offcuts", LENGTH, "mm", lambda _: nested_bars.pieces(self.raw)),
            Rule("V34d", "the saw list = layout", 0, "faults", lambda _: nested_bars.listed(self.raw, self.saw_file)),
            Rule("V45g", "the saw list shows every bar as it is cut", 0, "faults", lambda _: self._planned()),
        )

    def _planned(self) -> Measured:
        if self.plan_file is None:
            raise NotApplicable("no saw list was printed")
        return paper_faults(read_pdf(self.plan_file), nested_bars.bars_of(self.raw))


def verify_nest(
    layout: Path,
    sheets: Path | None = None,
    plan: Path | None = None,
    saw_list: Path | None = None,
    spread: Spread = one_by_one,
) -> Certificate:
    """Prove what `isomould nest` wrote.

    Parameters
    ----------
    layout
        The layout file, of sheets or of bars.
    sheets
        The folder of its sheets.
    plan
        Its cutting plan, or the saw list on paper.
    saw_list
        Its saw list as a table.
    spread
        Reads the sheets side by side.

    Raises
    ------
    OutputFault
        If the layout cannot be read. Whatever else is wrong is a failed check.
    """
    if read_json(layout).get("kind") == "bars":
        bars = NestedBars(layout, True, spread, saw_list, plan)
        return Certificate(tuple(judge(rule, bars) for rule in bars.bar_rules()))
    found = Nested(layout, True, spread, sheets, plan)
    rules = RULES if found.layout.sheets else tuple(rule for rule in RULES if rule.id == "V31")
    return Certificate(tuple(judge(rule, found) for rule in rules))
