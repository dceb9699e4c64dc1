"""Measures of meshes: against meshes whose values are known, and against meshes that were spoilt."""

from dataclasses import replace

import numpy as np
import pytest

from isomould.form.mesh import NodeKind, grid_mesh
from isomould.measure.faces import aspect_ratios, circularity, face_classes, planarity
from isomould.measure.joints import cone_angles, conical_residual, edge_classes, edge_twists, horizontal_levels
from isomould.measure.kinship import is_one_kit, shared_node_classes
from isomould.measure.smooth import Smooth, radii_ratios, surface_distances
from isomould.parts.arms import find_arms
from isomould.parts.settings import CongruenceSettings
from museum import VAULT, changed, design, sphere

FINE = CongruenceSettings(length=1e-6, angle_deg=1e-6)


def flat_grid(across=(3.0, 2.0), count=(3, 4)):
    y, x = np.meshgrid(np.arange(count[0]) * across[1], np.arange(count[1]) * across[0], indexing="ij")
    nodes = np.stack([x, y, np.zeros_like(x)], axis=-1)
    axes = np.broadcast_to([0.0, 0.0, 1.0], nodes.shape).copy()
    return grid_mesh(nodes, axes, np.full(count, int(NodeKind.INTERIOR)), (False, False))


def moved(mesh, node, step):
    nodes = mesh.nodes.copy()
    nodes[node] += step
    return replace(mesh, nodes=nodes)


@pytest.fixture(scope="module")
def ball():
    return design(sphere(15, 60))


class TestFaces:
    def test_a_flat_grid_of_rectangles(self):
        mesh = flat_grid()
        assert planarity(mesh).max() == pytest.approx(0, abs=1e-12)
        assert circularity(mesh).max() == pytest.approx(0, abs=1e-12)
        assert aspect_ratios(mesh) == pytest.approx(1.5)
        assert face_classes(mesh, 1e-6).max() == 0

    def test_a_lifted_corner_is_seen(self):
        mesh = moved(flat_grid((2.0, 2.0), (2, 2)), 0, [0, 0, 1.0])
        assert planarity(mesh)[0] == pytest.approx(0.5, rel=0.1)
        assert circularity(mesh)[0] > 0

    def test_a_moved_corner_makes_classes(self):
        assert face_classes(moved(flat_grid(), 5, [0.1, 0, 0]), 1e-6).max() > 0
        assert face_classes(moved(flat_grid(), 5, [0.1, 0, 0]), 0.5).max() == 0

    def test_mirrored_panels_are_equal_only_where_flippable(self):
        mesh = moved(flat_grid((2.0, 2.0), (2, 3)), [0, 2], [[0.3, 0, 0], [-0.3, 0, 0]])
        assert face_classes(mesh, 1e-6).tolist() == [0, 1]
        assert face_classes(mesh, 1e-6, flippable=True).tolist() == [0, 0]


class TestJoints:
    def test_moulding_meshes_are_conical(self):
        kit = design(VAULT).kit
        assert np.nanmax(conical_residual(kit.mesh, kit.arms)) < 1e-12

    def test_a_spoilt_mesh_is_not_conical(self):
        mesh = moved(design(VAULT).kit.mesh, 5 * 20 + 5, [0, 0, 30.0])
        assert np.nanmax(conical_residual(mesh, find_arms(mesh))) > 1e-3

    def test_members_of_an_edge_offset_mesh_lie_on_cones(self, ball):
        mean, spread = cone_angles(ball.kit.arms)
        assert spread.max() < 1e-12
        assert np.all((mean < np.pi / 2) & (mean > np.pi / 2 - 0.2))

    def test_twists_are_none_without_torsion_and_measured_with_it(self):
        mesh = flat_grid()
        assert np.abs(edge_twists(mesh)).max() < 1e-12
        axes = mesh.axes.copy()
        axes[0] = [0, np.sin(0.1), np.cos(0.1)]
        twist = edge_twists(replace(mesh, axes=axes))
        along_x = np.flatnonzero((mesh.edges == [0, 1]).all(axis=1))
        assert np.abs(twist[along_x]) == pytest.approx(0.1)

    def test_member_classes_of_a_grid(self):
        mesh = flat_grid()
        assert len(edge_classes(mesh, find_arms(mesh), FINE).representative) == 2

    def test_levels(self, ball):
        levels = horizontal_levels(ball.kit.mesh)
        assert np.isfinite(levels).all()
        assert np.all(np.diff(levels) > 0)
        assert not np.isfinite(horizontal_levels(design(VAULT).kit.mesh)).any()


class TestSmooth:
    def test_distances_from_a_sphere(self, ball):
        smooth = Smooth(ball.rail.curve, ball.generatrix, ball.rail.plane)
        points = np.array([[10_100.0, 0, 0], [3000.0, 4000.0, 0], [6000.0, 0, 8000.0], [0, 5000.0, 5000.0]])
        expected = np.abs(np.linalg.norm(points, axis=1) - 10_000)
        assert surface_distances(smooth, points) == pytest.approx(expected, abs=1e-6)

    def test_points_of_the_surface_lie_on_it(self):
        vault = design(VAULT)
        smooth = Smooth(vault.rail.curve, vault.generatrix, vault.rail.plane)
        places = np.zeros(7, dtype=int), np.linspace(0.05, 0.95, 7)
        assert surface_distances(smooth, smooth.point(places, places).reshape(-1, 3)).max() < 1e-6


DOME = changed(
    sphere(15, 30),
    rail={
        "curve": {"kind": "ellipse", "semi_axes": [36_000, 24_000], "start_deg": 20, "end_deg": 160},
        "plane": "xz",
        "outside": [0, 1],
        "divide": {"nodes": 50},
    },
    generatrix={"curve": {"kind": "arc", "radius": 27_000, "start_deg": -35, "end_deg": 35}, "origin": [-27_000, 0]},
    members={"min_clear": 1},
)
"""A dome of 51 edges of the rail (paper §4.4): an elliptic arch, swept along a circular one."""


def test_panels_are_as_long_as_the_radii_of_curvature_say():
    """Oracle F, Table 4: below 2 % from 50 subdivisions, at the apex and (in the median) everywhere."""
    dome = design(DOME)
    ratio = radii_ratios(Smooth(dome.rail.curve, dome.generatrix, dome.rail.plane), dome.form)
    row, strip = np.array(ratio.shape) // 2
    aspect = aspect_ratios(dome.kit.mesh).reshape(ratio.shape)
    assert ratio[row, strip] == pytest.approx(54_000 / 27_000, rel=0.01)
    assert aspect[row, strip] == pytest.approx(ratio[row, strip], rel=0.02)
    assert np.median(np.abs(aspect / ratio - 1)[1:-1, 1:-1]) < 0.02


class TestKinship:
    """Oracle E: mesh parallelism makes one kit of nodes for several shapes (paper §3.5)."""

    one = changed(VAULT, rail={"divide": {"angle_deg": 6}})

    def meshes(self, *data):
        return [design(each).kit.mesh for each in data]

    def test_two_rails_with_one_angle(self):
        other = changed(self.one, rail={"curve": {"kind": "arc", "span": "20 m", "rise": "7.5 m"}})
        meshes = self.meshes(self.one, other)
        assert is_one_kit(meshes, FINE, interior=True)
        counts, kind = shared_node_classes(meshes, FINE)
        assert np.count_nonzero(kind == NodeKind.INTERIOR) == 8
        assert counts.sum(axis=0).tolist() == [len(mesh.nodes) for mesh in meshes]

    def test_two_generatrices_with_the_same_slopes(self):
        data = sphere(15, 30)
        ellipse = {"kind": "ellipse", "semi_axes": [8000, 12000], "start_deg": -40.8934, "end_deg": 40.8934}
        assert is_one_kit(self.meshes(data, changed(data, generatrix={"curve": ellipse, "origin": [-8000, 0]})), FINE)

    def test_another_angle_is_another_kit(self):
        other = changed(self.one, rail={"divide": {"angle_deg": 6.5}})
        assert not is_one_kit(self.meshes(self.one, other), FINE, interior=True)
