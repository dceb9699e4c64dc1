"""Isogonal subdivision beyond one angle on one arc: several angles, straight parts, ways at inflections, loops."""

import numpy as np
import pytest
from scipy.optimize import minimize

import isomould
from isomould.curves.construction import build_curve
from isomould.curves.settings import BsplineSettings, PolylineSettings
from isomould.curves.turning import arcs, spans
from isomould.errors import Refused
from isomould.form.division import Request, divide_curve
from isomould.form.fitting import fit_curve
from isomould.form.orientation import orient_rail
from isomould.form.polygon import FLAT, Role
from isomould.form.settings import FormLimits, RailDivide, Treatment
from isomould.parts.quality import beam_mismatch
from museum import BARE, EDGE_OFFSET_VAULT, MONGE, SMALL, TEMPLATES, VAULT, changed, design, sphere, write_project

BEAN = [[10, 0], [8, 6], [1, 7], [-8, 6], [-10, 0], [-6, -4], [0, -1], [7, -4]]
TWIN = [[10, 0], [8, 6], [0, 7], [-8, 6], [-10, 0], [-6, -4], [0, -1], [6, -4]]
"""A bean with a symmetry: its outermost tangent of direction 0 touches it twice."""
WAVE = {"kind": "bspline", "units": "m", "points": [[0, 0], [3, 2], [6, -2], [9, 2.4], [12, 0]]}
BULGE = float(np.tan(np.pi / 8))
LINE_ARC_LINE = {
    "kind": "polyline",
    "points": [[0, 0], [6000, 0], [11000, 5000], [11000, 9000]],
    "bulges": [0, BULGE, 0],
}
RANGES = [{"until": "8 m", "angle_deg": 6}, {"until": "16 m", "angle_deg": 4}, {"angle_deg": 8}]


def closed(points) -> BsplineSettings:
    return BsplineSettings(kind="bspline", units="m", closed=True, points=[tuple(map(float, p)) for p in points])


def loop(settings, divide, **treatment):
    """Divide a closed rail: its curve, outside to the right, and its polygon."""
    request = Request("rail", RailDivide(**divide), Treatment(**treatment), FormLimits())
    curve, _ = build_curve(fit_curve(settings, request)[0], TEMPLATES)
    rail = orient_rail(curve, "outer")
    return rail, divide_curve(rail, request)


def bend(**rail):
    """A rail of a straight part, a quarter circle and a straight part."""
    return {**VAULT, "rail": {"curve": LINE_ARC_LINE, "plane": "xy", "outside": [1, -1], **rail}}


def turned(polygon) -> np.ndarray:
    """Turning in degrees of the nodes that turn, in order."""
    turning = np.degrees(polygon.turning[np.isfinite(polygon.turning)])
    return turning[np.abs(turning) > 1e-6]


def assert_tangent(curve, polygon):
    """Every edge passes through its contact, and runs along the curve there unless it is a pivot."""
    edges = polygon.edges
    along = np.stack([np.cos(edges.direction), np.sin(edges.direction)], axis=1)
    away = edges.contact - polygon.vertices[: len(along)]
    assert np.abs(along[:, 0] * away[:, 1] - along[:, 1] * away[:, 0]).max() < 1e-6
    tangent = curve.derivative(edges.piece, edges.parameter)
    tangent /= np.linalg.norm(tangent, axis=1)[:, None]
    off = np.abs(along[:, 0] * tangent[:, 1] - along[:, 1] * tangent[:, 0])
    assert off[[role is Role.TANGENT for role in edges.role]].max() < 1e-9
    return off


class TestSeveralAngles:
    @pytest.mark.parametrize("table", ["rail", "generatrix"])
    def test_every_node_turns_by_one_of_them(self, table):
        result = design(changed(VAULT, **{table: {"divide": {"angles": RANGES}}}))
        polygon = getattr(result.form, table)
        curve = result.rail.curve if table == "rail" else result.generatrix
        assert_tangent(curve, polygon)
        sizes = np.abs(turned(polygon))
        assert np.abs(sizes[:, None] - [4, 6, 8]).min(axis=1).max() < 1e-9

    def test_nodes_change_at_the_borders(self):
        """The lengths of the legs of a circle say where: 10 m by 6° and the rest by 9°."""
        rail = {"curve": {"kind": "arc", "radius": 10_000, "start_deg": 0, "end_deg": 180}}
        rail |= {"divide": {"angles": [{"until": 10_000 * np.pi / 2, "angle_deg": 6}, {"angle_deg": 9}]}}
        polygon = design(changed(VAULT, rail=rail)).form.rail
        assert turned(polygon) == pytest.approx([6] * 15 + [9] * 10)

    def test_one_class_per_angle(self):
        """On a straight generatrix's row all nodes of one |α| are one class."""
        data = changed(VAULT, rail={"divide": {"angles": RANGES}})
        kit = (result := design(data)).kit
        of = kit.nodes.classes.of.reshape(kit.mesh.shape)
        sizes = np.round(np.abs(result.form.surface.rail.turning), 9)[1:-1]
        for row in of[1:-1, 1:-1]:
            assert all(len(set(row[sizes == size])) == 1 for size in set(sizes))

    def test_beams_of_equal_angle_still_meet_as_well(self):
        kit = design(changed(VAULT, rail={"divide": {"angles": RANGES}})).kit
        assert beam_mismatch(kit.arms, 200.0).max() < 1.0


class TestStraightParts:
    def test_one_edge_each_that_lies_on_the_line(self):
        rail = design(bend(divide={"nodes": 8})).form.rail
        assert [role for role in rail.edges.role if role is not Role.TANGENT] == [Role.STRAIGHT] * 2
        leg = 5000 * np.tan(np.radians(11.25) / 2)
        assert rail.lengths[[0, -1]] == pytest.approx([6000 + leg, 4000 + leg], abs=1e-6)
        assert turned(rail) == pytest.approx([11.25] * 8)

    def test_nearest_keeps_the_angle_and_reports_the_deviation(self):
        result = design(bend(divide={"angle_deg": 7}))
        assert turned(result.form.rail) == pytest.approx([7] * 13)
        assert result.form.rail.deviation == pytest.approx(34.9, abs=0.1)

    @pytest.mark.parametrize("divide", [{"nodes": 8}, {"angle_deg": 7}])
    def test_max_edge_divides_them_equally(self, divide):
        plain, fine = (design(bend(divide=divide, **more)) for more in ({}, {"max_edge": 1500}))
        flat = np.abs(np.nan_to_num(fine.form.rail.turning, nan=1.0)) <= FLAT
        assert flat.sum() == sum(np.ceil(plain.form.rail.lengths[[0, -1]] / 1500) - 1)
        straight = [role is Role.STRAIGHT for role in fine.form.rail.edges.role]
        assert fine.form.rail.lengths[straight].max() <= 1500
        assert len(set(fine.form.rail.lengths[straight].round(6))) == 2
        assert turned(fine.form.rail) == pytest.approx(turned(plain.form.rail))
        assert fine.form.rail.deviation <= plain.form.rail.deviation + 1e-9

    def test_flat_nodes_are_a_class_of_their_own(self):
        kit = (result := design(bend(divide={"nodes": 8}, max_edge=1500))).kit
        of = kit.nodes.classes.of.reshape(kit.mesh.shape)
        flat = result.form.surface.rail.flat
        for row in of[1:-1]:
            assert len(set(row[flat])) == 1
            assert not set(row[flat]) & set(row[~flat])

    def test_long_edges_of_curved_parts_are_noted(self):
        notes = [str(note) for note in design(changed(VAULT, rail={"max_edge": 1000})).notes]
        assert any("W-CURVE-LONG rail.max_edge" in note and "1000 mm" in note for note in notes)

    def test_stadium(self):
        points = ((0, 0), (8000, 0), (8000, 6000), (0, 6000))
        settings = PolylineSettings(kind="polyline", points=points, bulges=(0, 1, 0, 1), closed=True)
        for way in ("nearest", "residual"):
            _, rail = loop(settings, {"nodes": 24}, inflections=way, max_edge=2000)
            assert np.abs(turned(rail)) == pytest.approx([15] * 24)
            assert (np.abs(rail.turning) <= FLAT).sum() == 8
            assert rail.deviation == pytest.approx(3000 / np.cos(np.radians(7.5)) - 3000, abs=1e-6)

    def test_edge_offset_meshes_stay_exact(self):
        end = [6000 * (np.sqrt(0.5) - 1), 4000 + 6000 * np.sqrt(0.5)]
        curve = {"kind": "polyline", "points": [[0, 0], [0, 4000], end], "bulges": [0, float(np.tan(np.pi / 16))]}
        generatrix = {"curve": curve, "outside": [1, 0], "axes": "dz", "origin": ["6 m", 0], "max_edge": 1500}
        result = design(changed(EDGE_OFFSET_VAULT, generatrix=generatrix))
        assert [role is Role.STRAIGHT for role in result.form.generatrix.edges.role[:4]] == [True] * 3 + [False]
        assert result.kit.mismatch.max() < 1e-9


class TestResidual:
    def test_edges_are_the_inflection_tangents(self):
        data = changed(VAULT, generatrix={"divide": {"angle_deg": 5}, "inflections": "residual", "flat_nodes": False})
        result = design(data)
        off = assert_tangent(result.generatrix, result.form.generatrix)
        assert off.max() < 1e-9
        assert np.count_nonzero(np.abs(np.abs(turned(result.form.generatrix)) - 5) > 1e-6) == 6
        note = next(note.text for note in result.notes if note.code == "W-CURVE-LEFTOVER")
        assert "5.1365°" in note

    def test_ends_keep_their_tangents(self):
        data = changed(VAULT, generatrix={"divide": {"angle_deg": 5}, "inflections": "residual"})
        result = design(data)
        ends = result.generatrix.derivative(np.array([0, 0]), np.array([0.0, 1.0]))
        asked = np.arctan2(ends[:, 1], ends[:, 0])
        assert result.form.generatrix.edges.direction[[0, -1]] == pytest.approx(asked, abs=1e-12)

    def test_commensurable_arcs_have_nothing_left_over(self):
        ways = ({}, {"inflections": "residual"})
        plain, residual = (design(changed(VAULT, generatrix=way)).form.generatrix for way in ways)
        assert residual.vertices == pytest.approx(plain.vertices, abs=1e-6)

    def test_a_short_arc_becomes_one_node(self):
        """What `nearest` must refuse or overshoot."""
        curve = {"kind": "spline", "points": [[0, 0], [2000, 900], [5000, 1000], [8000, 1250], [10000, 2600]]}
        data = changed(VAULT, generatrix={"curve": curve, "divide": {"angle_deg": 9}, "inflections": "residual"})
        polygon = design(changed(data, members={"min_clear": 1}, tolerances={"min_member": 10})).form.generatrix
        assert len(set(np.sign(turned(polygon)))) == 2


class TestLoops:
    @pytest.mark.parametrize("way", ["nearest", "residual", "fit"])
    @pytest.mark.parametrize("points", [BEAN, TWIN])
    def test_counts(self, points, way):
        """n₊ − n₋ = k, whatever the way; all nodes turn by 2π/k but for leftovers."""
        curve, polygon = loop(closed(points), {"angle_deg": 15}, inflections=way)
        assert_tangent(curve, polygon)
        angles = turned(polygon)
        assert angles.sum() == pytest.approx(360, abs=1e-9)
        assert (angles < 0).any()
        if way != "residual":
            assert np.sign(angles).sum() == 24
            assert np.abs(angles) == pytest.approx(15, abs=1e-9)

    @pytest.mark.parametrize("way", ["nearest", "residual", "fit"])
    @pytest.mark.parametrize("points", [BEAN, TWIN])
    def test_start_is_independent_of_the_drawing(self, points, way):
        draws = [points[k:] + points[:k] for k in (0, 3, 6)]
        drawn = [draws[0], draws[1][::-1]] if way == "fit" else [*draws, *(draw[::-1] for draw in draws)]
        found = [loop(closed(draw), {"nodes": 26}, inflections=way)[1] for draw in drawn]
        for other in found[1:]:
            assert other.vertices == pytest.approx(found[0].vertices, abs=1e-5)
            assert other.turning == pytest.approx(found[0].turning, abs=1e-9)

    def test_first_direction(self):
        _, rail = loop(closed(BEAN), {"angle_deg": 15, "first_deg": 40})
        assert np.degrees(rail.edges.direction[0]) % 360 == pytest.approx(40)

    def test_flat_nodes(self):
        for way in ("nearest", "residual"):
            _, rail = loop(closed(BEAN), {"nodes": 24}, inflections=way, flat_nodes=True)
            assert (np.abs(rail.turning) <= FLAT).sum() == 2


class TestFit:
    @pytest.mark.parametrize("divide", [{"angle_deg": 5}, {"nodes": 40}, {"per_arc": 7}])
    def test_arcs_become_whole_multiples(self, divide):
        data = changed(VAULT, generatrix={"curve": WAVE, "divide": divide, "inflections": "fit"})
        result = design(changed(data, members={"min_clear": 1}, tolerances={"min_member": 10}))
        off = assert_tangent(result.generatrix, result.form.generatrix)
        assert off.max() < 1e-9
        assert result.form.generatrix.angle is not None
        assert any(note.code == "W-CURVE-FITTED" for note in result.notes)

    def test_the_move_is_the_least(self):
        """A general optimiser, told the same constraints, finds no shorter move."""
        request = Request("rail", RailDivide(angle_deg=5), Treatment(inflections="fit"), FormLimits())
        settings = BsplineSettings(kind="bspline", points=[(1000 * x, 1000 * y) for x, y in WAVE["points"]])
        drawn = np.array(settings.points)
        move = np.array(fit_curve(settings, request)[0].points) - drawn

        def off(aside):
            points = [tuple(map(float, point)) for point in drawn + aside.reshape(-1, 2)]
            curve, _ = build_curve(settings.model_copy(update={"points": tuple(points)}), TEMPLATES)
            return np.degrees(np.abs(arcs(spans(curve)).turning)) - [55, 45, 65]

        assert off(move.ravel()) == pytest.approx([0, 0, 0], abs=1e-9)
        other = minimize(
            lambda aside: (aside @ aside, 2 * aside),
            np.zeros(drawn.size),
            jac=True,
            method="SLSQP",
            constraints={"type": "eq", "fun": off},
            options={"ftol": 1e-9},
        )
        assert other.success
        assert (move**2).sum() == pytest.approx(other.fun, rel=1e-4)

    def test_a_curve_that_fits_stays(self):
        data = changed(VAULT, generatrix={"curve": WAVE, "divide": {"per_arc": 7}, "inflections": "fit"})
        first = design(data)
        note = next(note for note in first.notes if note.code == "W-CURVE-FITTED")
        assert "moved by up to" in note.text
        convex = {"kind": "bspline", "units": "m", "points": [[0, 0], [2, 2], [5, 3], [9, 0]]}
        again = design(changed(VAULT, rail={"curve": convex, "inflections": "fit"}))
        assert "up to 0.000 mm, its points by up to 0.000 mm" in str(again.notes)


REFUSALS = {
    "several angles of an edge offset mesh": (
        changed(EDGE_OFFSET_VAULT, rail={"divide": {"angles": RANGES}}),
        ["edge-offset", "angles"],
    ),
    "ranges in no order": (
        changed(VAULT, rail={"divide": {"angles": [{"angle_deg": 6}, {"until": "3 m", "angle_deg": 4}]}}),
        ["until", "the last has none"],
    ),
    "a range beyond the curve": (
        changed(VAULT, rail={"divide": {"angles": [{"until": "90 m", "angle_deg": 6}, {"angle_deg": 4}]}}),
        ["E-CURVE-RANGE", "90000 mm", "length"],
    ),
    "several angles on a loop": (
        changed(
            sphere(15, 30),
            rail={"divide": {"angles": RANGES}},
            surface={"kind": "isogonal"},
            generatrix={"divide": {"nodes": 4}},
        ),
        ["E-CURVE-ANGLES", "closed"],
    ),
    "several angles with leftovers": (
        changed(VAULT, generatrix={"divide": {"angles": RANGES}, "inflections": "residual"}),
        ["E-CURVE-ANGLES", "residual"],
    ),
    "a direction beside leftovers": (
        changed(VAULT, generatrix={"divide": {"angle_deg": 5, "first_deg": 3}, "inflections": "residual"}),
        ["E-CURVE-FIRST", "first_deg"],
    ),
    "leftovers of an edge offset rail": (
        changed(
            EDGE_OFFSET_VAULT,
            rail={**bend()["rail"], "divide": {"angle_deg": 7}, "inflections": "residual"},
        ),
        ["E-RAIL-ANGLES"],
    ),
    "leftovers of edge offset slopes": (
        changed(EDGE_OFFSET_VAULT, generatrix={"inflections": "residual"}),
        ["E-GENERATRIX-WAY", "nearest"],
    ),
    "fit without control points": (
        changed(VAULT, generatrix={"inflections": "fit"}),
        ["E-CURVE-FIT", "sine", "bspline or spline"],
    ),
    "fit with too few nodes": (
        changed(VAULT, generatrix={"curve": WAVE, "divide": {"nodes": 2}, "inflections": "fit"}),
        ["E-CURVE-FIT", "2 nodes for 3 arcs"],
    ),
}


@pytest.mark.parametrize("case", REFUSALS)
def test_refused(case):
    data, words = REFUSALS[case]
    with pytest.raises(Refused) as refusal:
        design(data)
    for word in words:
        assert word in str(refusal.value)


class TestSurvey:
    @pytest.fixture
    def checked(self, tmp_path):
        data = changed(SMALL, generatrix={"divide": {"angle_deg": 6}})
        return isomould.check(write_project(tmp_path / "small.toml", data))

    def test_arcs_and_nearest_angles(self, checked):
        rail, generatrix = checked.divisions
        assert (rail.field, generatrix.field) == ("rail", "generatrix")
        assert [arc.steps for arc in rail.arcs] == pytest.approx([4])
        total = 2 * np.degrees(np.arctan(2 * np.pi * 0.4 / 9))
        assert [arc.turning_deg for arc in generatrix.arcs] == pytest.approx([total] * 2)
        assert [arc.nearest_deg for arc in generatrix.arcs] == pytest.approx([total / round(total / 6)] * 2)

    def test_nodes_and_deviation(self, checked):
        for part, polygon in zip(
            checked.divisions, (checked.design.form.rail, checked.design.form.generatrix), strict=True
        ):
            assert part.deviation == polygon.deviation
            assert sum(angle.nodes for angle in part.angles) == np.isfinite(polygon.turning).sum()

    def test_rails_in_space_have_no_arcs(self, tmp_path):
        rail, generatrix = isomould.check(write_project(tmp_path / "monge.toml", MONGE)).divisions
        assert (rail.edges, rail.arcs, sum(angle.nodes for angle in rail.angles)) == (6, (), 5)
        assert len(generatrix.arcs) == 1

    def test_gaps_are_no_edges(self, tmp_path):
        generatrix = {"curve": {"kind": "arc", "radius": 2000, "start_deg": -50, "end_deg": 150}, "axes": "dz"}
        generatrix |= {"origin": ["4 m", 0], "divide": {"phase": "centre"}, "max_edge": 900}
        surface = {"kind": "edge-offset", "pole": "open", "min_pole_angle_deg": 20}
        rail, limits = {"divide": {"angle_deg": 12}}, {"min_member": 170}
        shape = {"rail": rail, "generatrix": generatrix, "surface": surface}
        data = changed(SMALL, **shape, tolerances=limits, deliver={"strips": []})
        checked = isomould.check(write_project(tmp_path / "open.toml", data))
        gap = checked.design.form.generatrix.gap
        assert gap.sum() == 1
        assert checked.divisions[1].edges == len(gap) - 1
        assert "W-CURVE-LONG" not in {note.code for note in checked.notes}


@pytest.mark.slow
def test_a_build_proves_them(tmp_path):
    """The verifier, which knows nothing of lattices, accepts the polygons from the folder's files alone."""
    divide = {"angles": [{"until": "9 m", "angle_deg": 30}, {"angle_deg": 20}]}
    rail = {**bend()["rail"], "divide": divide, "max_edge": "4 m"}
    generatrix = {"divide": {"angle_deg": 12}, "inflections": "residual"}
    project = write_project(tmp_path / "small.toml", changed(SMALL, rail=rail, generatrix=generatrix, deliver=BARE))
    built = isomould.build(project, tmp_path / "out", run=isomould.Run(effort="quick", jobs=1))
    assert built.certificate.passed
    assert "W-CURVE-LEFTOVER" in {note.code for note in built.design.notes}
