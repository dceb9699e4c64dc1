"""Deliveries over rails in space: built, proved, and found out when one thing is wrong."""

import numpy as np
import pytest
from verify_museum import changed as replaced
from verify_museum import spoilt, status, with_rail, with_raw

import isomould
from isomould.verify.checks import nodes, panels, polygons, topology
from isomould.verify.delivery import Delivery
from museum import BARE, HALL, MONGE, changed, write_project

RULES = (*panels.RULES, *nodes.RULES, *polygons.RULES, *topology.RULES)
T = np.linspace(0, 2 * np.pi, 8, endpoint=False)
RING = np.column_stack([5000 * np.cos(T), 4600 * np.sin(T), 300 * np.cos(2 * T)])
RING[5] += [0.002, 0.004, 0.003]
FLAT = {"kind": "arc", "span": 5000, "rise": 600}


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """An open vault and a closed ring whose frame closes as far as a shop can tell, with all their files."""
    folder = tmp_path_factory.mktemp("space")
    ring = {"curve": {"kind": "polyline", "points": RING.tolist(), "closed": True}}
    arc = {"curve": {"kind": "polyline", "points": MONGE["rail"]["curve"]["points"][:5]}}
    rails = {"vault": arc, "ring": ring}
    base = changed(MONGE, generatrix={"curve": FLAT, "divide": {"nodes": 1}}, stock=HALL, deliver=BARE)
    projects = {n: changed(base, rail=rail) for n, rail in rails.items()}
    run = isomould.Run(effort="quick", jobs=1)
    return {
        name: isomould.build(write_project(folder / f"{name}.toml", data), folder / name, run=run)
        for name, data in projects.items()
    }


@pytest.fixture(scope="module")
def delivery(built):
    return Delivery(built["vault"].folder)


@pytest.fixture(scope="module")
def ring(built):
    return Delivery(built["ring"].folder)


@pytest.mark.parametrize("name", ["vault", "ring"])
def test_the_certificate_leaves_out_only_what_one_plane_would_ask(built, name):
    checks = {check.id: check for check in built[name].certificate.checks}
    assert built[name].certificate.passed
    silent = {key for key, check in checks.items() if check.status == "not_applicable"}
    assert {"V1", "V2", "V4", "V5", "V6", "V9b", "V11", "V12", "V15", "V16"}.isdisjoint(silent)
    assert {"V3", "V7"} <= silent
    assert ("V10" in silent) == (name == "vault")


def node_moved(delivery):
    return spoilt(delivery, "mesh", nodes=replaced(delivery.mesh.nodes, 7, np.array([0.01, 0.01, -0.01])))


def axis_tilted(delivery):
    axes = replaced(delivery.mesh.node_axes, 7, np.array([1e-6, -1e-6, 0]))
    return spoilt(delivery, "mesh", node_axes=axes / np.linalg.norm(axes, axis=1)[:, None])


def vertex_moved(delivery):
    return with_rail(delivery, vertices=replaced(delivery.design.rail.vertices, 3, np.array([0, 0, 0.01])))


def turned_upright(delivery):
    return spoilt(delivery, "design", raw={**delivery.design.raw, "up": [0.0, 1e-6, 1.0]})


def walked_backwards(delivery):
    return with_rail(delivery, vertices=delivery.design.rail.vertices[::-1].copy())


@pytest.mark.parametrize(
    ("rule", "fault"),
    [
        ("V1", node_moved),
        ("V2", node_moved),
        ("V5", node_moved),
        ("V15", node_moved),
        ("V6", axis_tilted),
        ("V16", axis_tilted),
        ("V15", vertex_moved),
        ("V15", turned_upright),
        ("V12", walked_backwards),
    ],
)
def test_faults_are_found(delivery, rule, fault):
    assert status(RULES, rule, delivery).status == "pass"
    assert status(RULES, rule, fault(delivery)).status == "fail"


def test_a_vertex_off_its_curve_is_found(delivery):
    limited = with_raw(delivery, limits={"max_deviation_mm": 1e-3})
    moved = with_rail(limited, vertices=replaced(limited.design.rail.vertices, 3, np.array([0, 0, 9000.0])))
    assert status(RULES, "V9b", moved).worst > status(RULES, "V9b", delivery).worst
    assert status(RULES, "V9b", moved).where == "rail vertex 3"


def test_a_frame_that_does_not_close_is_found(ring):
    assert status(RULES, "V10", ring).status == "pass"
    assert 1e-6 < status(RULES, "V10", ring).worst < 0.01
    moved = replaced(ring.design.rail.vertices, 3, np.array([0, 1, 0.5]))
    assert status(RULES, "V10", with_rail(ring, vertices=moved)).status == "fail"


def test_the_gap_of_a_ring_allows_its_last_strip_no_more_than_it_explains(ring):
    worst = status(RULES, "V1", ring)
    assert 1e-6 < worst.worst <= ring.seam[0] < worst.limit < 0.01
    for rule in ("V2", "V5", "V6", "V16"):
        assert status(RULES, rule, ring).status == "pass"
    moved = replaced(ring.mesh.nodes, 7, np.array([0.01, 0.01, -0.01]))
    assert status(RULES, "V1", spoilt(ring, "mesh", nodes=moved)).status == "fail"
