"""The price of repetition: the table against a computation by hand, live in LibreOffice, refused what cannot be."""

import math
from dataclasses import replace

import numpy as np
import openpyxl
import pytest

import isomould
from isomould.comparison import compare_families
from isomould.errors import Refused
from isomould.form.mesh import grid_mesh
from isomould.measure.take_off import take_off
from isomould.parts.arms import find_arms
from isomould.project.load import validate
from isomould.repetition import make_pricing, price_families
from isomould.verify.delivery import Delivery
from isomould.verify.folder import RULES
from isomould.verify.rules import judge
from museum import SMALL, changed, design, write_project
from recalculate import needs_libreoffice, recalculate, with_cell

RATES = {**SMALL["costs"], "node_run_torsion": 95.0, "panel_set_up": 12.0, "hours_member": 0.1, "erect_node": 7.0}
DATA = changed(SMALL, costs=RATES, deliver={"compare": True, "strips": []})
WITHOUT_STOCK = {
    **changed(DATA, costs={"steel": 2.0, "waste_members": 10, "glass": 90, "waste_panels": 5}),
    "stock": {},
}


def repetition(data, compared):
    project = validate(data, "repetition")
    return price_families(compared, project, make_pricing(project, project.stock))[1].frame.set_index("family")


@pytest.fixture(scope="module")
def compared():
    return compare_families(design(DATA))


def test_works_are_those_computed_by_hand(compared):
    row, found = repetition(DATA, compared).loc["triangulated"], compared[0].measured
    nodes, members, panels = found.nodes, found.members, found.panels
    assert row["twisted_nodes_count"] == nodes == 48
    assert row["node_set_up_cost"] == found.node_classes * 350
    assert row["node_run_cost"] == pytest.approx(nodes * 95 + 2 * members * 6)
    assert row["member_run_cost"] == 2 * members * 4
    assert row["panel_set_up_cost"] == found.panel_classes * 12
    assert row["assembly_cost"] == pytest.approx((0.4 * nodes + 0.1 * members + 0.25 * panels) * 58)
    assert row["erection_cost"] == 7 * nodes + 65 * panels
    assert row["member_material_cost"] == pytest.approx(row["member_length_mm"] / 6000 * 80)
    assert row["panel_material_cost"] == pytest.approx(row["charged_area_m2"] / 10 * 100)
    works = row.filter(like="_cost")[:-4].sum()
    assert row["works_cost"] == pytest.approx(works)
    assert row["full_cost"] == pytest.approx(works * 1.12 * 1.08)
    assert row["square_metre_cost"] == pytest.approx(row["full_cost"] / row["panel_area_m2"])


def test_without_stock_material_is_paid_for_by_mass_and_charged_area(compared):
    row = repetition(WITHOUT_STOCK, compared).loc["isogonal"]
    kilograms = row["member_length_mm"] / 1e3 * 0.2 * 0.012 * 7850
    assert row["member_material_cost"] == pytest.approx(kilograms * 2 * 1.1)
    assert row["panel_material_cost"] == pytest.approx(row["charged_area_m2"] * 90 * 1.05)


def test_torsion_costs_what_any_node_does_where_nobody_says_more(compared):
    data = {**DATA, "costs": {key: value for key, value in RATES.items() if key != "node_run_torsion"}}
    row = repetition(data, compared).loc["triangulated"]
    assert row["node_run_cost"] == pytest.approx(48 * 28.5 + 2 * compared[0].measured.members * 6)


def test_only_meshes_with_torsion_pay_for_it(compared):
    twisted = repetition(DATA, compared)["twisted_nodes_count"]
    assert twisted["triangulated"] > 0 == twisted["pq-conical"] == twisted["isogonal"] == twisted["edge-offset"]


def test_repetition_pays(compared):
    cost = repetition(DATA, compared)["node_set_up_cost"]
    assert cost["isogonal"] < cost["pq-conical"] < cost["triangulated"]


def test_a_family_without_a_mesh_is_a_row_of_blanks(compared):
    families = (replace(compared[0], measured=None, taken=None, reason="none"), *compared[1:])
    assert repetition(DATA, families)["full_cost"].isna().tolist() == [True, False, False, False, False]


def grid(corner):
    kinds = np.ones((2, 2), dtype=np.int64)
    points = np.array(corner, dtype=float).reshape(2, 2, 3)
    return grid_mesh(points, np.broadcast_to([0.0, 0.0, 1.0], (2, 2, 3)).copy(), kinds, (False, False))


def test_quantities_of_one_rectangle_that_lies_askew():
    turn = np.array([[math.cos(0.7), -math.sin(0.7), 0], [math.sin(0.7), math.cos(0.7), 0], [0, 0, 1]])
    mesh = grid(np.array([[0, 0, 0], [3000, 0, 0], [0, 1000, 0], [3000, 1000, 0]]) @ turn.T)
    taken = take_off(mesh, find_arms(mesh))
    assert taken.boxes == pytest.approx(np.array([[3000.0, 1000.0]]))
    assert (taken.area, taken.contour, taken.length) == pytest.approx((3e6, 8000, 8000))
    assert taken.twisted == 0


def test_the_box_of_a_trapezoid_lies_on_its_longest_side():
    mesh = grid([[0, 0, 0], [2000, 0, 0], [300, 900, 0], [1500, 900, 0]])
    taken = take_off(mesh, find_arms(mesh))
    assert taken.boxes == pytest.approx(np.array([[2000.0, 900.0]]))
    assert taken.area == pytest.approx(1.44e6)


def test_an_axis_turned_out_of_its_beams_is_counted():
    mesh = grid([[0, 0, 0], [1000, 0, 0], [0, 1000, 0], [1000, 1000, 0]])
    axes = mesh.axes.copy()
    axes[0] = [math.sin(0.1), math.sin(0.1), math.sqrt(1 - 2 * math.sin(0.1) ** 2)]
    mesh = replace(mesh, axes=axes)
    assert take_off(mesh, find_arms(mesh)).twisted == 3


@pytest.fixture(scope="module")
def book(tmp_path_factory):
    folder = tmp_path_factory.mktemp("repetition")
    isomould.compare(write_project(folder / "small.toml", DATA), out=folder / "families.xlsx")
    return folder / "families.xlsx"


def test_the_workbook_of_a_comparison_has_rates_money_and_charts(book):
    found = openpyxl.load_workbook(book)
    assert found.sheetnames == ["Cover", "Rates", "Families", "Repetition"]
    titles = [chart.title.tx.rich.p[0].r[0].t for chart in found["Repetition"]._charts]
    assert titles == ["What the works cost (EUR)", "Classes"]
    assert "rate_node_run_torsion" in found.defined_names


def test_without_rates_nothing_is_priced(tmp_path):
    project = write_project(tmp_path / "small.toml", {**DATA, "costs": {"currency": "EUR"}})
    isomould.compare(project, out=tmp_path / "families.xlsx")
    assert openpyxl.load_workbook(tmp_path / "families.xlsx").sheetnames == ["Cover", "Families"]


@pytest.mark.slow
@needs_libreoffice
def test_libreoffice_follows_the_rates(book, tmp_path):
    sheet = openpyxl.load_workbook(book).sheetnames.index("Rates") + 1
    codes = [cell.value for cell in openpyxl.load_workbook(book)["Rates"]["A"]]
    rates = {"node_run_torsion": 120.0, "panel_set_up": 40.0, "overhead": 20.0, "sheet_1": 130.0}
    changes = [
        with_cell(book, sheet, f"D{codes.index(code) + 1}", value, tmp_path / f"{code}.xlsx")
        for code, value in rates.items()
    ]
    for path, (code, value) in zip(recalculate(changes, tmp_path), rates.items(), strict=True):
        sheets = [{**SMALL["stock"]["sheets"][0], "price": value}]
        table = {"stock": {"sheets": sheets}} if code == "sheet_1" else {"costs": {code: value}}
        expected = repetition(changed(DATA, **table), compare_families(design(DATA)))["full_cost"].tolist()
        rows = list(openpyxl.load_workbook(path, data_only=True)["Repetition"].iter_rows(min_row=1, max_row=6))
        column = [cell.value for cell in rows[0]].index("Full cost")
        assert [row[column].value for row in rows[1:]] == pytest.approx(expected, rel=1e-12)


@pytest.mark.slow
def test_the_sheet_of_a_build_is_verified(tmp_path):
    project = write_project(tmp_path / "small.toml", WITHOUT_STOCK)
    built = isomould.schedule(project, tmp_path / "out", run=isomould.Run(effort="quick", jobs=1))
    table = built.folder / "tables" / "repetition.csv"
    assert "V41" in {check.id for check in built.certificate.checks if check.status == "pass"}
    table.write_bytes(table.read_bytes().replace(b"isogonal,48,10,0", b"isogonal,48,11,0"))
    cells = next(rule for rule in RULES if rule.id == "V41")
    assert "Repetition row 5 node_classes: 10" in judge(cells, Delivery(built.folder)).reason


@pytest.mark.parametrize(("content", "found"), [(None, "No such file"), (b"GIF89a", "6 bytes, or no PNG")])
def test_logos_that_are_none_are_refused(tmp_path, content, found):
    project = write_project(tmp_path / "small.toml", changed(SMALL, project={"logo": "logo.png"}))
    if content:
        (tmp_path / "logo.png").write_bytes(content)
    with pytest.raises(Refused, match=rf"E-LOGO project\.logo: logo\.png: {found}"):
        isomould.check(project)
