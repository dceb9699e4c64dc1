"""Unrolled strips keep every length and area; along generatrices they stay nearly straight."""

import numpy as np
import pytest
import shapely

from isomould.errors import Refused
from isomould.parts.outline import area
from isomould.parts.strips import unroll_strips
from museum import SMALL, VAULT, changed, design, sketched, sphere, template


def face_areas(mesh):
    corners = mesh.nodes[mesh.table(mesh.faces)]
    diagonals = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
    return np.linalg.norm(np.cross(*diagonals), axis=1) / 2


@pytest.mark.parametrize("data", [VAULT, sphere(15, 30)])
@pytest.mark.parametrize("along", ["generatrix", "parallel"])
def test_areas_and_fold_lengths_survive(data, along):
    mesh = design(data).kit.mesh
    strips = unroll_strips(mesh, along)
    assert sum(area(strip.outline) for strip in strips) == pytest.approx(face_areas(mesh).sum(), rel=1e-12)
    axis = 1 if along == "generatrix" else 0
    edges = mesh.nodes[mesh.edges[:, 1]] - mesh.nodes[mesh.edges[:, 0]]
    lengths = np.linalg.norm(edges, axis=1)
    crossing = lengths[(mesh.family == (1 if along == "generatrix" else 0))]
    ij = mesh.edge_ij[mesh.family == (1 if along == "generatrix" else 0)]
    for strip in strips:
        expected = crossing[ij[:, axis] == strip.number]
        found = np.linalg.norm(strip.left - strip.right, axis=1)[: len(expected)]
        assert found == pytest.approx(expected, abs=1e-8)


def test_strips_along_generatrices_are_straighter():
    """Generatrices are geodesics: their strips hardly bend, strips along parallels do (paper §3.1)."""
    mesh = design(VAULT).kit.mesh
    ribs, rings = (unroll_strips(mesh, along) for along in ("generatrix", "parallel"))
    assert max(strip.sagitta for strip in ribs[1:-1]) < 1e-6  # all panels are isosceles
    assert max(strip.sagitta for strip in ribs) < 50  # the square ends cut theirs in half
    assert max(strip.sagitta for strip in rings) > 1000


def test_trimmed_strips_are_refused():
    data = changed(SMALL, surface={"trim": [{"plane": {"z": "0.9 m"}, "keep": "above"}]})
    with pytest.raises(Refused, match=r"deliver\.strips"):
        unroll_strips(design(data).kit.mesh, "generatrix")


def test_a_ring_that_lies_flat_is_refused():
    """The row at the crown of a torus: its end would lie on its beginning."""
    mesh = sketched(template("torus")).mesh
    assert len(unroll_strips(mesh, "generatrix")) == 24
    with pytest.raises(Refused, match=r"strip SP-15, which lies on itself .* \"parallel\" out of deliver\.strips"):
        unroll_strips(mesh, "parallel")


def test_a_strip_is_counter_clockwise_and_simple():
    for strip in unroll_strips(design(VAULT).kit.mesh, "parallel"):
        assert shapely.Polygon(strip.outline).is_valid
        assert area(strip.outline) > 0
        assert len(strip.folds) == 18
