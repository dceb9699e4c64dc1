"""The oracles of the mathematics, one by one: expected numbers that were derived without this program."""

import numpy as np
import pytest
from scipy.interpolate import BSpline

from isomould.form.mesh import Family, NodeKind
from isomould.parts.nodes import classify_nodes
from isomould.parts.quality import beam_mismatch
from isomould.parts.settings import CongruenceSettings
from museum import EDGE_OFFSET_VAULT, VAULT, changed, design, dome, sketched, sphere

FINE = {"length": 1e-6, "angle_deg": 1e-6}


def class_counts(result) -> dict[NodeKind, int]:
    kinds, counts = np.unique(result.kit.nodes.kind, return_counts=True)
    return {NodeKind(kind): int(count) for kind, count in zip(kinds, counts, strict=True)}


class TestOracleA:
    """Table 3 of the paper: faces of edge offset spheres (its label 160° is 150°)."""

    @pytest.mark.parametrize(
        ("angle", "band", "faces"),
        [
            (5, 15, 504),
            (5, 30, 936),
            (5, 60, 2232),
            (5, 75, 3384),
            (15, 15, 72),
            (15, 30, 120),
            (15, 60, 264),
        ],
    )
    def test_face_counts(self, angle, band, faces):
        assert len(design(sphere(angle, band)).kit.mesh.face_ij) == faces


class TestOracleB:
    """A Koebe mesh: every edge touches the unit sphere."""

    @pytest.mark.parametrize("angle", [5, 15])
    def test_edges_touch_the_sphere(self, angle):
        surface = design(sphere(angle, 75)).form.surface
        rail, profile = surface.rail, surface.profile
        field = np.multiply.outer(profile.a, rail.A) + np.multiply.outer(profile.b, rail.C)
        for start, end in ((field[:-1], field[1:]), (field, np.roll(field, -1, axis=1))):
            edge = end - start
            apart = np.linalg.norm(np.cross(start, edge), axis=2) / np.linalg.norm(edge, axis=2)
            assert apart == pytest.approx(1.0, abs=1e-12)


class TestOracleC:
    """The vault of Fig. 6 with flat nodes at its inflections."""

    @pytest.fixture(scope="class")
    @classmethod
    def vault(cls):
        return design(VAULT)

    def test_nodes(self, vault):
        assert vault.kit.mesh.shape == (33, 20)

    @pytest.mark.parametrize("tolerance", [{}, FINE])
    def test_classes(self, tolerance):
        counts = class_counts(design({**VAULT, "tolerances": tolerance}))
        assert counts[NodeKind.INTERIOR] == 8
        assert counts[NodeKind.FLAT] == 1

    def test_mismatch(self, vault):
        inner = vault.kit.mesh.kind == NodeKind.INTERIOR
        assert beam_mismatch(vault.kit.arms, 200.0)[inner].max() == pytest.approx(0.121, abs=5e-4)

    def test_without_flat_nodes_34_arches_and_8_classes(self):
        result = design(changed(VAULT, generatrix={"divide": {"per_arc": 8}, "flat_nodes": False}))
        assert result.kit.mesh.shape == (34, 20)
        assert class_counts(result)[NodeKind.INTERIOR] == 8


class TestOracleD:
    """Slopes of an edge offset mesh: beams of one height meet at every node."""

    @pytest.mark.parametrize("data", [EDGE_OFFSET_VAULT, sphere(5, 60), sphere(15, 30)])
    @pytest.mark.parametrize("depth", [60.0, 200.0])
    def test_no_mismatch(self, data, depth):
        kit = design(data).kit
        assert beam_mismatch(kit.arms, depth).max() < 1e-9

    def test_flat_nodes_of_the_generatrix_are_exact_too(self):
        data = changed(EDGE_OFFSET_VAULT, generatrix={"flat_nodes": False})
        assert design(data).kit.mismatch.max() < 1e-9

    @pytest.mark.parametrize("phase", ["centre", "node", {"slope_deg": 4.2}])
    def test_every_phase_is_exact(self, phase):
        data = changed(EDGE_OFFSET_VAULT, generatrix={"divide": {"phase": phase}})
        assert design(data).kit.mismatch.max() < 1e-9

    def test_square_ends_cost_what_they_should(self):
        """The ends of an open rail turn by half: 0.3 to 0.55 mm at 12° and 200 mm."""
        rail = {"ends": "square", "divide": {"angle_deg": 12}}
        mismatch = design(changed(EDGE_OFFSET_VAULT, rail=rail)).kit.mismatch.max()
        assert 0.1 < mismatch < 0.6


def signatures(result) -> set[tuple]:
    """What a node is made by: angles to 1e-9 rad, without marks."""
    return {
        (*np.round(arms.gap, 9), *np.round(arms.elevation, 9) + 0.0, *arms.family, int(kind))
        for arms, kind in zip(result.kit.nodes.arms, result.kit.nodes.kind, strict=True)
    }


class TestOracleE:
    """Mesh parallelism (paper §3.5): one kit of nodes, several shapes."""

    def test_two_rails_with_one_angle(self):
        one = changed(VAULT, rail={"divide": {"angle_deg": 6}})
        other = changed(one, rail={"curve": {"kind": "arc", "span": "20 m", "rise": "7.5 m"}})
        inner = [{s for s in signatures(design(data)) if s[-1] == NodeKind.INTERIOR} for data in (one, other)]
        assert inner[0] == inner[1]
        assert len(inner[0]) == 8

    def test_one_rail_and_two_generatrices_with_the_same_slopes(self):
        data = sphere(15, 30)
        ellipse = {"kind": "ellipse", "semi_axes": [8000, 12000], "start_deg": -40.8934, "end_deg": 40.8934}
        other = changed(data, generatrix={"curve": ellipse, "origin": [-8000, 0]})
        one, two = design(data), design(other)
        assert one.kit.mesh.shape == two.kit.mesh.shape
        assert signatures(one) == signatures(two)


class TestOracleF:
    """Domes (Table 4): the panel at the apex is as long for its width as the principal radii are."""

    points = np.array([(-9, -4.5), (-8.4, 0.2), (-4, 3.9), (4, 3.9), (8.4, 0.2), (9, -4.5)])

    def apex_radius(self) -> float:
        """Radius of curvature (m) of the clamped cubic B-spline at its apex, by scipy."""
        curve = BSpline(np.array([0, 0, 0, 0, 1, 2, 3, 3, 3, 3]), self.points, 3)
        first, second = curve(1.5, 1), curve(1.5, 2)
        return float(np.linalg.norm(first) ** 3 / abs(first[0] * second[1] - first[1] * second[0]))

    def aspect(self, radius: float, nodes: int) -> float:
        """Larger over smaller mean of opposite edges of the panel at the apex."""
        surface = sketched(dome(radius, nodes, scale=5.0)).form.surface
        i, j = (n // 2 - 1 for n in surface.V.shape[:2])
        a, b, c, d = surface.V[i, j], surface.V[i, j + 1], surface.V[i + 1, j + 1], surface.V[i + 1, j]
        mean = [np.linalg.norm(p - q) + np.linalg.norm(r - s) for p, q, r, s in ((a, b, c, d), (b, c, d, a))]
        return float(max(mean) / min(mean))

    @pytest.mark.parametrize("radius", [2.9, 5.2, 9.3])
    def test_aspect_at_the_apex(self, radius):
        ratio = self.apex_radius() / radius
        off = [abs(self.aspect(radius, nodes) / ratio - 1) for nodes in (48, 98)]
        assert off[0] < 0.02
        assert off[1] < off[0]


class TestOracleG:
    """A circular rail gives a surface of revolution."""

    @pytest.fixture(scope="class")
    @classmethod
    def revolution(cls):
        data = sphere(15, 30)
        curve = {"kind": "spline", "points": [[0, 0], [900, 2500], [600, 5000], [-400, 7000]]}
        return design(
            changed(
                data,
                generatrix={"curve": curve, "origin": [0, 0], "divide": {"nodes": 6}},
                surface={"kind": "isogonal"},
            )
        )

    def test_one_node_class_per_parallel(self, revolution):
        kit = revolution.kit
        of = kit.nodes.classes.of.reshape(kit.mesh.shape)
        assert (of == of[:, :1]).all()
        assert len(kit.nodes.marks) == kit.mesh.shape[0]

    def test_one_panel_class_per_row(self, revolution):
        panels = revolution.kit.panels
        rows = panels.classes.of.reshape(-1, revolution.kit.mesh.shape[1])
        assert (rows == rows[:, :1]).all()


def parts(result) -> list[tuple]:
    """Marks, quantities, outlines and locations: everything a shop would see."""
    kit = result.kit
    return [
        kit.nodes.marks,
        tuple(kit.nodes.classes.of),
        tuple(kit.members.classes.of),
        tuple(kit.panels.classes.of),
        kit.panels.locations,
    ]


class TestOracleH:
    """What the design is drawn like must not matter."""

    points = ((0.0, 0.0), (3.0, 2.6), (8.0, 3.1), (12.0, 0.5))

    def bspline(self, points, **more):
        return {"kind": "bspline", "units": "m", "degree": 3, "points": [list(p) for p in points], **more}

    def assert_same(self, one, other, *, shapes: float = 1e-6):
        first, second = design(one), design(other)
        assert parts(first) == parts(second)
        for a, b in zip(first.kit.panels.outlines, second.kit.panels.outlines, strict=True):
            assert a == pytest.approx(b, abs=0.0011)
        lengths = [[shape.system_length for shape in each.kit.members.shapes] for each in (first, second)]
        assert lengths[0] == pytest.approx(lengths[1], abs=shapes)

    def test_reversed_drawing_direction(self):
        one = changed(VAULT, rail={"curve": self.bspline(self.points)})
        other = changed(VAULT, rail={"curve": self.bspline(self.points[::-1])})
        self.assert_same(one, other)

    def test_degree_elevation(self):
        p = np.array(self.points)
        raised = [p[0], (p[0] + 3 * p[1]) / 4, (p[1] + p[2]) / 2, (3 * p[2] + p[3]) / 4, p[3]]
        other = self.bspline([tuple(map(float, q)) for q in raised]) | {"degree": 4}
        self.assert_same(
            changed(VAULT, rail={"curve": self.bspline(self.points)}), changed(VAULT, rail={"curve": other})
        )

    def test_knot_refinement(self):
        p = np.array(self.points)
        half = [p[0], (p[0] + p[1]) / 2, (p[1] + p[2]) / 2, (p[2] + p[3]) / 2, p[3]]
        other = self.bspline([tuple(map(float, q)) for q in half], knots=[0, 0, 0, 0, 0.5, 1, 1, 1, 1])
        self.assert_same(
            changed(VAULT, rail={"curve": self.bspline(self.points)}), changed(VAULT, rail={"curve": other})
        )

    def test_another_start_point_of_a_closed_curve(self):
        loop = [[6, 0], [4, 4], [0, 5], [-5, 3], [-6, -1], [-2, -5], [3, -4]]
        data = sphere(15, 30)
        rails = [
            changed(data, rail={"curve": {"kind": "bspline", "units": "m", "points": pts, "closed": True}})
            for pts in (loop, loop[3:] + loop[:3], loop[::-1])
        ]
        self.assert_same(rails[0], rails[1])
        self.assert_same(rails[0], rails[2])

    def test_rigid_motion(self):
        plane = {"origin": ["120 m", "-37 m", "4 m"], "x_axis": [0.6, 0.8, 0], "y_axis": [0, 0, 1]}
        self.assert_same(VAULT, changed(VAULT, rail={"plane": plane}))

    def test_scaling(self):
        double = changed(
            VAULT,
            rail={"curve": {"kind": "parabola", "span": "40 m", "rise": "15 m"}},
            generatrix={"curve": {"kind": "sine", "amplitude": "2 m", "wavelength": "24 m", "waves": 2}},
        )
        one, two = design(VAULT), design(double)
        assert one.kit.nodes.marks == two.kit.nodes.marks
        assert one.kit.mesh.nodes * 2 == pytest.approx(two.kit.mesh.nodes, abs=1e-6)


class TestStadium:
    """Two straight sides and two half circles: tangents along the straights belong to them, not to the arcs' ends."""

    def rail(self, points, **divide):
        return changed(
            VAULT,
            rail={
                "curve": {"kind": "polyline", "units": "m", "points": points, "bulges": [0, 1, 0, 1], "closed": True},
                "plane": "xy",
                "outside": "outer",
                "divide": divide,
            },
            generatrix={"curve": {"kind": "arc", "span": "6 m", "rise": "1 m"}, "divide": {"nodes": 5}},
        )

    @pytest.mark.parametrize("nodes", [24, 40])
    def test_every_side_is_one_edge(self, nodes):
        polygon = design(self.rail([[-10, -8], [10, -8], [10, 8], [-10, 8]], nodes=nodes)).form.rail
        lengths = np.sort(np.linalg.norm(polygon.vertices - np.roll(polygon.vertices, 1, axis=0), axis=1))
        assert len(lengths) == nodes
        short = 2 * 8000 * np.tan(np.pi / nodes)
        assert lengths[:-2] == pytest.approx(short, abs=1e-6)
        assert lengths[-2:] == pytest.approx(20_000 + short, abs=1e-6)

    def test_an_upright_stadium(self):
        polygon = design(self.rail([[8, -10], [8, 10], [-8, 10], [-8, -10]], nodes=24, first_deg=90)).form.rail
        assert polygon.deviation == pytest.approx(8000 * (1 / np.cos(np.pi / 24) - 1), abs=1e-6)


def test_both_tolerances_give_the_same_classes_on_every_template_shape():
    """Exactness: rounding noise never makes a class."""
    for data in (VAULT, EDGE_OFFSET_VAULT, sphere(15, 60)):
        coarse = design(data).kit
        fine = classify_nodes(coarse.mesh, coarse.arms, CongruenceSettings(**FINE))
        assert len(fine.marks) == len(coarse.nodes.marks)


def test_members_of_a_row_are_equal_between_inner_nodes():
    """Between any two parallels all generatrix members are the same part (paper §3.4)."""
    kit = design(VAULT).kit
    generatrix = kit.mesh.family == Family.GENERATRIX
    inner = generatrix & (kit.mesh.edge_ij[:, 1] > 0) & (kit.mesh.edge_ij[:, 1] < kit.mesh.shape[1] - 1)
    of = kit.members.classes.of[inner].reshape(kit.mesh.shape[0] - 1, -1)
    assert (of == of[:, :1]).all()
