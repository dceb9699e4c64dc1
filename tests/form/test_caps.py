"""Caps: flat panels that close a surface over its poles, where no member leads (geometry §5, paper Fig. 17)."""

import csv
import json
import re
import shutil
from pathlib import Path

import numpy as np
import pytest

import isomould
from isomould.errors import Refused
from isomould.form.mesh import Family
from isomould.verify.delivery import Delivery
from isomould.verify.folder import RULES
from isomould.verify.rules import judge
from museum import BARE, HALL, SMALL, changed, design, sphere, trimmed, write_project

CAP = {"pole": "cap"}
TORUS = changed(
    sphere(30, 30),
    rail={"curve": {"kind": "circle", "radius": 8000}},
    generatrix={"curve": {"kind": "circle", "radius": 3500}, "origin": [0, 0]},
    surface={"pole": "cap", "min_pole_angle_deg": 30},
)
MERIDIAN = {"kind": "arc", "radius": 10_000, "start_deg": -90, "end_deg": 90}
GLOBE = changed(
    sphere(30, 30),
    generatrix={"curve": MERIDIAN},
    surface={"pole": "cap", "min_pole_angle_deg": 25},
    stock=HALL,
    deliver=BARE,
)
DOME = changed(GLOBE, generatrix={"curve": {**MERIDIAN, "start_deg": 0}})
OVERHANG = changed(
    SMALL,
    rail={"divide": {"angle_deg": 12}},
    generatrix={
        "curve": {"kind": "arc", "radius": 2000, "start_deg": -50, "end_deg": 150},
        "origin": ["4 m", 0],
        "axes": "dz",
        "divide": {"phase": "centre"},
    },
    surface={"kind": "edge-offset", "pole": "cap", "min_pole_angle_deg": 20},
    tolerances={"min_member": 170},
)
CAPPED = {"torus": (TORUS, 0, 0), "globe": (GLOBE, 2, 0), "dome": (DOME, 1, 1), "overhang": (OVERHANG, 1, 1)}
"""Project, Euler's number and number of rims."""


def times(mesh):
    """How many faces share each side, by its pair of nodes."""
    pairs, count = np.unique(np.sort(mesh.sides, axis=1), axis=0, return_counts=True)
    return dict(zip(map(tuple, pairs.tolist()), count.tolist(), strict=True))


def opened(data):
    return changed(data, surface={"pole": "open"})


@pytest.mark.parametrize("name", CAPPED)
def test_the_surface_is_closed_over_its_poles(name):
    data, euler, rims = CAPPED[name]
    mesh = design(data).kit.mesh
    shared = times(mesh)
    assert len(mesh.nodes) - len(shared) + len(mesh.face_ij) == euler
    assert len(set(map(tuple, mesh.sides.tolist()))) == len(mesh.sides)
    single = [pair for pair, count in shared.items() if count == 1]
    assert (len(single) > 0) == (rims > 0)
    assert set(shared.values()) <= {1, 2}


@pytest.mark.parametrize("name", CAPPED)
def test_caps_add_panels_and_nothing_else(name):
    data = CAPPED[name][0]
    closed, gap = design(data).kit, design(opened(data)).kit
    assert (closed.mesh.nodes == gap.mesh.nodes).all()
    assert (closed.mesh.edges == gap.mesh.edges).all()
    assert closed.nodes.marks == gap.nodes.marks
    assert closed.members.marks == gap.members.marks
    assert closed.mismatch.max() < 1e-9
    there = set(map(tuple, gap.mesh.face_ij.tolist()))
    assert there < set(map(tuple, closed.mesh.face_ij.tolist()))


@pytest.mark.parametrize("name", CAPPED)
def test_capping_panels_are_plane_and_face_outwards(name):
    mesh = design(CAPPED[name][0]).kit.mesh
    for face in np.split(mesh.faces, mesh.face_offsets[1:-1]):
        points = mesh.nodes[face]
        into, out = points - np.roll(points, 1, axis=0), np.roll(points, -1, axis=0) - points
        turn = np.cross(into, out)
        normal = turn.sum(axis=0) / np.linalg.norm(turn.sum(axis=0))
        assert np.abs((points - points[0]) @ normal).max() < 1e-9
        assert (turn @ normal > 0).all()
        assert (mesh.axes[face] @ normal > 0).all()


def test_radial_sides_have_neither_member_nor_seat():
    kit = design(TORUS).kit
    rows = np.flatnonzero(np.isin(kit.mesh.face_ij[:, 0], [5, 11]))
    assert len(rows) == 24
    for face in rows:
        side = kit.mesh.face_offsets[face] + np.arange(4)
        assert (kit.panels.edges[side] >= 0).tolist() == [True, False, True, False]
        assert (kit.mesh.family[kit.panels.edges[side[[0, 2]]]] == Family.PARALLEL).all()
        assert np.isnan(kit.panels.packers[side]).tolist() == [False, True, False, True]
        assert np.isfinite(kit.panels.bearing[side]).tolist() == [True, False, True, False]


@pytest.mark.parametrize("data", [TORUS, OVERHANG])
def test_neighbours_over_a_radial_side_keep_the_gap(data):
    """Undersides and outsides of both panels stay half the gap away from the plane between them, and one touches it."""
    result = design(data)
    kit, asked = result.kit, result.project.panels
    pairs = {}
    for place, edge in enumerate(kit.panels.edges):
        if edge < 0:
            pairs.setdefault(tuple(sorted(kit.mesh.sides[place].tolist())), []).append(place)
    inner = [(pair, places) for pair, places in pairs.items() if len(places) == 2]
    assert len(inner) >= 8
    face = np.repeat(np.arange(len(kit.mesh.face_ij)), kit.mesh.sizes)
    for (a, b), places in inner:
        along = kit.mesh.nodes[b] - kit.mesh.nodes[a]
        between = np.cross(along, kit.mesh.axes[a] + kit.mesh.axes[b])
        between /= np.linalg.norm(between)
        for place in places:
            ends = kit.panels.corners[[place, kit.mesh.ahead[place]]]
            both = np.concatenate([ends, ends + asked.thickness * kit.panels.normals[face[place]]])
            away = np.abs((both - kit.mesh.nodes[a]) @ between)
            assert away.min() == pytest.approx(asked.gap / 2, abs=1e-6)


def test_lids_lie_over_the_poles():
    mesh = design(GLOBE).kit.mesh
    lids = np.flatnonzero(mesh.sizes > 4)
    assert mesh.face_ij[lids].tolist() == [[mesh.shape[0] - 1, 0], [mesh.shape[0], 0]]
    levels = [mesh.nodes[mesh.faces[slice(*mesh.face_offsets[lid : lid + 2])], 2] for lid in lids]
    assert [np.ptp(level) < 1e-9 for level in levels] == [True, True]
    assert levels[0][0] == -levels[1][0] == mesh.nodes[:, 2].max()


def test_where_a_closed_generatrix_begins_does_not_matter():
    turned = {"kind": "ellipse", "semi_axes": [3500, 3500], "rotation_deg": 137}
    one, other = design(TORUS).kit, design(changed(TORUS, generatrix={"curve": turned})).kit
    assert one.panels.marks == other.panels.marks
    assert (one.mesh.faces == other.mesh.faces).all()


def test_what_closes_the_poles_is_told():
    note = next(note for note in design(GLOBE).notes if note.code == "W-SURFACE-CAP")
    assert "2 of 12 sides" in note.text
    assert all(note.code != "W-GENERATRIX-POLE" for note in design(GLOBE).notes)


def test_sides_beyond_the_alphabet_have_names_of_their_own():
    many = changed(DOME, rail={"divide": {"angle_deg": 10}}, panels={"min_bearing": 30})
    with pytest.raises(Refused, match="E-PANEL-BEARING") as refusal:
        design(many)
    assert re.search(r"side [a-z]{1,2} of P-", str(refusal.value))
    assert max(design(changed(many, panels={"min_bearing": 1})).kit.mesh.sizes) == 36


REFUSED = {
    "an open rail": (
        changed(OVERHANG, generatrix={"curve": {"kind": "arc", "radius": 2000, "start_deg": -50, "end_deg": 90}}),
        ["E-SURFACE-CAP", "surface.pole", "open rail", "'open'"],
    ),
    "a hole that widens towards the pole": (
        changed(TORUS, generatrix={"curve": {"kind": "arc", "radius": 3500, "start_deg": 110, "end_deg": 250},
                                   "outside": [-1, 0]}),
        ["E-SURFACE-CAP", "no outline of a convex panel"],
    ),
    "another kind": (
        changed(SMALL, surface={"kind": "isogonal", "pole": "cap"}),
        ["surface", "leaves nothing open"],
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", REFUSED)
def test_refusals(name):
    data, words = REFUSED[name]
    with pytest.raises(Refused) as refusal:
        design(data)
    for word in words:
        assert word in str(refusal.value)


def deliver(folder, data):
    run = isomould.Run(effort="quick", jobs=1)
    return isomould.build(write_project(folder / "caps.toml", data), folder / "caps", run=run)


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """A delivered globe and a torus."""
    projects = {"globe": GLOBE, "torus": changed(TORUS, stock=HALL, deliver=BARE)}
    return {name: deliver(tmp_path_factory.mktemp(name), data) for name, data in projects.items()}


@pytest.mark.parametrize("name", ["globe", "torus"])
def test_the_certificate_holds(built, name):
    assert built[name].certificate.passed, built[name].certificate.failures


def test_lids_are_scheduled_by_their_outline(built):
    with (built["globe"].folder / "tables" / "panels.csv").open(encoding="utf-8", newline="") as file:
        (lid,) = [row for row in csv.DictReader(file) if row["outline"]]
    points = np.array([[float(x) for x in pair.split(",")] for pair in lid["outline"].split(";")])
    assert len(points) == 12
    assert lid["side_a_mm"] == ""
    radius = np.linalg.norm(points - points.mean(axis=0), axis=1)
    assert np.ptp(radius) < 0.01
    assert float(lid["area_m2"]) == pytest.approx(6 * radius.mean() ** 2 * np.sin(np.pi / 6) / 1e6, rel=1e-4)
    assert lid["quantity"] == "2"


def without_face(arrays, face):
    sizes = np.diff(arrays["face_offsets"])
    rows = np.repeat(np.arange(len(sizes)), sizes) != face
    arrays["faces"] = arrays["faces"][rows]
    arrays["face_offsets"] = np.concatenate([[0], np.cumsum(np.delete(sizes, face))])
    for name in ("face_ij", "face_mark", "face_location"):
        arrays[name] = np.delete(arrays[name], face, axis=0)


def lost_lid(arrays):
    without_face(arrays, int(np.argmax(np.diff(arrays["face_offsets"]))))


def lost_cap(arrays):
    without_face(arrays, int(np.flatnonzero(arrays["face_ij"][:, 0] == 11)[3]))


def bent_cap(arrays):
    face = int(np.flatnonzero(arrays["face_ij"][:, 0] == 5)[3])
    corners = arrays["faces"][arrays["face_offsets"][face] :][:4]
    arrays["nodes"][corners[2]] += [0, 0, 0.01]


def shifted_lid(arrays):
    lid = int(np.argmax(np.diff(arrays["face_offsets"])))
    place = arrays["face_offsets"][lid]
    arrays["faces"][place] = arrays["faces"][place + 1] + 1


FAULTS = {
    "lid lost": ("globe", "V11", lost_lid),
    "lid over the wrong nodes": ("globe", "V11", shifted_lid),
    "cap lost": ("torus", "V11", lost_cap),
    "cap bent": ("torus", "V1", bent_cap),
}


def status(built, tmp_path, rule, change):
    folder = Path(shutil.copytree(built.folder, tmp_path / "delivered"))
    path = folder / "model" / "geometry.npz"
    with np.load(path) as file:
        arrays = dict(file)
    change(arrays)
    np.savez(path, **arrays)
    return judge({r.id: r for r in RULES}[rule], Delivery(folder)).status


@pytest.mark.parametrize("name", FAULTS)
def test_seeded_faults_are_found(built, tmp_path, name):
    which, rule, change = FAULTS[name]
    assert status(built[which], tmp_path, rule, change) == "fail"


@pytest.mark.long
def test_a_plane_through_a_lid(tmp_path):
    plane = {"plane": {"origin": [1500, 0, 0], "normal": [1, 0, 0.05]}, "keep": [1, 0, 0]}
    cut = deliver(tmp_path, changed(trimmed(GLOBE, plane), tolerances={"min_member": 20}))
    assert cut.certificate.passed, cut.certificate.failures
    assert status(cut, tmp_path, "V17b", lost_lid) == "fail"


@pytest.mark.long
@pytest.mark.parametrize("pole", ["open", "cap"])
def test_a_plane_through_the_feet_of_an_overhang(tmp_path, pole):
    """On an open rail the radial ends of caps are neither rims nor members."""
    plane = {"plane": {"origin": [124, -174, 4849], "normal": [0.05, 0.1, 1.0]}, "keep": [0, 0, 1]}
    data = changed(
        trimmed({**OVERHANG, "stock": HALL}, plane),
        surface={"pole": pole},
        tolerances={"min_member": 100},
        members={"min_clear": 0.1, "section": {"kind": "plate", "depth": 100, "thickness": 6}},
        nodes={"diameter_step": 1},
        panels={"seat_width": 50, "gap": 8, "thickness": 6},
        deliver={"strips": []},
    )
    assert deliver(tmp_path, data).certificate.passed


def test_a_design_that_knows_of_no_caps_is_found(built, tmp_path):
    folder = Path(shutil.copytree(built["torus"].folder, tmp_path / "delivered"))
    path = folder / "model" / "design.json"
    record = json.loads(path.read_text("utf-8"))
    assert record.pop("caps") == {"rows": [5, 11], "lids": []}
    path.write_text(json.dumps(record), "utf-8")
    assert judge({r.id: r for r in RULES}["V11"], Delivery(folder)).status == "fail"
