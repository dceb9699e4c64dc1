"""Long edges divided by flat nodes, and ends that stay where they were drawn (paper §4.4, geometry §2)."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import isomould
from isomould.errors import Refused
from isomould.form.long_edges import equal_parts
from isomould.form.mesh import Family, NodeKind
from isomould.form.polygon import FLAT, Role
from isomould.form.settings import FormLimits
from isomould.measure.faces import planarity
from isomould.measure.joints import conical_residual, edge_lengths
from museum import (
    BARE,
    EDGE_OFFSET_VAULT,
    MONGE,
    SMALL,
    VAULT,
    changed,
    design,
    sketched,
    sphere,
    template,
    write_project,
)

WAVY = changed(EDGE_OFFSET_VAULT, generatrix={"flat_nodes": False})


def kinds(result) -> dict[str, int]:
    """Node classes by kind."""
    found, counts = np.unique(result.kit.nodes.kind, return_counts=True)
    return {NodeKind(kind).word: int(count) for kind, count in zip(found, counts, strict=True)}


def longest(mesh, family) -> float:
    return float(edge_lengths(mesh)[mesh.family == family].max())


class TestFigure6:
    """The vault of Fig. 6: 34 → 42 arches, longest edge 2430 → 991 mm, inner classes 8 → 9, all exact (recomputed)."""

    @pytest.fixture(scope="class")
    @classmethod
    def plain(cls):
        return design(template("barrel-vault"))

    @pytest.fixture(scope="class")
    @classmethod
    def divided(cls):
        return design(changed(template("barrel-vault"), generatrix={"max_edge": "1 m"}))

    def test_arches(self, plain, divided):
        assert (plain.kit.mesh.shape[0], divided.kit.mesh.shape[0]) == (34, 42)

    def test_longest_edge(self, plain, divided):
        assert longest(plain.kit.mesh, Family.GENERATRIX) == pytest.approx(2430, abs=0.5)
        assert longest(divided.kit.mesh, Family.GENERATRIX) == pytest.approx(991, abs=0.5)

    def test_panels_stay_plane_and_nodes_conical(self, divided):
        mesh = divided.kit.mesh
        assert planarity(mesh).max() < 4e-12
        assert np.degrees(np.nanmax(conical_residual(mesh, divided.kit.arms))) < 6e-13

    def test_one_class_more_inside(self, plain, divided):
        assert kinds(plain) == {"boundary": 6, "interior": 8}
        assert {kind: count for kind, count in kinds(divided).items() if kind != "boundary"} == {
            "flat": 1,
            "interior": 8,
        }

    def test_old_nodes_stay(self, plain, divided):
        """Every node of the coarse mesh is one of the fine mesh: flat nodes move nothing."""
        coarse, fine = (np.round(each.kit.mesh.nodes, 6) + 0.0 for each in (plain, divided))
        assert {tuple(node) for node in coarse.tolist()} <= {tuple(node) for node in fine.tolist()}


class TestEdgeOffset:
    def test_flat_nodes_of_the_generatrix_are_exact(self):
        result = design(changed(WAVY, generatrix={"max_edge": 700}))
        assert result.kit.mismatch.max() < 1e-9
        assert longest(result.kit.mesh, Family.GENERATRIX) <= 700

    def test_slopes_of_both_signs_share_their_flat_nodes(self):
        """Two classes for the two slopes of long edges, whichever way they lean."""
        result = design(changed(WAVY, generatrix={"max_edge": 1000}))
        flat = result.form.surface.profile.flat
        slopes = {round(abs(float(result.form.surface.profile.latitude[row])), 9) for row in np.flatnonzero(flat)}
        assert kinds(result)["flat"] == len(slopes)

    def test_flat_nodes_of_the_rail_cost_what_is_derived(self):
        """Parallels pass a flat node at the height of their beams, generatrices at 1/cos h of theirs (geometry §5)."""
        result = design(changed(WAVY, rail={"max_edge": 1500}))
        rail, profile = result.form.surface.rail, result.form.surface.profile
        rise = np.arcsin(np.sin(result.form.rail.angle / 2) * np.cos(profile.latitude)).max()
        columns = result.kit.mismatch.reshape(result.kit.mesh.shape)
        assert columns[:, rail.flat].max() == pytest.approx(100 * (1 / np.cos(rise) - 1), abs=1e-9)
        assert columns[:, ~rail.flat].max() < 1e-9
        assert "W-RAIL-FLAT" in {note.code for note in result.notes}


@given(st.lists(st.floats(1.0, 5000.0), min_size=1, max_size=30), st.floats(50.0, 5000.0), st.floats(0.001, 5.0))
@settings(max_examples=60)
def test_equal_edges_get_equal_parts(lengths, limit, same):
    values = np.array(lengths)
    parts = equal_parts(values, limit, FormLimits(same_length=same))
    assert (values / parts <= limit * (1 + 1e-8)).all()
    assert (parts <= np.ceil((values + same) / limit)).all()
    doubled = equal_parts(np.concatenate([values, values]), limit, FormLimits(same_length=same))
    assert doubled.tolist() == [*parts.tolist(), *parts.tolist()]


def test_edges_beside_a_multiple_are_divided_alike():
    limits = FormLimits(same_length=0.5)
    assert equal_parts(np.array([1999.8, 2000.2, 1999.6]), 1000.0, limits).tolist() == [3, 3, 2]


def test_edges_without_number_are_refused_before_they_are_made():
    with pytest.raises(Refused, match="E-SIZE"):
        sketched(changed(VAULT, rail={"max_edge": 0.001}))


SHAPES = {
    "closed rail": (changed(sphere(15, 30), rail={"max_edge": 1000}), "rail"),
    "closed generatrix": (changed(template("torus"), generatrix={"max_edge": 500}), "generatrix"),
    "stations": (
        changed(SMALL, rail={"divide": {"stations": 4}, "max_edge": 1200}, surface={"kind": "moulding"}),
        "rail",
    ),
    "per arc": (changed(VAULT, generatrix={"max_edge": 600}), "generatrix"),
}


@pytest.mark.parametrize("shape", SHAPES)
def test_no_edge_is_longer(shape):
    data, field = SHAPES[shape]
    form = sketched(data).form
    polygon, limit = getattr(form, field), data[field]["max_edge"]
    before = getattr(sketched({**data, field: {k: v for k, v in data[field].items() if k != "max_edge"}}).form, field)
    assert polygon.lengths[~polygon.gap].max() <= limit + 1e-9 < before.lengths[~before.gap].max()
    turns = np.abs(np.nan_to_num(polygon.turning)) > FLAT
    assert polygon.turning[turns] == pytest.approx(before.turning[np.abs(np.nan_to_num(before.turning)) > FLAT], abs=0)
    assert polygon.lengths[~polygon.gap].sum() == pytest.approx(before.lengths[~before.gap].sum(), abs=1e-6)


def test_rails_in_space_are_divided_too():
    plain, fine = sketched(MONGE), sketched(changed(MONGE, rail={"max_edge": 1500}))
    assert fine.form.rail.lengths.max() <= 1500 < plain.form.rail.lengths.max()
    assert planarity(fine.mesh).max() < 1e-9
    assert fine.form.surface.rail.flat.sum() == fine.mesh.shape[1] - plain.mesh.shape[1]


def test_parallels_beside_the_rail_are_noted():
    notes = {note.code: note.text for note in sketched(changed(VAULT, rail={"max_edge": 1000})).notes}
    assert "longer than 1000 mm, up to" in notes["W-CURVE-LONG"]


class TestKeptEnds:
    def test_ends_lie_on_the_drawn_ends(self):
        divide = {"phase": "centre", "keep_ends": True}
        result = design(changed(WAVY, generatrix={"divide": divide}))
        polygon = result.form.generatrix
        assert polygon.vertices[[0, -1]] == pytest.approx(np.array([[0, 0], [0, 24_000]]), abs=1e-6)
        assert [polygon.edges.role[row] for row in (0, -1)] == [Role.END] * 2
        assert result.kit.mismatch.max() < 1e-9
        assert "W-CURVE-ENDS" in {note.code for note in result.notes}

    def test_classes_inside_are_those_without(self):
        plain = design(changed(VAULT, rail={"divide": {"angle_deg": 7}}))
        kept = design(changed(VAULT, rail={"divide": {"angle_deg": 7, "keep_ends": True}}))
        assert kinds(plain) == kinds(kept)
        assert abs(kept.form.rail.vertices[-1]) == pytest.approx([10_000, 0], abs=1e-6)
        assert np.linalg.norm(abs(plain.form.rail.vertices[-1]) - [10_000, 0]) > 1

    @given(st.floats(3.0, 16.0))
    @settings(max_examples=25, deadline=None)
    def test_any_angle(self, angle):
        divide = {"angle_deg": angle, "keep_ends": True}
        rail = sketched(changed(VAULT, rail={"divide": divide}, generatrix={"divide": {"per_arc": 2}})).form.rail
        assert np.abs(rail.vertices[[0, -1], 0]) == pytest.approx([10_000] * 2, abs=1e-6)
        assert rail.vertices[[0, -1], 1] == pytest.approx([0, 0], abs=1e-6)
        assert np.degrees(np.abs(rail.turning[1:-1])) == pytest.approx(np.full(len(rail.turning) - 2, angle))

    def test_ends_that_lie_there_anyway_stay_tangents(self):
        divide = {"nodes": 18, "keep_ends": True}
        assert Role.END not in sketched(changed(VAULT, rail={"divide": divide})).form.rail.edges.role

    @pytest.mark.parametrize(
        ("data", "words"),
        [
            (changed(sphere(15, 30), rail={"divide": {"nodes": 24, "keep_ends": True}}), "a closed curve"),
            (
                changed(
                    template("corrugated-vault"),
                    rail={"inflections": "fit", "divide": {"nodes": 19, "keep_ends": True}},
                ),
                "'fit', which moves the curve",
            ),
        ],
    )
    def test_refused_where_there_are_none(self, data, words):
        with pytest.raises(Refused, match="E-CURVE-ENDS") as refusal:
            sketched(data)
        assert words in refusal.value.found


@pytest.mark.slow
def test_a_build_proves_flat_nodes_and_kept_ends(tmp_path):
    rail = {"divide": {"angle_deg": 20, "keep_ends": True}, "max_edge": "1.8 m"}
    data = changed(SMALL, rail=rail, generatrix={"max_edge": "1.2 m"}, deliver=BARE)
    project = write_project(tmp_path / "small.toml", data)
    built = isomould.build(project, tmp_path / "out", run=isomould.Run(effort="quick", jobs=1))
    assert built.certificate.passed
    assert "W-CURVE-ENDS" in {note.code for note in built.design.notes}
