"""Planes that meet on panels, edges and nodes: what is left is exact and watertight (geometry §6)."""

from functools import cache

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from isomould.errors import Refused
from isomould.form.mesh import Family, NodeKind, make_mesh
from isomould.form.settings import SurfaceSettings
from isomould.form.trim import trim_mesh
from museum import MONGE, SMALL, changed, design, dome, sphere

MERIDIAN = {"kind": "arc", "radius": 10_000, "start_deg": -90, "end_deg": 90}
CAPS = {"pole": "cap", "min_pole_angle_deg": 25}
DESIGNS = {
    "vault": SMALL,
    "dome": dome(5.2, nodes=5),
    "monge": MONGE,
    "globe": changed(sphere(30, 30), generatrix={"curve": MERIDIAN}, surface=CAPS),
    "torus": changed(
        sphere(30, 30),
        rail={"curve": {"kind": "circle", "radius": 8000}},
        generatrix={"curve": {"kind": "circle", "radius": 3500}, "origin": [0, 0]},
        surface=CAPS,
    ),
}
TINY = 1e-3


@cache
def whole(name):
    return make_mesh(design(DESIGNS[name]).form.surface)


def trim(mesh, planes, *, sill=True, min_member=TINY):
    tables = [{"plane": {"origin": list(o), "normal": list(n)}, "keep": list(k)} for o, n, k in planes]
    return trim_mesh(mesh, SurfaceSettings.model_validate({"trim": tables, "sill": sill}), min_member)[0]


def area(mesh):
    points = np.split(mesh.nodes[mesh.faces], mesh.face_offsets[1:-1])
    fans = [np.cross(p[1:-1] - p[0], p[2:] - p[0]).sum(axis=0) / 2 for p in points]
    return sum(float(np.linalg.norm(fan)) for fan in fans)


def area_of(mesh, planes):
    try:
        return area(trim(mesh, planes))
    except Refused as refusal:
        assume(refusal.code == "E-TRIM-EMPTY")
        return 0.0


def single_sides(mesh):
    """Sides of one face only, as directed pairs; every other side is run once each way."""
    directed = set(map(tuple, mesh.sides.tolist()))
    assert len(directed) == len(mesh.sides)
    return sorted((a, b) for a, b in directed if (b, a) not in directed)


def roots(count, pairs):
    """Number the components of a graph by their smallest members (union by hand)."""
    label = list(range(count))
    for a, b in pairs:
        one, other = label[a], label[b]
        if one != other:
            label = [min(one, other) if value in (one, other) else value for value in label]
    return label


coordinate = st.floats(-1, 1, allow_nan=False)
vector = st.tuples(coordinate, coordinate, coordinate).filter(lambda v: np.linalg.norm(v) > 0.2)
planes = st.lists(st.tuples(st.floats(0, 1), vector), min_size=2, max_size=3)


def placed(mesh, drawn):
    """Planes beside nodes of the mesh, so that they cut it; what is kept lies on the side of the normal."""
    picked = [mesh.nodes[int(share * (len(mesh.nodes) - 1))] for share, _ in drawn]
    return [(p + 37.0 * np.array(n), n, n) for p, (_, n) in zip(picked, drawn, strict=True)]


@settings(max_examples=60, deadline=None)
@given(st.sampled_from(sorted(DESIGNS)), planes)
def test_all_parts_make_the_whole(name, drawn):
    """A before both planes, beyond the second, beyond the first: nothing is lost, nothing is there twice."""
    mesh = whole(name)
    (o1, n1, _), (o2, n2, _) = placed(mesh, drawn)[:2]
    back = [tuple(-np.array(n)) for n in (n1, n2)]
    parts = [[(o1, n1, n1), (o2, n2, n2)], [(o1, n1, n1), (o2, n2, back[1])], [(o1, n1, back[0])]]
    assert sum(area_of(mesh, part) for part in parts) == pytest.approx(area(mesh), rel=1e-6)


@settings(max_examples=100, deadline=None)
@given(st.sampled_from(sorted(DESIGNS)), planes, st.sampled_from([TINY, 60.0]))
def test_what_is_left_holds_together(name, drawn, min_member):
    mesh, cuts = whole(name), placed(whole(name), drawn)
    try:
        cut = trim(mesh, cuts, min_member=min_member)
    except Refused as refusal:
        assume(refusal.code not in ("E-TRIM-EMPTY", "E-TRIM-SHORT", "E-TRIM-CORNER"))
        raise
    rims_lie_on_their_planes(cut, mesh, min_member)
    panels_are_convex(cut)
    single = single_sides(cut)
    its_number_is_right(cut, single)
    rimmed = set(map(tuple, cut.sides[cut.rimmed].tolist()))
    sills = cut.edges[cut.family == Family.SILL]
    assert set(map(tuple, sills.tolist())) == rimmed <= set(single)
    others = np.array(sorted(set(single) - rimmed), dtype=np.int64).reshape(-1, 2)
    on_plane = (np.abs(heights(cut)) <= max(min_member, 1e-6))[:, others].all(axis=2).any(axis=0)
    assert (on_plane | (off_lines(cut.nodes[others], mesh, single_sides(mesh)) < 1e-6)).all()
    assert (np.bincount(cut.edges.ravel(), minlength=len(cut.nodes)) > 0).all()


def heights(mesh):
    """Heights (planes, nodes) above the planes."""
    return np.stack([(mesh.nodes - origin) @ normal for origin, normal in mesh.planes])


def off_lines(points, mesh, sides):
    """Least, over some sides of a mesh, of the largest distance of groups of points (n, k, 3) from the side's line."""
    least = np.full(len(points), np.inf)
    for a, b in sides:
        along = mesh.nodes[b] - mesh.nodes[a]
        away = np.linalg.norm(np.cross(points - mesh.nodes[a], along), axis=2) / np.linalg.norm(along)
        least = np.minimum(least, away.max(axis=1))
    return least


def rims_lie_on_their_planes(cut, mesh, min_member):
    """New nodes lie on a plane, and on a side of the mesh or on another plane; all nodes of rims near their planes."""
    off = np.abs(heights(cut))
    new = np.flatnonzero(cut.node_piece)
    nearest = np.sort(off[:, new], axis=0)
    assert (nearest[0] <= 1e-6).all()
    second = np.minimum(
        nearest[1] if len(nearest) > 1 else np.inf, off_lines(cut.nodes[new][:, None], mesh, mesh.sides)
    )
    assert (second <= 1e-6).all()
    for end in (0, 1):
        assert (off[cut.rim_plane, cut.sides[:, end]][cut.rimmed] <= max(min_member, 1e-6)).all()
    assert (cut.kind[cut.sides[cut.rimmed]] == NodeKind.SUPPORT).all()


def panels_are_convex(mesh):
    along = mesh.nodes[mesh.sides[:, 1]] - mesh.nodes[mesh.sides[:, 0]]
    turn = np.cross(along, along[mesh.ahead])
    normal = mesh.per_corner(np.add.reduceat(turn, mesh.face_offsets[:-1]))
    assert (np.einsum("ij,ij->i", turn, normal) > 0).all()
    assert (np.einsum("ij,ij->i", mesh.axes[mesh.faces], normal) > 0).all()


def its_number_is_right(mesh, single):
    """Euler's number of every component with rims is 2 less their number: parts of spheres have no handles."""
    pairs = np.unique(np.sort(mesh.sides, axis=1), axis=0)
    of = np.array(roots(len(mesh.nodes), pairs.tolist()))
    out = np.bincount([a for a, _ in single], minlength=len(mesh.nodes))
    rims = np.array(roots(len(mesh.nodes), single))
    for component in np.unique(of):
        mine = of == component
        if (out[mine] > 1).any() or not (out[mine] > 0).any():
            continue  # a node where two rims touch, and a part without any, are no surface with a simple rim
        faces = np.count_nonzero(mine[mesh.faces[mesh.face_offsets[:-1]]])
        number = np.count_nonzero(mine) - np.count_nonzero(mine[pairs[:, 0]]) + faces
        loops = len(np.unique(rims[mine & (out > 0)]))
        assert number == 2 - loops or (number + loops) % 2 == 0 > number


def corners_of(mesh):
    """Nodes where rims of two planes meet."""
    at = {node: set() for node in range(len(mesh.nodes))}
    for sides, plane in zip(mesh.sides[mesh.rimmed], mesh.rim_plane[mesh.rimmed], strict=True):
        for node in sides:
            at[node].add(plane)
    return np.array([node for node, planes in at.items() if len(planes) > 1])


def middle(mesh, face):
    return mesh.nodes[mesh.faces[slice(*mesh.face_offsets[face : face + 2])]].mean(axis=0)


def test_two_planes_meet_on_a_panel():
    """A corner inside a panel lies on both planes and in the panel, and two sills meet there and nothing else."""
    mesh = whole("dome")
    face = len(mesh.face_ij) // 2
    cut = trim(mesh, [(middle(mesh, face), (0, 0.2, 1), (0, 0, 1)), (middle(mesh, face), (1, 0, 0.1), (1, 0, 0))])
    corners = corners_of(cut)
    here = corners[np.argmin(np.linalg.norm(cut.nodes[corners] - middle(mesh, face), axis=1))]
    assert cut.nodes[here] == pytest.approx(middle(mesh, face), abs=1e-6)
    assert (cut.family[(cut.edges == here).any(axis=1)] == Family.SILL).tolist() == [True, True]
    planes = cut.rim_plane[cut.rimmed & (cut.sides == here).any(axis=1)]
    assert sorted(planes.tolist()) == [0, 1]


def test_two_planes_meet_on_an_edge_and_on_a_node():
    mesh = whole("dome")
    inner = (mesh.edge_ij == np.array(mesh.shape) // 2).all(axis=1)
    (edge,) = np.flatnonzero(inner & (mesh.family == Family.GENERATRIX))
    for place in (mesh.nodes[mesh.edges[edge]].mean(axis=0), mesh.nodes[mesh.edges[edge, 0]]):
        cut = trim(mesh, [(place, (0, 1, 0.2), (0, 1, 0)), (place, (1, 0.3, 0.1), (1, 0, 0))])
        (here,) = np.flatnonzero(np.linalg.norm(cut.nodes - place, axis=1) < 1e-6)
        at = cut.family[(cut.edges == here).any(axis=1)]
        assert np.count_nonzero(at == Family.SILL) == 2
        assert len(at) > 2


def test_the_order_of_planes_changes_no_shape():
    mesh = whole("dome")
    one = (middle(mesh, 12), (0, 0.2, 1), (0, 0, 1))
    two = (middle(mesh, 12), (1, 0, 0.1), (1, 0, 0))
    first, second = trim(mesh, [one, two]), trim(mesh, [two, one])
    assert area(first) == pytest.approx(area(second), rel=1e-12)
    assert np.sort(first.nodes, axis=0) == pytest.approx(np.sort(second.nodes, axis=0), abs=1e-6)


def test_a_corner_beside_a_snapped_support_still_lies_on_both_planes():
    """The first plane snaps onto a node 30 mm off it; the second crosses the rim from there."""
    mesh = whole("dome")
    face = len(mesh.face_ij) // 2
    corner, right, _, left = mesh.nodes[mesh.faces[slice(*mesh.face_offsets[face : face + 2])]]
    across = (left - corner) / np.linalg.norm(left - corner)
    beside = np.cross(right - corner, across)
    normal = np.cross(right - corner + 0.9 * (left - corner), beside)
    first = (corner + 30 * across, normal, normal)
    cut = trim(mesh, [first], min_member=100.0)
    assert (np.abs((cut.nodes[cut.node_piece == 0] - cut.planes[0, 0]) @ cut.planes[0, 1]) < 31).any()
    second = (corner + (right - corner) * 0.3 + (left - corner) * 0.3, right - corner, right - corner)
    rims_lie_on_their_planes(trim(mesh, [first, second], min_member=100.0), mesh, 100.0)


def test_a_corner_without_a_member_is_refused():
    mesh = whole("dome")
    spot = middle(mesh, len(mesh.face_ij) // 2)
    with pytest.raises(Refused, match=r"E-TRIM-LOOSE.*surface.sill = true"):
        trim(mesh, [(spot, (0, 0.2, 1), (0, 0, 1)), (spot, (1, 0, 0.1), (1, 0, 0))], sill=False)
