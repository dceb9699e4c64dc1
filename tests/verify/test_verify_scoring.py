"""V33c-V33e on scored sheets as they are nested and drawn, and with one fault at a time."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from verify_museum import holding, vault, with_raw

from isomould.errors import Refused
from isomould.nesting.files import layout_to_json
from isomould.nesting.layout import Part
from isomould.nesting.nest import nest_sheets
from isomould.nesting.scoring import score_lines
from isomould.nesting.search import Search
from isomould.nesting.settings import SheetStock, StockSettings
from isomould.verify.checks import scoring
from isomould.verify.read.dxf import Drawing, Outline
from isomould.verify.read.layout import read_layout
from isomould.verify.rules import judge

STOCK = StockSettings(sheets=(SheetStock(name="glass", width=3210, height=2250),), gap=0, trim=15)


def trapezoid(a, h, left, right):
    return np.array([(0.0, 0.0), (a, 0.0), (a - right, h), (left, h)])


def score(path, parts, stock=STOCK):
    """Nest parts, and give a delivery of the scored sheets."""
    layout = nest_sheets(parts, stock, Search("quick"))
    lines = score_lines(layout, stock)
    file = path / "nesting.json"
    file.write_text(layout_to_json(layout), encoding="utf-8")
    return lines, scored(lines, read_layout(file), stock)


def scored(lines, layout, stock=STOCK):
    design = with_raw(vault(), nesting={"gap_mm": stock.gap, "kerf_mm": 0, "trim_mm": stock.trim}).design
    drawings = {
        name: Drawing(name, 4, (), tuple(Outline("SCORE", line, np.zeros(2), False) for line in found), ())
        for name, found in lines.items()
    }
    return holding(design=design, layout=layout, sheets=drawings)


def failing(delivery):
    return {rule.id for rule in scoring.RULES if judge(rule, delivery).status != "pass"}


@pytest.fixture(scope="module")
def example(tmp_path_factory):
    """Two rows of panels head to tail, one of them with unequal legs."""
    parts = [
        Part("A", trapezoid(900.0, 700.0, 40.0, 40.0), 5, row=0, locations=()),
        Part("B", trapezoid(1100.0, 650.0, 30.0, 75.0), 4, row=1),
    ]
    return score(tmp_path_factory.mktemp("scored"), parts)


def test_scored_sheets_pass(example):
    assert failing(example[1]) == set()


@given(data=st.data())
@settings(max_examples=12, deadline=None)
def test_sheets_of_any_convex_parts_pass(data, tmp_path_factory):
    length = st.integers(200, 900)
    parts = [
        Part(k, trapezoid(float(a), float(h), float(left), float(right)), n)
        for k, (a, h, left, right, n) in enumerate(
            data.draw(
                st.lists(
                    st.tuples(length, length, st.integers(-60, 90), st.integers(0, 90), st.integers(1, 5)),
                    min_size=1,
                    max_size=4,
                )
            )
        )
    ]
    stock = STOCK.model_copy(update={"trim": data.draw(st.sampled_from([0.0, 12.3456])), "turning": "half"})
    _, delivery = score(tmp_path_factory.mktemp("any"), parts, stock)
    assert failing(delivery) == set()


def change(name, lines):
    first, last = lines[:1], lines[-1:]
    return {
        "twice": np.concatenate([lines, first]),
        "missing": lines[1:],
        "last missing": lines[:-1],
        "reversed": lines[::-1],
        "short": np.concatenate([first + np.array([[0.0, 0.0], [50.0, 0.0]]), lines[1:]]),
        "across a part": np.concatenate([lines, [[[500.0, 15.0], [500.0, 2235.0]]]]),
        "moved": np.concatenate([lines[:-1], last + 0.02]),
    }[name]


@pytest.mark.parametrize(
    ("fault", "caught"),
    [
        ("twice", "V33c"),
        ("missing", "V33d"),
        ("last missing", "V33d"),
        ("reversed", "V33e"),
        ("short", "V33c"),
        ("across a part", "V33c"),
        ("moved", "V33d"),
    ],
)
def test_seeded_faults(example, fault, caught):
    lines, delivery = example
    assert len(lines["S001"]) > 4
    broken = scored({**lines, "S001": change(fault, lines["S001"])}, delivery.layout)
    assert caught in failing(broken)


def test_a_contour_that_is_cut_is_found(example):
    drawing = example[1].sheets["S001"]
    contour = Outline("CUT", trapezoid(900.0, 700.0, 40.0, 40.0), np.zeros(4), True)
    sheets = {**example[1].sheets, "S001": replace(drawing, outlines=(*drawing.outlines, contour))}
    assert failing(holding(design=example[1].design, layout=example[1].layout, sheets=sheets)) == {"V33c"}


def test_cut_sheets_are_not_judged(example):
    cut = scored(example[0], example[1].layout, STOCK.model_copy(update={"gap": 5.0}))
    assert {judge(rule, cut).status for rule in scoring.RULES} == {"not_applicable"}


def test_a_corner_that_points_inwards_cannot_be_scored():
    notched = np.array([(0.0, 0.0), (900.0, 0.0), (900.0, 700.0), (400.0, 300.0), (0.0, 700.0)])
    with pytest.raises(Refused, match=r"E-NEST-04.*part X.*400.000, 300.000 mm points inwards"):
        nest_sheets([Part("X", notched)], STOCK)
