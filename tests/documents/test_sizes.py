"""Sizes first: figures against the delivered tables and by hand, limits, trade, and what programs read."""

import json

import numpy as np
import pandas as pd
import pytest
import shapely

import isomould
from isomould.cli import main
from isomould.errors import Refused
from isomould.parts.panel_sizes import measure_panels, refuse_panel_sizes, trade_notes
from isomould.parts.settings import PanelLimits
from museum import DELIVERED, SMALL, changed, design, write_project

CONTRACT = {
    *(f"panel_largest_{word}" for word in ("width", "height", "area", "mass")),
    *(f"{word}_edge_{family}" for word in ("longest", "shortest") for family in ("generatrix", "parallel")),
    *(f"node_classes_{kind}" for kind in ("interior", "boundary", "support")),
    *("panel_worst_aspect", "total_area", "total_mass", "mismatch", "cost"),
}


@pytest.fixture(scope="module")
def checked(tmp_path_factory):
    path = write_project(tmp_path_factory.mktemp("sizes") / "small.toml", DELIVERED)
    return isomould.check(path)


@pytest.fixture(scope="module")
def figures(checked):
    return {figure.name: figure for figure in checked.figures}


def read(folder, name):
    return pd.read_csv(folder / "tables" / f"{name}.csv")


def test_figures_are_those_of_the_delivered_tables(figures, built_folder):
    panels, members, nodes = (read(built_folder, name) for name in ("panels", "members", "nodes"))
    largest = panels.loc[panels["area_m2"].idxmax()]
    assert figures["panel_largest_area"].value == pytest.approx(largest["area_m2"], abs=1e-5)
    assert figures["panel_largest_mass"].value == pytest.approx(largest["mass_kg"], abs=1e-3)
    assert figures["panel_largest_area"].where.startswith(f"{largest['mark']} at P-")
    assert figures["total_area"].value == pytest.approx(panels["total_area_m2"].sum(), abs=1e-4)
    masses = [table["total_mass_kg"].sum() for table in (panels, members, nodes)]
    assert figures["total_mass"].value == pytest.approx(sum(masses), rel=1e-6)
    for family in ("generatrix", "parallel"):
        lengths = members[members["family"] == family]["system_length_mm"]
        assert figures[f"longest_edge_{family}"].value == pytest.approx(lengths.max(), abs=0.51)
        assert figures[f"shortest_edge_{family}"].value == pytest.approx(lengths.min(), abs=0.51)
    kinds = nodes["kind"].value_counts()
    assert figures["node_classes_interior"].value == kinds.get("interior", 0) + kinds.get("flat", 0)
    assert figures["node_classes_boundary"].value == kinds["boundary"]
    assert figures["mismatch"].value == pytest.approx(
        read(built_folder, "node_instances")["mismatch_mm"].max(), abs=1e-3
    )


def test_the_cost_leaves_out_exactly_what_nesting_adds(checked, figures, built_folder):
    """All else is the build's: the difference is the further sheets and bars, with overhead and margin on them."""
    sheets, bars = len(read(built_folder, "sheets")), len(read(built_folder, "bars"))
    basis = next(note.text for note in checked.notes if note.code == "W-COST-BASIS")
    counted = [int(word) for word in basis.replace(",", "").split() if word.isdigit()]
    assert counted[0] <= sheets
    assert counted[1] <= bars
    further = (sheets - counted[0]) * 100 + (bars - counted[1]) * 80
    works = read(built_folder, "cost")["amount"].sum()
    surcharge = 1.12 * 1.08
    assert figures["cost"].value == pytest.approx((works - further) * surcharge, abs=0.01)
    assert figures["cost"].unit == "EUR"


def test_boxes_are_the_smallest_rectangles():
    kit = design(SMALL).kit
    sizes = measure_panels(kit.panels, design(SMALL).project.panels)
    for number, blank in enumerate(kit.panels.blanks):
        ring = np.array(shapely.minimum_rotated_rectangle(shapely.Polygon(blank)).exterior.coords)
        sides = sorted(np.linalg.norm(np.diff(ring, axis=0), axis=1)[:2])
        assert sizes.width[number] * sizes.height[number] <= sides[0] * sides[1] + 1e-2
    assert sizes.width == pytest.approx(np.maximum(sizes.width, sizes.height))


@pytest.mark.parametrize(
    ("limit", "word"),
    [
        ({"max_panel": (2000.0, 3000.0)}, "limits.max_panel: a panel of 2386"),
        ({"max_panel_mass": 159.0}, "limits.max_panel_mass: a panel of 159.8 kg"),
        ({"max_aspect": 2.0}, "limits.max_aspect: a panel of 1:2.2"),
        ({"min_corner_deg": 88.0}, "limits.min_corner_deg: a corner of 86.57°"),
    ],
)
def test_limits_refuse_and_name_the_worst_panel(limit, word):
    made = design(SMALL)
    sizes = measure_panels(made.kit.panels, made.project.panels)
    with pytest.raises(Refused, match="E-PANEL-LIMIT") as refusal:
        refuse_panel_sizes(sizes, PanelLimits(**limit))
    assert word in str(refusal.value)
    assert " at P-" in str(refusal.value)
    assert not trade_notes(sizes, PanelLimits())


def test_limits_that_are_just_held_refuse_nothing():
    made = design(SMALL)
    sizes = measure_panels(made.kit.panels, made.project.panels)
    limits = PanelLimits(
        max_panel=(float(sizes.height.max()), float(sizes.width.max())),
        max_panel_mass=float(sizes.mass.max()),
        max_aspect=float(sizes.aspect.max()),
        min_corner_deg=float(sizes.corner_deg.min()),
    )
    refuse_panel_sizes(sizes, limits)


def test_trade_is_noted_without_limits_and_not_beside_them():
    """Panes of 40 mm weigh more than 400 kg: that does not pass in silence."""
    data = changed(
        SMALL, panels={"thickness": 40}, members={"section": {"kind": "plate", "depth": 200, "thickness": 12}}
    )
    made = design(data)
    sizes = measure_panels(made.kit.panels, made.project.panels)
    (note,) = trade_notes(sizes, PanelLimits())
    assert note.code == "W-PANEL-TRADE"
    assert "at most 400 kg" in note.text
    assert not trade_notes(sizes, PanelLimits(max_panel_mass=1000.0))


def test_check_refuses_all_limits_together(project_file):
    path = project_file(changed(SMALL, limits={"max_panel": ["2 m", "2 m"], "max_aspect": 1.5}))
    with pytest.raises(Refused) as refusal:
        isomould.check(path)
    assert {one.field for one in refusal.value.each} == {"limits.max_panel", "limits.max_aspect"}


def test_check_as_json_holds_to_the_contract(project_file, capsys):
    path = project_file(SMALL)
    with pytest.raises(SystemExit) as end:
        main(["check", str(path), "--json"])
    said, warned = capsys.readouterr()
    told = json.loads(said)
    assert end.value.code == 0
    assert set(told) == {"facts", "notes"}
    assert set(told["facts"]) >= CONTRACT
    assert all({"value", "unit"} <= set(fact) for fact in told["facts"].values())
    assert all(set(note) == {"code", "field", "text"} for note in told["notes"])
    assert warned == ""
