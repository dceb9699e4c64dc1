"""Panels and beams that pass through others far from them; degenerate panels; overhangs."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import linprog

from isomould.curves.construction import build_curve
from isomould.curves.plane import build_plane
from isomould.design import requests_of
from isomould.errors import Refused
from isomould.form.assemble import RailInPlane, make_form
from isomould.form.clash import Polygons, clashes, polygons_of
from isomould.form.mesh import make_mesh
from isomould.form.orientation import orient_rail, place_generatrix
from isomould.form.slivers import inner_angles_deg, side_lengths, weigh_panels
from isomould.project.load import validate
from museum import MONGE, SMALL, TEMPLATES, VAULT, changed, design, dome, sketched, sphere, template, trimmed

SQUARE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float) * 100
TURNS = np.linspace(0, 2.6 * np.pi, 27)
HELIX = [[5000 * np.cos(a), 5000 * np.sin(a), 1500 * a / (2 * np.pi)] for a in TURNS]
COIL = changed(MONGE, rail={"curve": {"kind": "polyline", "points": HELIX}, "up": [-1, 0, 0]})
"""A band, wider than its pitch, wound more than once around."""


def pair(one, other):
    nodes = np.array([[0, 1, 2, 3], [4, 5, 6, 7]])
    return Polygons(np.stack([one, other]), nodes)


def turned_about_x(points, degrees):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return points @ np.array([[1, 0, 0], [0, c, s], [0, -s, c]])


CASES = {  # the second square, and how deep it reaches into the first
    "through the middle": (np.add(turned_about_x(SQUARE - [0, 50, 0], 90), [20, 50, 0]), 50),
    "in its plane": (np.add(SQUARE, [90, 60, 0]), 10),
    "upright through a side": (np.add(turned_about_x(SQUARE - [0, 50, 0], 90), [97, 50, 0]), 3),
    "on it": (np.add(SQUARE, [0, 0, 0]), 100),
    "over it": (np.add(SQUARE, [0, 0, 1e-5]), None),
    "beside it": (np.add(SQUARE, [100.001, 0, 0]), None),
    "touching": (np.add(SQUARE, [100, 0, 0]), None),
    "boxes overlap only": (np.add(turned_about_x(SQUARE, 45), [0, -20, 30]), None),
}


@pytest.mark.parametrize("case", CASES)
def test_two_squares(case):
    other, depth = CASES[case]
    pairs, depths = clashes(pair(SQUARE, other))
    assert len(pairs) == (depth is not None)
    assert depths == pytest.approx([depth] * len(pairs))


def test_neighbours_are_left_alone():
    other = np.add(turned_about_x(SQUARE - [0, 50, 0], 90), [20, 50, 0])
    meeting = Polygons(np.stack([SQUARE, other]), np.array([[0, 1, 2, 3], [3, 5, 6, 7]]))
    assert not clashes(meeting)[0].size


def apart(one, other):
    """Independent answer: no point is a convex combination of both."""
    m, n = len(one), len(other)
    rows = np.block([[one.T, -other.T], [np.ones(m), np.zeros(n)], [np.zeros(m), np.ones(n)]])
    return linprog(np.zeros(m + n), A_eq=rows, b_eq=[0, 0, 0, 1, 1], bounds=(0, None), method="highs").status == 2


def shrunk(points):
    return points.mean(axis=0) + 0.98 * (points - points.mean(axis=0))


@settings(max_examples=80, deadline=None)
@given(st.lists(st.integers(-64, 64).map(lambda n: n / 64), min_size=6, max_size=6))
def test_any_two_squares_by_linear_programming(numbers):
    shift, axis = 80 * np.array(numbers[:3]), np.array(numbers[3:])
    angle = np.linalg.norm(axis)
    k = np.cross(np.eye(3), axis / angle) if angle > 1e-3 else np.zeros((3, 3))
    other = SQUARE @ (np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k) + shift
    _, depths = clashes(pair(SQUARE, other))
    # Both programs have tolerances: the oracle decides where they do not matter, by a block of air or a margin inside.
    if apart(np.concatenate([SQUARE - 1e-4, SQUARE + 1e-4]), other):
        assert not depths.size
    if not apart(shrunk(SQUARE), shrunk(other)):
        assert depths.size


def test_a_coil_is_refused_with_both_panels_and_the_depth():
    with pytest.raises(Refused) as refusal:
        design(COIL)
    text = str(refusal.value)
    assert "E-SURFACE-CLASH" in text
    assert "the panel of row 1, strip 5 and the panel of row 2, strip 25 pass through each other, 292.567 mm" in text


def test_the_same_coil_wound_loosely_is_not():
    loose = [[x, y, 6 * z] for x, y, z in HELIX]
    assert design(changed(COIL, rail={"curve": {"kind": "polyline", "points": loose}})).kit.mesh.face_ij.size


def test_beams_clash_before_panels_do():
    """Two turns of the band nearly touch: beams that are high enough reach through them."""
    mesh = design(changed(COIL, rail={"curve": {"kind": "polyline", "points": [[x, y, 3 * z] for x, y, z in HELIX]}}))
    assert not clashes(polygons_of(mesh.kit.mesh, 200))[0].size
    pairs, _ = clashes(polygons_of(mesh.kit.mesh, 1600))
    assert pairs.size
    assert (pairs.max(axis=1) >= len(mesh.kit.mesh.face_ij)).all()


@pytest.mark.parametrize("data", [VAULT, sphere(6, 60), trimmed(dome(30))], ids=["vault", "sphere", "trimmed"])
def test_sound_surfaces_do_not_clash(data):
    found = design(data)
    assert not clashes(polygons_of(found.kit.mesh, 200))[0].size


def test_sides_and_angles_of_a_trapezoid():
    mesh = design(SMALL).kit.mesh
    corners = mesh.nodes[mesh.faces[:4]]
    assert side_lengths(mesh)[:4] == pytest.approx(np.linalg.norm(np.roll(corners, -1, axis=0) - corners, axis=1))
    assert inner_angles_deg(mesh).reshape(-1, 4).sum(axis=1) == pytest.approx(360)


def with_stations(*stations):
    wall = {"kind": "polyline", "points": [[0, 0], [0, 4001]]}
    table = {"curve": wall, "axes": "dz", "divide": {"stations": list(stations)}}
    small = {"min_member": 0.1}
    return changed(SMALL, generatrix=table, surface={"kind": "moulding"}, tolerances=small)


def panel_notes(data):
    project = validate(data, "museum")
    form = make_form(*ingredients(project))
    return [str(note) for note in weigh_panels(make_mesh(form.surface))]


def test_slender_panels_are_noted():
    (text,) = panel_notes(with_stations(2000, 2060))
    assert "W-PANEL-SLIVER" in text
    assert "sides more than 20 times as long as others" in text
    assert panel_notes(with_stations(2000)) == []


def test_degenerate_panels_are_refused():
    with pytest.raises(Refused, match=r"E-PANEL-SLIVER panel of row 1, strip 0: a side of 0.500 mm.*at least 1 mm"):
        panel_notes(with_stations(2000, 2000.5))


def test_overhangs_are_noted():
    arch = {"kind": "arc", "radius": 1500, "start_deg": -130, "end_deg": 50}
    table = {"curve": arch, "axes": "dz", "outside": [1, 0], "divide": {"nodes": 8}}
    form = make_form(*ingredients(validate(changed(SMALL, generatrix=table), "museum")))
    (note,) = [note for note in form.notes if note.code == "W-GENERATRIX-OVERHANG"]
    assert "rows hang over" in note.text


def test_a_closed_generatrix_hangs_over_by_nature():
    """A torus whose poles are closed by caps, so that its profile is open."""
    assert "W-GENERATRIX-OVERHANG" not in {note.code for note in sketched(template("torus")).notes}


def ingredients(project):
    requests = requests_of(project)
    rail, _ = build_curve(project.rail.curve, TEMPLATES, build_plane(project.rail.plane), "rail.curve")
    arch, _ = build_curve(project.generatrix.curve, TEMPLATES, None, "generatrix.curve")
    table = project.generatrix
    drawn = RailInPlane(orient_rail(rail, project.rail.outside), build_plane(project.rail.plane), None)
    placed = place_generatrix(arch, table.origin, table.axes, table.outside)
    return drawn, placed, requests, project.surface, 10.0
