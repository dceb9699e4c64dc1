"""Random designs: planarity, trapezoids, torsion and classes hold whatever the curves are."""

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from isomould.errors import Refused
from isomould.form.mesh import NodeKind
from museum import design


@st.composite
def trims(draw):
    """No plane, or one or two that may meet; near 3 m above the rail's plane, somewhere about its middle."""
    tilt = st.floats(-1, 1)
    planes = draw(st.lists(st.tuples(tilt, tilt, tilt), max_size=2))
    tables = [
        {"plane": {"origin": [6000, 1000, 3000], "normal": [x, y, 1 - abs(x)]}, "keep": [x, y, 1 - abs(x)]}
        if abs(z) > 0.5
        else {"plane": {"z": 2000 + 1000 * z}, "keep": "below"}
        for x, y, z in planes
    ]
    return {"trim": tables, "sill": draw(st.booleans())} if tables else {}


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
    over = {"kind": "arc", "radius": 2500, "start_deg": draw(st.integers(-150, -60)), "end_deg": 70}
    generatrix = draw(st.sampled_from([wave, bow, over] if kind == "edge-offset" else [wave, bow]))
    pole = {"pole": draw(st.sampled_from(["open", "cap"])), "min_pole_angle_deg": 25} if generatrix == over else {}
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
        "surface": {"kind": kind, **pole, **draw(trims())},
        "tolerances": {"min_member": 20},
        "members": {"section": {"kind": "plate", "depth": 120, "thickness": 8}, "min_clear": 1},
        "panels": {"gap": 8, "seat_width": 60, "min_bearing": 5},
    }


def distance_from_planes(mesh):
    """Distances (k,) mm of the panels' corners from planes through their middles, square to their area vectors."""
    points, starts = mesh.nodes[mesh.faces], mesh.face_offsets[:-1]
    away = points - mesh.per_corner(np.add.reduceat(points, starts) / mesh.sizes[:, None])
    normal = np.add.reduceat(np.cross(away, away[mesh.ahead]), starts)
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    return np.abs(np.einsum("ij,ij->i", away, mesh.per_corner(normal)))


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
    assert distance_from_planes(mesh).max() < 1e-6
    whole = np.flatnonzero((mesh.sizes == 4) & (mesh.face_piece == 0))
    corners = mesh.nodes[mesh.faces[mesh.face_offsets[whole, None] + np.arange(4)]]
    sides = corners - np.roll(corners, -1, axis=1)
    unit = sides / np.linalg.norm(sides, axis=2)[..., None]
    assert np.linalg.norm(np.cross(unit[:, 0], unit[:, 2]), axis=1).max(initial=0) < 1e-10
    inner = np.flatnonzero(np.isin(mesh.kind, [NodeKind.INTERIOR, NodeKind.FLAT]))
    if len(inner):
        angles = corner_angles(mesh, kit.nodes.arm_rows[inner], kit.arms)
        assert np.abs(angles[:, 0] + angles[:, 2] - angles[:, 1] - angles[:, 3]).max() < 1e-10
    assert kit.torsion.max() < 1e-9
    regular = np.flatnonzero(mesh.kind == NodeKind.INTERIOR)
    i, j = mesh.node_ij[regular].T
    sign = np.sign(np.round(result.form.surface.rail.turning, 9))[j]
    classes = kit.nodes.classes.of[regular]
    assert len(set(zip(i, sign, classes, strict=True))) == len(set(zip(i, sign, strict=True)))
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
