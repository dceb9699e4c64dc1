"""Three offsets (geometry §4): each keeps the distance that it promises, and only its own."""

import numpy as np
import pytest

import isomould
from isomould.errors import Refused
from isomould.form.edge_offset import edge_offset_residual
from isomould.form.mesh import make_mesh
from isomould.form.offsets import offset_surface
from isomould.measure.offsets import (
    edge_distances,
    edge_turnings,
    face_distances,
    make_double_layer,
    vertex_distances,
)
from museum import BARE, EDGE_OFFSET_VAULT, SMALL, VAULT, changed, design, sphere

MITRED = changed(VAULT, rail={"ends": "mitred"})
STATIONS = {**changed(VAULT, surface={"kind": "moulding"}), "rail": {**VAULT["rail"], "divide": {"stations": 12}}}


def layers(data, constant, distance):
    form = design(data).form
    return make_mesh(form.surface), make_mesh(offset_surface(form, constant, distance))


@pytest.mark.parametrize("distance", [-150.0, 250.0])
@pytest.mark.parametrize(
    ("data", "constant", "measure"),
    [
        (VAULT, "face", face_distances),
        (EDGE_OFFSET_VAULT, "face", face_distances),
        (MITRED, "vertex", vertex_distances),
        (sphere(15, 60), "vertex", vertex_distances),
        (EDGE_OFFSET_VAULT, "edge", edge_distances),
        (sphere(15, 60), "edge", edge_distances),
    ],
)
def test_distances_are_exact(data, constant, measure, distance):
    first, second = layers(data, constant, distance)
    assert np.abs(measure(first, second)) == pytest.approx(abs(distance), abs=1e-8)
    assert edge_turnings(first, second).max() < 1e-7


def test_a_face_offset_lies_outside_where_it_should():
    assert face_distances(*layers(VAULT, "face", 250.0)).min() > 0


def test_a_face_offset_keeps_no_other_distance():
    first, second = layers(MITRED, "face", 250.0)
    assert np.abs(vertex_distances(first, second) - 250).max() > 0.1
    assert np.abs(edge_distances(first, second) - 250).max() > 0.01


def test_square_ends_are_reported():
    square = make_double_layer(design(VAULT).form, "vertex", 250.0)
    assert square.error > 0.01
    assert "W-LAYER-DISTANCE" in str(square.notes[0])
    assert make_double_layer(design(MITRED).form, "vertex", 250.0).notes == ()


@pytest.mark.parametrize(
    ("data", "constant", "distance", "code"),
    [
        (VAULT, "edge", 100.0, "E-OFFSET-EDGE"),
        (STATIONS, "vertex", 1.0, "E-OFFSET-VERTEX"),
        (sphere(15, 60), "edge", -10_500.0, "E-OFFSET-FLIP"),
    ],
)
def test_what_does_not_exist_is_refused(data, constant, distance, code):
    with pytest.raises(Refused, match=code):
        offset_surface(design(data).form, constant, distance)


@pytest.mark.parametrize("constant", ["face", "vertex"])
def test_the_limit_is_where_the_first_edge_vanishes(constant):
    """Also where that edge joins the last node of a loop to the first."""
    rail = {
        "curve": {"kind": "ellipse", "semi_axes": [9000, 6000]},
        "divide": {"nodes": 13, "first_deg": 90 + 360 / 13},
    }
    form = design(
        changed(sphere(15, 30), rail=rail, generatrix={"divide": {"nodes": 3}}, surface={"kind": "isogonal"})
    ).form
    assert form.surface.rail.lengths.argmin() == 12
    with pytest.raises(Refused, match=r"E-OFFSET-FLIP.*at which parallel edges flip") as refusal:
        offset_surface(form, constant, -6000.0)
    limit = float(refusal.value.limit.removeprefix("nearer than ").removesuffix(" mm"))
    offset_surface(form, constant, limit + 0.001)
    with pytest.raises(Refused, match="E-OFFSET-FLIP"):
        offset_surface(form, constant, limit - 0.001)


def test_residual_of_edge_offset_slopes():
    exact, other = (design(data).form for data in (EDGE_OFFSET_VAULT, VAULT))
    residuals = [abs(edge_offset_residual(f.surface.profile.latitude, f.rail.angle)).max() for f in (exact, other)]
    assert residuals[0] < 1e-12
    assert residuals[1] > 1e-4


def test_double_layer_is_delivered(tmp_path, project_file):
    path = project_file(changed(SMALL, deliver={**BARE, "double_layer": {"offset": "face", "distance": "-0.3 m"}}))
    folder = isomould.build(path, tmp_path / "out", run=isomould.Run(effort="quick", jobs=1)).folder
    lines = (folder / "model" / "double-layer.obj").read_text(encoding="utf-8").splitlines()
    heads = [line.split()[0] for line in lines]
    assert [heads.count(head) for head in ("v", "f", "l")] == [2 * 48, 2 * 35, 48]
    assert "l 1 49" in lines
    assert isomould.verify(folder).passed
