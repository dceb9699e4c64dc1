"""Rails drawn on a map: the same surface, the same place on the site, and a delivery that passes."""

import csv

import numpy as np
import pytest

from isomould.api import build
from isomould.design import sketch
from isomould.documents.info import DatumSettings
from isomould.documents.setting_out import place
from isomould.errors import Refused
from isomould.project.load import load_project, validate
from isomould.project.site import on_site

EAST, NORTH = 691_608_100.0, 5_334_765_400.0

PROJECT = """
schema = 1
[project]
name = "On a map"
[rail]
curve = {kind = "dxf", file = "rail.dxf", layer = "RAIL"}
outside = [1, -1]
divide = {nodes = 5}
[generatrix]
curve = {kind = "arc", span = "3 m", rise = "0.4 m"}
axes = "zd"
outside = [1, 0]
divide = {nodes = 4}
[surface]
kind = "isogonal"
"""

HEAD = "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n"
TAIL = "0\nENDSEC\n0\nEOF\n"


def drawn(folder, east=0.0, north=0.0):
    """Write a project whose rail is a line and an arc that leaves it smoothly, at a place."""
    ends = f"10\n{east!r}\n20\n{north!r}\n11\n{east + 1500!r}\n21\n{north!r}\n"
    centre = f"10\n{east + 1500!r}\n20\n{north + 6000!r}\n40\n6000\n50\n270\n51\n330\n"
    run, bend = f"0\nLINE\n8\nRAIL\n{ends}", f"0\nARC\n8\nRAIL\n{centre}"
    folder.mkdir(exist_ok=True)
    (folder / "rail.dxf").write_text(HEAD + run + bend + TAIL)
    (folder / "project.toml").write_text(PROJECT)
    return folder / "project.toml"


def sketched(path):
    loaded = load_project(path)
    return sketch(loaded.project, loaded.folder)


def test_the_surface_is_the_one_at_the_origin(tmp_path):
    near, far = sketched(drawn(tmp_path / "near")), sketched(drawn(tmp_path / "far", EAST, NORTH))
    origin = np.array(far.project.project.datum.origin)
    assert np.abs(far.mesh.nodes).max() < 20_000
    np.testing.assert_array_equal(origin, [691_608_000, 5_334_765_000, 0])
    shift = np.array([EAST, NORTH, 0]) - origin
    np.testing.assert_allclose(far.mesh.nodes - shift, near.mesh.nodes, atol=1e-6)
    assert "W-RAIL-SITE" in {note.code for note in far.notes}
    assert "W-RAIL-SITE" not in {note.code for note in near.notes}


def test_datum_and_trimming_planes_move_with_the_frame():
    table = {
        "schema": 1,
        "project": {"name": "Moved", "datum": {"origin": [1000.0, 2000.0, 300.0], "rotation_deg": 30.0}},
        "rail": {"curve": {"kind": "circle", "radius": 9000.0}, "outside": "outer"},
        "generatrix": {"curve": {"kind": "arc", "span": 6000.0, "rise": 900.0}, "axes": "zd"},
        "surface": {
            "kind": "moulding",
            "trim": [
                {"plane": {"z": 500.0}, "keep": "above"},
                {"plane": {"origin": [5.0, 6.0, 7.0], "normal": [1, 0, 0]}, "keep": "above"},
            ],
        },
    }
    project, origin = validate(table, "moved"), np.array([20e6, -30e6, 400.0])
    moved = on_site(project, origin)
    points = np.random.default_rng(3).normal(size=(20, 3)) * 9000
    before = place(points + origin, project.project.datum)
    np.testing.assert_allclose(place(points, moved.project.datum), before, atol=1e-7)
    level, upright = moved.surface.trim
    assert level.plane.z == 100.0
    assert upright.plane.origin == (5.0 - 20e6, 6.0 + 30e6, 7.0 - 400.0)
    assert on_site(project, np.zeros(3)) is project


def test_a_generatrix_on_a_map_needs_its_place_beside_the_rail(tmp_path):
    path = drawn(tmp_path / "far", EAST, NORTH)
    curve = 'curve = {kind = "dxf", file = "rail.dxf", layer = "RAIL"}\noutside = [1, 0]\ndivide = {nodes = 4}'
    rest = 'curve = {kind = "arc", span = "3 m", rise = "0.4 m"}\naxes = "zd"\noutside = [1, 0]\ndivide = {nodes = 4}'
    path.write_text(PROJECT.replace(rest, curve))
    with pytest.raises(Refused, match="E-GENERATRIX-REMOTE") as refusal:
        sketched(path)
    assert '["-691608 m", "-5334765 m"]' in refusal.value.way_out


@pytest.mark.slow
def test_a_rail_on_a_map_builds_with_a_passing_certificate_and_is_set_out_there(tmp_path):
    built = build(drawn(tmp_path / "far", EAST, NORTH), out=tmp_path / "out")
    assert built.certificate.passed
    with (tmp_path / "out/tables/setting_out.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    places = np.array([[float(row["x_mm"]), float(row["y_mm"])] for row in rows])
    assert DatumSettings().origin == (0.0, 0.0, 0.0)
    assert np.all(np.abs(places - [EAST, NORTH]) < 20_000)
