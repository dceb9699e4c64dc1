"""Moulding surfaces: any planar rail, by stations or as drawn (paper §3.1)."""

import numpy as np
import pytest

from isomould.errors import Refused
from isomould.form.polygon import Role
from museum import SMALL, changed, design

ARCH = {"kind": "bspline", "points": [[0, 0], [3000, 4000], [8000, 5000], [12000, 500]]}
BENT = {"kind": "polyline", "points": [[0, 0], [2500, 1800], [5200, 2400], [7800, 1500], [10900, -600]]}


def moulding(**rail):
    base = changed({**SMALL, "surface": {"kind": "moulding"}}, tolerances={"min_member": 50})
    return changed(base, rail={"divide": {}, **rail})


def vertices(result):
    return result.form.rail.vertices


@pytest.mark.parametrize("closed", [False, True])
def test_equal_lengths_along_the_curve(closed):
    """Stations divide the arc: on a circle all chords are equal, and 2 R sin(φ/2)."""
    curve = {"kind": "circle", "radius": 9000}
    curve = curve if closed else {"kind": "arc", "radius": 9000, "start_deg": 20, "end_deg": 140}
    outside = "outer" if closed else [0, 1]
    result = design(moulding(curve=curve, plane="xy", outside=outside, divide={"stations": 16}))
    step = (2 * np.pi if closed else np.radians(120)) / 16
    assert len(vertices(result)) == 16 + (not closed)
    assert result.form.rail.lengths == pytest.approx(2 * 9000 * np.sin(step / 2), abs=1e-6)
    assert result.form.rail.deviation == pytest.approx(9000 * (1 - np.cos(step / 2)), abs=1e-6)


def test_equal_lengths_on_a_curve_of_any_curvature():
    result = design(moulding(curve=ARCH, divide={"stations": 9}))
    curve, fine = result.rail.curve, np.linspace(0, 1, 200_001)
    points = curve.point(np.zeros(fine.size, int), fine)
    along = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    expected = [points[np.argmin(np.abs(along - s))] for s in np.linspace(0, along[-1], 10)]
    assert vertices(result) == pytest.approx(np.array(expected), abs=0.1)
    assert np.ptp(np.abs(result.form.rail.turning[1:-1])) > 0.02
    assert set(result.form.rail.edges.role) == {Role.CHORD}


def test_given_stations():
    """Inner stations count from the oriented curve's start."""
    curve = {"kind": "arc", "radius": 9000, "start_deg": 30, "end_deg": 150}
    result = design(moulding(curve=curve, plane="xy", divide={"stations": ["3 m", "5 m", "12 m"]}))
    polar = np.abs(np.diff(np.arctan2(*vertices(result).T[::-1])))
    assert polar * 9000 == pytest.approx([3000, 2000, 7000, 9000 * np.radians(120) - 12000], abs=1e-6)


@pytest.mark.parametrize("outside", [[0, 1], [0, -1]])
def test_a_polyline_as_drawn(outside):
    result = design(moulding(curve=BENT, outside=outside))
    drawn = np.array(BENT["points"], float)
    assert (vertices(result) == (drawn if outside[1] < 0 else drawn[::-1])).all()
    assert result.form.rail.deviation == 0
    normal = result.form.surface.rail.outward.mean(axis=0)
    assert np.sign(normal[2]) == outside[1]


def test_a_closed_polyline_as_drawn():
    square = [[0, 0], [9000, 0], [9000, 7000], [4000, 9500], [0, 7000]]
    curve = {"kind": "polyline", "points": square, "closed": True}
    result = design(moulding(curve=curve, plane="xy", outside="outer"))
    assert result.kit.mesh.closed == (False, True)
    assert result.form.rail.turning.sum() == pytest.approx(2 * np.pi, abs=1e-12)
    assert vertices(result) == pytest.approx(np.array(square, float), abs=0)


@pytest.mark.parametrize("curve", [BENT, ARCH])
def test_rows_and_strips(curve):
    """Rows have one height, generatrix members of a node line one angle to the rail; nodes differ."""
    result = design(moulding(curve=curve, divide={} if curve is BENT else {"stations": 7}))
    surface = result.form.surface
    V, along = surface.V, surface.rail.directions
    leg = (V[1:] - V[:-1])[:, :-1]
    height = np.linalg.norm(leg - (leg * along).sum(axis=-1)[..., None] * along, axis=-1)
    assert height == pytest.approx(np.tile(surface.profile.lengths[:, None], (1, len(along))), abs=1e-9)
    assert result.kit.torsion.max() < 1e-12
    of = result.kit.nodes.classes.of.reshape(result.kit.mesh.shape)
    assert len(set(of[2, 1:-1])) > 1


@pytest.mark.parametrize(
    ("rail", "words"),
    [
        ({"curve": ARCH}, ["E-CURVE-DIVIDE", "rail.divide", "stations"]),
        ({"curve": ARCH, "divide": {"stations": ["2 m", "1 m"]}}, ["E-CURVE-STATION", "increasing"]),
        ({"curve": ARCH, "divide": {"stations": 300}}, ["E-SURFACE-SHORT", "min_member"]),
    ],
)
def test_refused(rail, words):
    with pytest.raises(Refused) as refusal:
        design(moulding(**rail))
    for word in words:
        assert word in str(refusal.value)


def test_one_angle_is_not_asked_for():
    with pytest.raises(Refused, match="isogonal"):
        design({**moulding(curve=BENT), "surface": {"kind": "isogonal"}})
