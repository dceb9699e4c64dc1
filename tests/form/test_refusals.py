"""What the form stages refuse and note besides the failure modes B and C, which have a module of their own."""

import pytest

from isomould.errors import Refused
from museum import SMALL, VAULT, changed, design, sphere, trimmed

STADIUM = {
    "kind": "polyline",
    "units": "m",
    "points": [[-20, -15], [20, -15], [20, 15], [-20, 15]],
    "bulges": [0, 1, 0, 1],
    "closed": True,
}


def above(level):
    return {"plane": {"z": level}, "keep": "above"}


CASES = {
    "outside along the chord": (changed(SMALL, rail={"outside": [1, 0]}), ["E-CURVE-OUTSIDE", "rail.outside"]),
    "outside word for an open rail": (
        changed(SMALL, rail={"outside": "outer"}),
        ["E-RAIL-OUTSIDE", "'outer', and the rail is open", "Set rail.outside to a direction"],
    ),
    "outside direction for a closed rail": (
        changed(sphere(15, 30), rail={"outside": [0, 1]}),
        ["E-RAIL-OUTSIDE", "the direction [0, 1], and the rail is closed", "Set rail.outside = 'outer'"],
    ),
    "straight parts off the lattice": (
        changed(sphere(15, 30), rail={"curve": STADIUM, "divide": {"nodes": 25}}),
        ["E-CURVE-BACK", "run backwards", "first_deg", "(0°, 180°)"],
    ),
    "a turning angle far too small": (
        changed(SMALL, rail={"divide": {"angle_deg": 1e-9}}),
        ["E-SIZE", "limits.max_panels", "200000"],
    ),
    "a turning angle far too small on a loop": (
        changed(sphere(15, 30), rail={"divide": {"angle_deg": 3.6e-7}}),
        ["E-SIZE", "at least 8.33e+16 panels", "5000"],
    ),
    "stations without number": (
        changed(SMALL, generatrix={"divide": {"stations": 10**9}}),
        ["E-SIZE", "at least 4e+09 panels"],
    ),
    "no division": (changed(SMALL, generatrix={"divide": {}}), ["E-CURVE-DIVIDE", "generatrix.divide"]),
    "stations off the curve": (
        changed(SMALL, generatrix={"divide": {"stations": ["1 m", "99 m"]}}),
        ["E-CURVE-STATION", "99000 mm"],
    ),
    "axes that are not perpendicular": (
        changed(SMALL, rail={"plane": {"x_axis": [1, 0, 0], "y_axis": [0.1, 1, 0]}}),
        ["E-PLANE-AXES", "rail.plane", "84.28", "perpendicular"],
    ),
    "an axis of no length": (
        changed(SMALL, rail={"plane": {"x_axis": [0, 0, 0], "y_axis": [0, 1, 0]}}),
        ["E-PLANE-AXES", "rail.plane.x_axis", "length 0", "more than 0"],
    ),
    "two layers in one place": (
        changed(SMALL, deliver={"double_layer": {"offset": "face", "distance": 0}}),
        ["E-PROJECT", "deliver.double_layer.distance", "other than 0"],
    ),
    "two layers of a trimmed surface": (
        changed(trimmed(SMALL, above(900)), deliver={"double_layer": {"offset": "face", "distance": 500}}),
        ["E-LAYER-WHOLE", "deliver.double_layer", "trimmed", "a whole surface"],
    ),
    "a plane beyond the surface": (
        trimmed(SMALL, above(50_000)),
        ["E-TRIM-EMPTY", "surface.trim[0]", "at -47", " mm from the plane", "keep its other side"],
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_refused(case):
    data, words = CASES[case]
    with pytest.raises(Refused) as refusal:
        design(data)
    for word in words:
        assert word in str(refusal.value)


NOTES = {
    "an arch that hangs": (
        changed(SMALL, rail={"curve": {"kind": "parabola", "span": "8 m", "rise": "-2.4 m"}}),
        "W-CURVE-HANGS rail.curve.rise: -2400 mm: the curve hangs below the line between its ends",
    ),
    "an arc that hangs": (
        changed(SMALL, rail={"curve": {"kind": "arc", "chord": "8 m", "rise": "-2 m"}}),
        "W-CURVE-HANGS rail.curve.rise: -2000 mm",
    ),
    "a plane that cuts nothing": (trimmed(SMALL, above(-9000)), "W-TRIM-NOTHING surface.trim[0]"),
    "other nodes than asked for": (
        changed(VAULT, generatrix={"divide": {"nodes": 23}, "flat_nodes": False}),
        "W-CURVE-COUNT generatrix.divide.nodes: 23 nodes asked for, 24 obtained",
    ),
    "beams that mismatch": (SMALL, "W-NODE-MISMATCH surface.kind: beams mismatch by up to 2.264 mm"),
}


@pytest.mark.parametrize("case", NOTES)
def test_noted(case):
    data, text = NOTES[case]
    assert any(str(note).startswith(text) for note in design(data).notes)


def test_arches_that_rise_and_rails_that_turn_by_thirty_degrees_are_not_noted():
    codes = {note.code for data in (SMALL, sphere(30, 30)) for note in design(data).notes}
    assert codes.isdisjoint({"W-CURVE-HANGS", "W-RAIL-COARSE"})


BEAN = {
    "kind": "bspline",
    "units": "m",
    "points": [[10, 0], [7, 4], [0, 2], [-7, 4], [-10, 0], [-7, -4], [0, -2], [7, -4]],
    "closed": True,
}


def test_refused_arcs_of_a_loop_are_whole():
    """Where the division of a loop would begin does not divide an arc of the message in two."""
    with pytest.raises(Refused, match="E-CURVE-ARCS") as refusal:
        design(changed(sphere(15, 30), rail={"curve": BEAN, "divide": {"nodes": 30}, "inflections": "refuse"}))
    assert refusal.value.found == "arcs that turn by 13.691259°, 193.691259°, 13.691259°, 193.691259°"
