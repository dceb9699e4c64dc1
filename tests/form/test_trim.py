"""Trimming by planes: what is left, where it ends, what it rests on (geometry §6)."""

import numpy as np
import pytest

from isomould.errors import Refused
from isomould.form.mesh import Family, NodeKind, make_mesh
from isomould.form.settings import SurfaceSettings
from isomould.form.trim import trim_mesh
from museum import VAULT, changed, design, dome, trimmed

OBLIQUE = {"origin": [0, 0, 800.0], "normal": [0.4, 0.25, 2.0]}


@pytest.fixture(scope="module")
def whole():
    return make_mesh(design(dome(5.2)).form.surface)


def cut(mesh, *, keep="above", plane=OBLIQUE, sill=False, min_member=0.01):
    settings = SurfaceSettings.model_validate({"trim": [{"plane": plane, "keep": keep}], "sill": sill})
    return trim_mesh(mesh, settings, min_member)


def polygons(mesh):
    return [mesh.nodes[face] for face in np.split(mesh.faces, mesh.face_offsets[1:-1])]


def normal_and_area(points):
    vector = np.cross(points[1:-1] - points[0], points[2:] - points[0]).sum(axis=0) / 2
    return vector / np.linalg.norm(vector), float(np.linalg.norm(vector))


def area(mesh):
    return sum(normal_and_area(points)[1] for points in polygons(mesh))


def heights(mesh):
    normal = np.array(OBLIQUE["normal"])
    return (mesh.nodes - OBLIQUE["origin"]) @ normal / np.linalg.norm(normal)


def test_without_planes_nothing_happens(whole):
    same, notes = trim_mesh(whole, SurfaceSettings(), 100.0)
    assert same is whole
    assert notes == ()


def test_both_sides_make_the_whole(whole):
    above, below = cut(whole)[0], cut(whole, keep="below")[0]
    assert area(above) + area(below) == pytest.approx(area(whole), rel=1e-12)
    assert 0.1 < area(above) / area(whole) < 0.9


def test_nothing_is_left_beyond_the_plane(whole):
    assert heights(cut(whole)[0]).min() > -1e-6


def test_panels_are_plane_convex_and_counter_clockwise(whole):
    mesh = cut(whole)[0]
    assert set(mesh.sizes) == {3, 4, 5}
    for face, points in zip(np.split(mesh.faces, mesh.face_offsets[1:-1]), polygons(mesh), strict=True):
        normal, _ = normal_and_area(points)
        assert np.abs((points - points[0]) @ normal).max() < 1e-6
        assert (mesh.axes[face] @ normal > 0).all()
        into, out = points - np.roll(points, 1, axis=0), np.roll(points, -1, axis=0) - points
        assert (np.cross(into, out) @ normal > 0).all()


def test_supports_lie_on_the_plane_and_on_their_member(whole):
    mesh = cut(whole)[0]
    new = np.flatnonzero(mesh.node_piece)
    assert len(new) > 10
    assert np.abs(heights(mesh)[new]).max() < 1e-6
    assert (mesh.kind[new] == NodeKind.SUPPORT).all()
    index = {tuple(ij): k for k, ij in enumerate(whole.node_ij.tolist())}
    for edge in np.flatnonzero(mesh.edge_piece):
        start = tuple(mesh.edge_ij[edge].tolist())
        step = (1, 0) if mesh.family[edge] == Family.GENERATRIX else (0, 1)
        a, b = index[start], index[start[0] + step[0], start[1] + step[1]]
        along = whole.nodes[b] - whole.nodes[a]
        support = next(node for node in mesh.edges[edge] if mesh.node_piece[node])
        share = (mesh.nodes[support] - whole.nodes[a]) @ along / (along @ along)
        assert mesh.nodes[support] == pytest.approx(whole.nodes[a] + share * along, abs=1e-6)
        blend = (1 - share) * whole.axes[a] + share * whole.axes[b]
        assert mesh.axes[support] == pytest.approx(blend / np.linalg.norm(blend), abs=1e-12)


def test_indices_stay_what_they_were(whole):
    mesh = cut(whole)[0]
    old = {tuple(ij): point for ij, point in zip(whole.node_ij.tolist(), whole.nodes, strict=True)}
    for k in np.flatnonzero(mesh.node_piece == 0):
        assert (mesh.nodes[k] == old[tuple(mesh.node_ij[k].tolist())]).all()
    assert {tuple(ij) for ij in mesh.face_ij.tolist()} < {tuple(ij) for ij in whole.face_ij.tolist()}


def test_a_support_near_a_node_snaps_onto_it(whole):
    target = whole.nodes[len(whole.nodes) // 2]
    plane = {"origin": (target + np.array([0, 0, 30.0])).tolist(), "normal": [0.05, 0.02, 1.0]}
    mesh, notes = cut(whole, plane=plane, min_member=100.0)
    on = np.flatnonzero((mesh.nodes == target).all(axis=1))
    assert mesh.kind[on] == [NodeKind.SUPPORT]
    assert mesh.node_piece[on] == [0]
    note = next(note for note in notes if note.code == "W-TRIM-SNAP")
    assert "mm off it" in note.text
    assert np.linalg.norm(np.diff(mesh.nodes[mesh.edges], axis=1), axis=2).min() > 100.0


def test_a_plane_through_a_parallel_keeps_it():
    mesh = make_mesh(design(VAULT).form.surface)
    y = float(mesh.nodes[mesh.node_ij[:, 0] == 10, 1][0])
    kept, notes = cut(mesh, plane={"origin": [0, y, 0], "normal": [0, 1, 0]}, keep=(0, np.sign(y) or 1.0, 0))
    assert not kept.node_piece.any()
    assert not kept.rimmed.any()
    assert (kept.kind == NodeKind.SUPPORT).sum() == mesh.shape[1]
    assert notes == ()


def test_sills_close_the_rim(whole):
    mesh, notes = cut(whole, sill=True, plane={"z": 0})
    sills = mesh.edges[mesh.family == Family.SILL]
    assert len(sills) == mesh.rimmed.sum() > 10
    assert np.abs(mesh.nodes[sills, 2]).max() < 1e-6
    assert (np.bincount(sills.ravel(), minlength=len(mesh.nodes))[mesh.node_piece > 0] == 2).all()
    assert any(note.code == "W-TRIM-SILL" for note in notes)


def test_slivers_are_reported(whole):
    """A plane just beyond a corner of a face leaves a triangle narrower than the two pieces of member are long."""
    corner, right, _, left = whole.nodes[whole.faces.reshape(-1, 4)[len(whole.face_ij) // 2]]
    ways = [(end - corner) / np.linalg.norm(end - corner) for end in (right, left)]
    outward = ways[0] + ways[1]
    plane = {"origin": (corner + 110 * ways[0]).tolist(), "normal": outward.tolist()}
    _, notes = cut(whole, plane=plane, keep=tuple((-outward).tolist()), min_member=100.0)
    assert "mm wide" in next(note.text for note in notes if note.code == "W-TRIM-SLIVER")
    assert all(note.code != "W-TRIM-SLIVER" for note in cut(whole)[1])


def test_two_planes_that_meet_outside_the_surface():
    data = trimmed(
        dome(5.2),
        {"plane": {"z": 0}, "keep": "above"},
        {"plane": {"z": "2 m"}, "keep": "below"},
    )
    mesh = design(data).kit.mesh
    assert mesh.nodes[:, 2].max() < 2100
    assert mesh.nodes[:, 2].min() > -100


REFUSED = {
    "nothing left": ([{"plane": {"z": "90 m"}, "keep": "above"}], "E-TRIM-EMPTY", "Move the plane"),
    "no side": ([{"plane": {"normal": [1, 0, 0]}, "keep": "above"}], "E-TRIM-SIDE", "direction"),
}  # fmt: skip


@pytest.mark.parametrize("name", REFUSED)
def test_refusals(name):
    planes, code, word = REFUSED[name]
    with pytest.raises(Refused, match=code) as refusal:
        design(trimmed(dome(5.2), *planes))
    assert word in str(refusal.value)


@pytest.mark.parametrize(
    "surface",
    [
        {"sill": True},
        {"trim": [{"plane": {}, "keep": "above"}]},
        {"trim": [{"plane": {"z": 0, "normal": [0, 0, 1]}, "keep": "above"}]},
        {"trim": [{"plane": {"normal": [0, 0, 0]}, "keep": "above"}]},
        {"trim": [{"plane": {"z": 0}}]},
        {"trim": [{"plane": {"z": 0}, "keep": "outside"}]},
    ],
)
def test_the_table_is_checked(surface):
    with pytest.raises(Refused, match="surface"):
        design(changed(dome(5.2), surface=surface))
