"""V1-V16 on good meshes of three kinds, and on meshes with one fault each."""

from dataclasses import replace

import numpy as np
import pytest
from verify_museum import changed, product_mesh, ring, sphere, spoilt, status, vault, with_rail, with_raw

from isomould.verify.checks import crossing, nodes, panels, polygons, topology
from isomould.verify.rules import judge

RULES = (*panels.RULES, *nodes.RULES, *polygons.RULES, *topology.RULES, *crossing.RULES)
GOOD = {"vault": vault(), "ring": ring(), "sphere": sphere()}


@pytest.mark.parametrize("name", GOOD)
@pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule.id)
def test_good_meshes_pass(name, rule):
    check = judge(rule, GOOD[name])
    assert check.status != "fail", check
    assert check.count > 0 or check.reason


def test_what_does_not_apply_says_why():
    silent = {name: [r.id for r in RULES if judge(r, d).status == "not_applicable"] for name, d in GOOD.items()}
    assert silent == {"vault": ["V7", "V10"], "ring": ["V7"], "sphere": ["V16"]}


def moved(delivery, by=0.01, node=30):
    return spoilt(delivery, "mesh", nodes=changed(delivery.mesh.nodes, node, np.array([by, by, -by])))


def tilted(delivery, node=30):
    axes = changed(delivery.mesh.node_axes, node, np.array([1e-6, -1e-6, 0]))
    return spoilt(delivery, "mesh", node_axes=axes / np.linalg.norm(axes, axis=1)[:, None])


def inside_out(delivery):
    mesh = delivery.mesh
    return spoilt(delivery, "mesh", faces=mesh.faces.reshape(-1, 4)[:, ::-1].ravel())


def one_face_turned(delivery):
    faces = delivery.mesh.faces.reshape(-1, 4).copy()
    faces[5] = faces[5, ::-1]
    return spoilt(delivery, "mesh", faces=faces.ravel())


def one_face_lost(delivery):
    mesh = delivery.mesh
    return spoilt(
        delivery,
        "mesh",
        faces=mesh.faces[4:],
        face_offsets=mesh.face_offsets[:-1],
        face_ij=mesh.face_ij[1:],
        face_mark=mesh.face_mark[1:],
        face_location=mesh.face_location[1:],
    )


def sheared(delivery):
    """Every panel a parallelogram: strips pushed along the rail, which keeps planes and parallels."""
    return spoilt(delivery, "mesh", nodes=delivery.mesh.nodes + 1e-4 * delivery.mesh.nodes[:, [1, 2, 0]])


def swapped_legs(delivery):
    nodes_ = delivery.mesh.nodes.copy()
    nodes_[30:32] = nodes_[[31, 30]]
    return spoilt(delivery, "mesh", nodes=nodes_)


def wrong_turning(delivery, by=1e-9):
    return with_rail(delivery, turning=changed(delivery.design.rail.turning, 3, by))


def one_contact(delivery, by=1e-6):
    contacts = list(delivery.design.rail.contacts)
    contacts[3] = (contacts[3][0], contacts[3][1] + by)
    return with_rail(delivery, contacts=tuple(contacts))


def vertex_moved(delivery, by=0.01):
    return with_rail(delivery, vertices=changed(delivery.design.rail.vertices, 4, by))


def other_curve(delivery):
    piece = {**delivery.design.rail.curve[0]}
    piece["minor"] = [0.0, piece["minor"][1] * (1 + 1e-6)]
    return with_rail(delivery, curve=(piece,))


def steps(delivery):
    """One direction between the lattice's, declared as it is."""
    rail = delivery.design.rail
    return with_rail(
        delivery,
        turning=changed(changed(rail.turning, 3, 0.01), 4, -0.01),
        directions=changed(rail.directions, 3, 0.01),
    )


def flipped_by_depth(delivery):
    return with_raw(delivery, member={"depth": 4e4})


def pulled_across(delivery):
    """One corner of the mesh drawn through the inside and out again."""
    mesh = delivery.mesh
    middle = len(mesh.nodes) // 2
    far = mesh.nodes[middle] + 1500 * mesh.node_axes[middle]
    return spoilt(delivery, "mesh", nodes=changed(mesh.nodes, 0, far - mesh.nodes[0]))


def in_bisectors(delivery):
    """The profile measured in the bisecting planes of the rail nodes, and not across its edges (failure mode C4)."""
    line = delivery.design.generatrix
    bisected = replace(line, vertices=line.vertices * [np.cos(delivery.design.rail.declared / 2), 1.0])
    return spoilt(delivery, "mesh", nodes=product_mesh(replace(delivery.design, generatrix=bisected)).nodes)


def drifted(delivery):
    """Every node a little further from its place than the one before it (failure mode C11)."""
    nodes_ = delivery.mesh.nodes
    return spoilt(delivery, "mesh", nodes=nodes_ + 1e-7 * np.arange(len(nodes_))[:, None])


def high_beams(delivery):
    return with_raw(delivery, member={"depth": 4e4})


FAULTS = [
    ("V13", "vault", pulled_across),
    ("V13", "ring", pulled_across),
    ("V13", "vault", high_beams),
    ("V1", "vault", moved),
    ("V1", "ring", moved),
    ("V2", "vault", moved),
    ("V2", "vault", swapped_legs),
    ("V3", "ring", sheared),
    ("V3", "vault", moved),
    ("V4", "vault", inside_out),
    ("V4", "ring", one_face_turned),
    ("V4", "vault", swapped_legs),
    ("V5", "vault", moved),
    ("V5", "sphere", moved),
    ("V6", "vault", tilted),
    ("V6", "sphere", moved),
    ("V7", "sphere", moved),
    ("V7", "sphere", tilted),
    ("V16", "ring", tilted),
    ("V8", "vault", wrong_turning),
    ("V8", "ring", vertex_moved),
    ("V8", "vault", steps),
    ("V8b", "ring", one_contact),
    ("V8b", "vault", wrong_turning),
    ("V9", "vault", one_contact),
    ("V9", "ring", vertex_moved),
    ("V9", "vault", other_curve),
    ("V10", "ring", vertex_moved),
    ("V11", "ring", one_face_turned),
    ("V11", "vault", one_face_lost),
    ("V12", "vault", swapped_legs),
    ("V12", "vault", flipped_by_depth),
    ("V15", "vault", moved),
    ("V15", "ring", vertex_moved),
    ("V15", "vault", sheared),
    ("V15", "vault", in_bisectors),
    ("V15", "vault", drifted),
]


@pytest.mark.parametrize(("rule", "name", "spoil"), FAULTS, ids=lambda x: getattr(x, "__name__", x))
def test_faults_are_found(rule, name, spoil):
    assert status(RULES, rule, spoil(GOOD[name])).status == "fail"


def test_the_fault_is_named():
    assert status(RULES, "V15", moved(GOOD["vault"])).where == GOOD["vault"].mesh.node_location[30]
    assert status(RULES, "V6", tilted(GOOD["vault"])).where[:2] in {"MG", "MP"}


def test_short_members_and_too_much_deviation_fail():
    assert status(RULES, "V12", with_raw(GOOD["vault"], limits={"min_member_mm": 5000})).status == "fail"
    assert status(RULES, "V9b", GOOD["vault"]).limit is None
    deviation = status(RULES, "V9b", GOOD["vault"]).worst
    for limit, expected in ((deviation * 1.001, "pass"), (deviation * 0.999, "fail")):
        assert status(RULES, "V9b", with_raw(GOOD["vault"], limits={"max_deviation_mm": limit})).status == expected


def test_deviation_is_that_of_a_tangent_polygon():
    """R (1/cos(α/2) − 1) on a circle; the profile's is smaller."""
    rail = GOOD["sphere"].design.rail
    assert status(RULES, "V9b", GOOD["sphere"]).worst == pytest.approx(9e3 * (1 / np.cos(rail.declared / 2) - 1))


def test_wrong_counts_are_found():
    assert status(RULES, "V11", with_raw(GOOD["ring"], counts={"faces": 1})).status == "fail"


def test_mitred_ends_are_told_from_square_ones():
    """The mitre vector of a further node of the same angle: A = N + tan(α/2) of the way out along the edge."""
    delivery = GOOD["vault"]
    mesh, rail, d = delivery.mesh, delivery.design.rail, delivery.design.generatrix.vertices[:, 0]
    nodes_ = mesh.nodes.reshape(9, 13, 3).copy()
    for end, sign in ((0, 1), (-1, -1)):
        out = sign * np.array([np.cos(rail.directions[end]), np.sin(rail.directions[end])]) @ delivery.design.plane[1:]
        nodes_[:, end] -= (d * np.tan(rail.declared / 2))[:, None] * out
    mitred = spoilt(delivery, "mesh", nodes=nodes_.reshape(-1, 3))
    assert status(RULES, "V15", mitred).status == "pass"
    for ends, expected in (("mitred", "pass"), ("square", "fail")):
        recorded = spoilt(mitred, "design", raw={**mitred.design.raw, "ends": ends})
        assert status(RULES, "V15", recorded).status == expected
    shifted = nodes_ + np.where(np.arange(13)[:, None] == 0, 1e-3, 0.0)
    assert status(RULES, "V15", spoilt(mitred, "mesh", nodes=shifted.reshape(-1, 3))).status == "fail"


def test_torsion_of_a_pair_of_axes_is_found_elsewhere():
    """Both axes of one edge turned about it: that edge is content, its neighbours are not."""
    delivery = GOOD["vault"]
    mesh, (a, b) = delivery.mesh, delivery.mesh.edges[40]
    edge = mesh.nodes[b] - mesh.nodes[a]
    axes = mesh.node_axes.copy()
    axes[[a, b]] += 1e-6 * np.cross(edge / np.linalg.norm(edge), axes[[a, b]])
    axes /= np.linalg.norm(axes, axis=1)[:, None]
    assert status(RULES, "V6", spoilt(delivery, "mesh", node_axes=axes)).status == "fail"


def test_trimmed_meshes_keep_their_grid_checks():
    """A corner face cut to a pentagon with two support nodes on its edges and a sill between them."""
    delivery = GOOD["vault"]
    mesh = delivery.mesh
    whole = mesh.nodes.reshape(9, 13, 3)
    on_parallel, on_generatrix = (whole[0, 0] + whole[0, 1]) / 2, (whole[0, 0] + whole[1, 0]) / 2
    keep = np.arange(1, len(mesh.nodes))
    number = {int(old): new for new, old in enumerate(keep)}
    s, t = len(keep), len(keep) + 1
    faces = mesh.faces.reshape(-1, 4)
    first = [s, number[faces[0, 1]], number[faces[0, 2]], number[faces[0, 3]], t]
    rest = [[number[k] for k in face] for face in faces[1:]]
    edges = [
        [number.get(a, s if family == "parallel" else t), number[b]]
        for (a, b), family in zip(mesh.edges.tolist(), mesh.edge_family, strict=True)
    ]
    trimmed = replace(
        mesh,
        nodes=np.vstack((mesh.nodes[1:], on_parallel, on_generatrix)),
        node_axes=np.vstack((mesh.node_axes[1:], mesh.node_axes[[1, 13]])),
        node_ij=np.vstack((mesh.node_ij[1:], [[-1, -1]] * 2)),
        node_mark=np.append(mesh.node_mark[1:], ["N02", "N02"]),
        node_location=np.append(mesh.node_location[1:], ["NS-000", "NS-001"]),
        edges=np.array([*edges, [t, s]]),
        edge_family=np.append(mesh.edge_family, "sill"),
        edge_mark=np.append(mesh.edge_mark, "M02"),
        edge_location=np.append(mesh.edge_location, "MS-000"),
        faces=np.array([*first, *np.ravel(rest)]),
        face_offsets=np.concatenate(([0, 5], 5 + 4 * np.arange(1, len(faces)))),
    )
    counts = {"nodes": len(trimmed.nodes), "edges": len(trimmed.edges)}
    good = with_raw(spoilt(delivery, "mesh", **vars(trimmed)), counts=counts, limits={"min_member_mm": 50})
    failed = {rule.id: judge(rule, good).reason for rule in RULES if judge(rule, good).status == "fail"}
    assert failed.keys() <= {"V6"}, failed  # the support axes are borrowed from their neighbours here
    astray = replace(trimmed, nodes=changed(trimmed.nodes, s, np.array([0.01, 0.01, 0.01])))
    assert status(RULES, "V15", spoilt(good, "mesh", **vars(astray))).status == "fail"
