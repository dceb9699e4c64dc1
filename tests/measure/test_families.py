"""Mesh families on one surface: each has what Tables 1 and 5 of the paper say of it."""

from dataclasses import replace

import numpy as np
import openpyxl
import pytest

import isomould
from isomould.comparison import compare_families, families_table
from isomould.errors import Refused
from isomould.measure.families import scale_trans, triangulated
from isomould.measure.smooth import Smooth, surface_distances
from isomould.verify.delivery import Delivery
from isomould.verify.folder import RULES
from isomould.verify.rules import judge
from isomould.writers.csv import csv_text
from museum import BARE, HALL, SMALL, VAULT, changed, design, sphere


def measured(data):
    return {each.family: each.measured for each in compare_families(design(data))}


@pytest.fixture(scope="module")
def vault():
    return measured(VAULT)


def test_all_families_have_the_counts_of_the_design(vault):
    assert list(vault) == ["triangulated", "scale-trans", "pq-conical", "isogonal", "edge-offset"]
    for family in ("triangulated", "scale-trans", "pq-conical", "isogonal"):
        assert (vault[family].parallels, vault[family].generatrices, vault[family].nodes) == (33, 20, 660)


def test_triangles(vault):
    mesh = vault["triangulated"]
    assert (mesh.panels, mesh.members) == (2 * 608, 1267 + 608)
    assert np.isnan(mesh.conical)
    assert mesh.planarity < 1e-9
    assert mesh.torsion > 0.01


def test_scale_trans_meshes_are_planar_and_not_conical(vault):
    mesh = vault["scale-trans"]
    assert mesh.planarity < 1e-9
    assert mesh.conical > 1e-3
    assert mesh.torsion > 1e-4


def test_conical_meshes_are_planar_conical_and_free_of_torsion(vault):
    for family in ("pq-conical", "isogonal", "edge-offset"):
        mesh = vault[family]
        assert max(mesh.planarity, mesh.conical, mesh.torsion) < 1e-9


def test_isogonal_has_the_fewest_nodes_and_the_most_various_lengths(vault):
    classes = {family: mesh.interior for family, mesh in vault.items()}
    assert classes["isogonal"] == 8 < classes["pq-conical"] < classes["triangulated"]
    assert vault["isogonal"].spread > vault["pq-conical"].spread


def test_only_the_edge_offset_mesh_has_beams_that_meet(vault):
    exact = measured(changed(VAULT, generatrix={"flat_nodes": False}))["edge-offset"]
    assert max(exact.mismatch, exact.cone) < 1e-9
    assert all(mesh.mismatch > 0.1 for family, mesh in vault.items() if family != "edge-offset")


def test_the_design_is_measured_as_it_is():
    own = design(sphere(15, 30))
    mesh = {each.family: each.measured for each in compare_families(own)}["edge-offset"]
    assert (mesh.nodes, mesh.panels) == (len(own.kit.mesh.nodes), len(own.kit.mesh.face_ij))
    assert mesh.node_classes == len(own.kit.nodes.marks)
    assert mesh.levels == own.kit.mesh.shape[0]


def test_the_axes_of_comparison_meshes_point_outside():
    vault = design(VAULT)
    smooth = Smooth(vault.rail.curve, vault.generatrix, vault.rail.plane)
    for make in (triangulated, scale_trans):
        axes = make(smooth, (19, 32)).axes.reshape(33, 20, 3)
        assert axes[:, 9:11, 2].min() > 0


def test_triangles_lie_on_the_surface_at_their_nodes():
    ball = design(sphere(15, 30))
    smooth = Smooth(ball.rail.curve, ball.generatrix, ball.rail.plane)
    assert surface_distances(smooth, triangulated(smooth, (24, 7)).nodes).max() < 1e-6


def test_families_that_do_not_exist_say_why():
    straight = {**VAULT["generatrix"], "curve": {"kind": "polyline", "points": [[0, 0], [20_000, 0]]}}
    data = {**VAULT, "surface": {"kind": "moulding"}, "generatrix": straight | {"divide": {"stations": 6}}}
    compared = {each.family: each for each in compare_families(design(data | {"generatrix": _plain(data)}))}
    assert compared["pq-conical"].measured is not None
    for family in ("isogonal", "edge-offset"):
        assert compared[family].measured is None
        assert "E-CURVE-STRAIGHT" in compared[family].reason


def _plain(data):
    return {key: value for key, value in data["generatrix"].items() if key != "flat_nodes"}


def test_table_and_csv(tmp_path, project_file):
    path = tmp_path / "families.csv"
    compared = isomould.compare(project_file(SMALL), out=path)
    rows = path.read_text(encoding="utf-8").splitlines()
    assert rows[0].startswith("family,parallels,generatrices,nodes_count,node_classes,interior_node_classes")
    assert [row.split(",")[0] for row in rows[1:]] == [each.family for each in compared]
    frame = families_table(compared).frame.set_index("family")
    assert frame.loc["isogonal", "mismatch_mm"] == pytest.approx(compared[3].measured.mismatch, abs=6e-4)
    assert frame.loc["isogonal", "cone_spread_deg"] == pytest.approx(np.degrees(compared[3].measured.cone), abs=6e-5)


def test_a_family_without_a_mesh_is_a_row_of_blanks():
    compared = compare_families(design(SMALL))
    table = families_table((replace(compared[0], measured=None, reason="none"), *compared[1:]))
    assert table.frame["nodes_count"].isna().tolist() == [True, False, False, False, False]
    assert table.frame["reason"].tolist() == ["none", "", "", "", ""]


def test_workbook_of_a_comparison(tmp_path, project_file):
    path = tmp_path / "families.xlsx"
    compared = isomould.compare(project_file(SMALL), out=path)
    rows = list(openpyxl.load_workbook(path)["Families"].iter_rows(values_only=True))
    assert [row[0] for row in rows[1:]] == [each.family for each in compared]
    assert [row[3] for row in rows[1:]] == [each.measured.nodes for each in compared]
    with pytest.raises(Refused, match=r"E-COMPARE-FILE --out: .*families\.ods"):
        isomould.compare(project_file(SMALL), out=tmp_path / "families.ods")


@pytest.mark.slow
def test_the_sheet_of_a_build_is_verified(tmp_path, project_file):
    path = project_file({**SMALL, "stock": HALL, "deliver": {**BARE, "compare": True}})
    built = isomould.build(path, tmp_path / "out", run=isomould.Run(effort="quick", jobs=1))
    table = built.folder / "tables" / "families.csv"
    assert table.read_bytes().decode() == csv_text(families_table(compare_families(built.design)))
    table.write_bytes(table.read_bytes().replace(b"isogonal,8,6,48", b"isogonal,8,6,49"))
    cells = next(rule for rule in RULES if rule.id == "V41")
    assert "Families row 5 nodes_count: 48" in judge(cells, Delivery(built.folder)).reason
