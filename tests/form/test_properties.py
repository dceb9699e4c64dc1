"""Random designs: planarity, trapezoids, torsion and classes hold whatever the curves are."""

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from isomould.errors import Refused
from isomould.form.mesh import NodeKind
from museum import design


@st.composite
def projects(draw):
    """An arch or loop, a generatrix, a kind: some of them are refused, and that is fine."""
    kind = draw(st.sampled_from(["isogonal", "moulding", "edge-offset"]))
    closed = draw(st.booleans())
    rise = draw(st.integers(1500, 7000))
    skew = draw(st.integers(-1500, 1500))
    arch = {"kind": "bspline", "points": [[0, 0], [4000 + skew, rise], [9000, rise + skew], [13000, 0]]}
    loop = {"kind": "ellipse", "semi_axes": [14000, 9000 + skew], "rotation_deg": draw(st.integers(0, 90))}
    nodes = draw(st.integers(7, 24))
    wave = {"kind": "sine", "amplitude": draw(st.integers(100, 500)), "wavelength": 7000, "waves": 1}
    bow = {"kind": "arc", "span": 6000, "rise": draw(st.integers(300, 1500))}
    generatrix = draw(st.sampled_from([wave, bow]))
    divide = (
        {"phase": draw(st.sampled_from(["centre", "node", "fit"]))}
        if kind == "edge-offset"
        else {"nodes": draw(st.integers(3, 9))}
    )
    return {
        "schema": 1,
        "project": {"name": "Random"},
        "rail": {
            "curve": loop if closed else arch,
            "outside": "outer" if closed else [0, 1],
            "divide": {"nodes": nodes},
        },
        "generatrix": {
            "curve": generatrix,
            "axes": "zd",
            "divide": divide,
            "flat_nodes": draw(st.booleans()),
            "inflections": "nearest" if kind == "edge-offset" else draw(st.sampled_from(["nearest", "residual"])),
        },
        "surface": {"kind": kind},
        "tolerances": {"min_member": 20},
        "members": {"section": {"kind": "plate", "depth": 120, "thickness": 8}, "min_clear": 1},
        "panels": {"gap": 8, "seat_width": 60, "min_bearing": 5},
    }


def distance_from_plane(corners):
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    return np.abs(np.einsum("ij,ij->i", corners[:, 3] - corners[:, 0], normal))


def corner_angles(mesh, node_arms, arms):
    """Angles between consecutive edges around nodes of four arms (paper, equation 1)."""
    direction = arms.direction[node_arms]
    following = np.roll(direction, -1, axis=1)
    sine = np.linalg.norm(np.cross(direction, following), axis=2)
    return np.arctan2(sine, np.einsum("ijk,ijk->ij", direction, following))


def check_promises(data):
    try:
        result = design(data)
    except Refused:
        assume(False)
        return
    kit, mesh = result.kit, result.kit.mesh
    corners = mesh.nodes[mesh.table(mesh.faces)]
    assert distance_from_plane(corners).max() < 1e-6
    sides = corners - np.roll(corners, -1, axis=1)
    unit = sides / np.linalg.norm(sides, axis=2)[..., None]
    assert np.linalg.norm(np.cross(unit[:, 0], unit[:, 2]), axis=1).max() < 1e-10
    inner = np.flatnonzero(mesh.kind != NodeKind.BOUNDARY)
    angles = corner_angles(mesh, kit.nodes.arm_rows[inner], kit.arms)
    assert np.abs(angles[:, 0] + angles[:, 2] - angles[:, 1] - angles[:, 3]).max(initial=0) < 1e-10
    assert kit.torsion.max() < 1e-9
    of = kit.nodes.classes.of.reshape(mesh.shape)
    regular = (mesh.kind == NodeKind.INTERIOR).reshape(mesh.shape)
    turning = np.round(result.form.surface.rail.turning, 9)
    for row, keep in zip(of, regular, strict=True):
        for sign in (-1, 1):
            assert len(set(row[keep & (np.sign(turning) == sign)])) <= 1
    if data["surface"]["kind"] == "edge-offset":
        assert kit.mismatch.max() < 1e-9


PATIENT = settings(deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much])


@settings(PATIENT, max_examples=300)
@given(projects())
def test_every_design_keeps_what_the_paper_promises(data):
    check_promises(data)


@pytest.mark.long
@settings(PATIENT, max_examples=2000)
@given(projects())
def test_two_thousand_designs_keep_them_too(data):
    check_promises(data)
