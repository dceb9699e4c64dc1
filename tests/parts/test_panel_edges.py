"""Panels' edges: the gap in space by hand, deductions, coating."""

import numpy as np
import pytest

import museum
from isomould.errors import Refused
from isomould.form.mesh import Family, grid_mesh
from isomould.parts.panels import make_panels
from isomould.parts.settings import CongruenceSettings, EdgeDeduction, PanelSettings


def roof(dihedral_deg, **asked):
    """Two square metres that meet over one member at a dihedral; the ridge runs along y, its axes stand upright."""
    fall = np.radians((180 - dihedral_deg) / 2)
    x = np.array([-1000 * np.cos(fall), 0.0, 1000 * np.cos(fall)])
    z = np.array([-1000 * np.sin(fall), 0.0, -1000 * np.sin(fall)])
    nodes = np.stack([np.stack([x, np.full(3, y), z], axis=-1) for y in (0.0, 1000.0)])
    axes = np.broadcast_to([0.0, 0.0, 1.0], nodes.shape).copy()
    mesh = grid_mesh(nodes, axes, np.zeros((2, 3), dtype=int), (False, False))
    settings = PanelSettings(seat_width=80, min_bearing=5, **asked)
    return mesh, make_panels(mesh, 200.0, settings, CongruenceSettings()), settings


@pytest.mark.parametrize("dihedral_deg", [150.0, 180.0, 200.0])
def test_the_gap_in_space_at_a_known_dihedral(dihedral_deg):
    """The narrowest level is the panels' undersides where they fall away, their tops where they rise."""
    _, panels, settings = roof(dihedral_deg)
    low = panels.corners.reshape(2, 4, 3)
    high = low + settings.thickness * panels.normals[:, None]
    gaps = [face[1, :, 0].min() - face[0, :, 0].max() for face in (low, high)]
    assert min(gaps) == pytest.approx(settings.gap, abs=1e-6)
    tilt = np.radians(180 - dihedral_deg) / 2
    assert max(gaps) == pytest.approx(settings.gap + 2 * settings.thickness * abs(np.sin(tilt)), abs=1e-6)


def test_deductions_come_off_the_sides_they_name():
    """A flat roof: 2 mm at the ridge, a generatrix; 1 mm along all boundaries; no inner parallel is there."""
    _, plain, _ = roof(180.0)
    mesh, less, _ = roof(180.0, edge_deduction=EdgeDeduction(generatrix=2, parallel=3, boundary=1))
    (before,), (after,) = plain.outlines, less.outlines
    assert sorted(np.ptp(before, axis=0) - np.ptp(after, axis=0)) == pytest.approx([1.0 + 1.0, 1.0 + 2.0], abs=1e-9)
    ridge = np.bincount(plain.edges)[plain.edges] == 2
    assert ridge.sum() == 2
    assert plain.bearing - less.bearing == pytest.approx(np.where(ridge, 2.0, 1.0), abs=1e-9)
    assert mesh.family[plain.edges[ridge]].tolist() == [Family.GENERATRIX] * 2


@pytest.mark.parametrize("table", [{"panels": {"flippable": True}}, {"stock": {"turn_over": True}}])
def test_coated_panels_have_one_way_up(table):
    data = museum.changed(museum.SMALL, panels={"coating": "inside"})
    with pytest.raises(Refused, match="coated panel has only one way up"):
        museum.design(museum.changed(data, **{name: {**data[name], **keys} for name, keys in table.items()}))
