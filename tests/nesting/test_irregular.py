"""Concave parts in each other's hollows: fewer sheets, proved, the same every time."""

import json

import numpy as np
import pytest

import isomould
from isomould.nesting import interlocking, irregular
from isomould.nesting.bound import Room
from isomould.nesting.checker import check_layout
from isomould.nesting.files import layout_from_json, layout_to_json
from isomould.nesting.interlocking import Lot, interlock
from isomould.nesting.irregular import Nest, nest_parts
from isomould.nesting.layout import Part
from isomould.nesting.search import Search
from isomould.nesting.settings import SheetStock, StockSettings

pytest.importorskip("spyrrow")

ANGLE = np.array([[0, 0], [900, 0], [900, 300], [300, 300], [300, 900], [0, 900.0]])
"""Two of these lie in a square of 300 + 5 + 900; their boxes want two sheets."""
ANGLES = (Part("L", ANGLE, 2, locations=("a", "b")),)
STOCK = StockSettings(sheets=(SheetStock(name="s", width=1250, height=1250),), gap=5, trim=10)
LOT = Lot(((0, ANGLE, 2),), (0, 90, 180, 270), Room(1_230_000, 1_230_000), 5.0)


def nest(stock: StockSettings = STOCK, jobs: int = 1) -> Nest:
    return nest_parts(ANGLES, stock, Search("quick", jobs=jobs))


def test_angles_interlock_and_the_layout_is_proved_and_the_same_for_any_number_of_jobs() -> None:
    found = nest()
    assert (len(found.layout.sheets), found.layout.bound, found.layout.reproducible) == (1, 1, True)
    assert not found.stock.guillotine
    assert check_layout(ANGLES, found.stock, found.layout) == ()
    assert [finding.code for finding in check_layout(ANGLES, STOCK, found.layout)] == ["N-CUT-01"]
    text = layout_to_json(found.layout)
    assert layout_to_json(nest(jobs=4).layout) == text
    assert json.loads(text)["cut_tree"] is None
    assert json.loads(text)["cut_tree_reason"] == irregular.REASON
    assert layout_from_json(text).no_cuts == irregular.REASON


@pytest.mark.parametrize(
    ("stock", "words"),
    [
        (STOCK.model_copy(update={"guillotine": True}), "cut from edge to edge"),
        (StockSettings(sheets=STOCK.sheets, gap=0), "E-NEST-04"),
    ],
)
def test_stock_that_is_cut_straight_keeps_its_strips(stock: StockSettings, words: str) -> None:
    if stock.scored:
        with pytest.raises(isomould.Refused, match=words):
            nest(stock)
        return
    explicit = StockSettings(**{**stock.model_dump(), "guillotine": True})
    found = nest(explicit)
    assert len(found.layout.sheets) == 2
    assert found.layout.cut_trees
    assert words in found.notes[0].text


def test_without_the_engine_a_note_says_what_hulls_cost(monkeypatch: pytest.MonkeyPatch) -> None:
    """An angle has 0.45 m², its hull 0.63 m²: 40 per cent more."""
    monkeypatch.setattr(irregular, "has_engine", lambda: False)
    found = nest()
    (note,) = found.notes
    assert len(found.layout.sheets) == 2
    assert note.code == "W-NEST-HULL"
    assert "1.26 m² for 0.90 m² of parts (+40 %)" in note.text
    assert "isomould[irregular]" in note.text


@pytest.mark.parametrize(("version", "serves"), [("0.9.0", True), ("1.0", True), ("0.8.4", False), (None, False)])
def test_an_engine_that_is_missing_or_too_old_is_none(monkeypatch, version: str | None, serves: bool) -> None:
    def installed(_: str) -> str:
        if version is None:
            raise interlocking.metadata.PackageNotFoundError
        return version

    monkeypatch.setattr(interlocking.metadata, "version", installed)
    assert interlocking.has_engine() == serves


def test_the_number_of_sheets_is_halved_in(monkeypatch: pytest.MonkeyPatch) -> None:
    """Sixteen angles: sixteen sheets by hulls, an engine that places three at most on each of them wants six."""
    asked = list[int]()

    def fill(lots, _) -> irregular._Trial:
        asked.append(len(lots))
        largest = max(sum(pieces for _, _, pieces in lot.parts) for lot in lots)
        return irregular._Trial((interlocking.Answer((), steady=True),) * len(lots) * (largest <= 3), steady=True)

    monkeypatch.setattr(irregular, "_fill", fill)
    monkeypatch.setattr(irregular, "_layout", lambda parts, stock, sheets, steady: len(sheets))
    parts, stock = [Part("L", ANGLE, 16)], STOCK.model_copy(update={"guillotine": False})
    strips = irregular.nest_sheets(parts, stock, Search("quick", jobs=1))
    assert (len(strips.sheets), irregular.interlocked(parts, stock, strips, Search("quick"))) == (16, 6)
    assert len(asked) <= 5


def test_lists_that_are_nearly_convex_go_as_before(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(irregular, "interlocked", None)
    dented = np.array([[0, 0], [900, 0], [900, 500], [450, 495], [0, 500.0]])
    found = nest_parts([Part("D", dented, 2)], STOCK, Search("quick"))
    assert not found.notes
    assert found.layout.cut_trees


def test_parts_of_several_sheets_and_those_that_stay_in_strips() -> None:
    """Five angles on sheets for two each: three; where no sheet is saved the strips are kept."""
    five = nest_parts([Part("L", ANGLE, 5)], STOCK, Search("quick", jobs=1))
    assert len(five.layout.sheets) == 3
    assert len({placement.sheet for placement in five.layout.placements}) == 3
    one = nest_parts([Part("L", ANGLE, 1)], STOCK, Search("quick", jobs=1))
    assert one.layout.cut_trees


def test_a_search_that_is_stopped_keeps_the_strips_and_says_so() -> None:
    stopped = nest_parts(ANGLES, STOCK, Search("quick", should_stop=lambda: True, jobs=1))
    assert (len(stopped.layout.sheets), stopped.layout.reproducible) == (2, False)


def test_an_answer_that_does_not_hold_is_not_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    grown = 2.5 + interlocking.SPARE

    def answer(x: float) -> str:
        return json.dumps({"ended": "fits", "placed": [[0, 0.0, grown, grown], [0, 180.0, grown + x, grown + x]]})

    for x, fits in ((1205.0, True), (1203.0, False), (1500.0, False)):
        monkeypatch.setattr(interlocking, "_ask", lambda *_, x=x: answer(x))
        assert (interlock(LOT, 1, lambda: False).placed is not None) == fits
    for text, steady in ((None, False), ("", True), (json.dumps({"ended": "time", "placed": []}), False)):
        monkeypatch.setattr(interlocking, "_ask", lambda *_, told=text: told)
        answer_given = interlock(LOT, 1, lambda: False)
        assert (answer_given.placed, answer_given.steady) == (None, steady)


def test_files_of_an_interlocked_nest_are_proved_without_cuts(tmp_path) -> None:
    table = {"name": "Angles", "sheet": [1250, 1250], "gap": 5, "trim": 10}
    rows = [{"id": "L", "quantity": 2, "points": ANGLE.tolist()}]
    (tmp_path / "parts.json").write_text(json.dumps({**table, "parts": rows}))
    out, cut, plan = tmp_path / "out.json", tmp_path / "cut", tmp_path / "plan.pdf"
    files = isomould.NestFiles(sheets=cut, plan=plan)
    layout = isomould.nest(tmp_path / "parts.json", out, "quick", files=files, jobs=1)
    assert len(layout.sheets) == 1
    proved = isomould.verify(out, jobs=1, sheets=cut, plan=plan)
    assert proved.passed
    assert {check.id: check.status for check in proved.checks}["V35b"] == "not_applicable"
    for change, check_id in ((3.0, "V33f"), (-100.0, "V33g")):
        raw = json.loads(out.read_text())
        raw["placements"][0]["points"] = (np.array(raw["placements"][0]["points"]) + change).tolist()
        (tmp_path / "moved.json").write_text(json.dumps(raw))
        moved = isomould.verify(tmp_path / "moved.json", jobs=1)
        assert {check.id: check.status for check in moved.checks}[check_id] == "fail"
