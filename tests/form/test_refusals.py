"""What the form stages refuse, and that the message names field, value, limit and way out."""

import pytest

from isomould.errors import Refused
from museum import SMALL, VAULT, changed, design, sphere

STRAIGHT = {"kind": "polyline", "points": [[0, 0], [8000, 0]]}
KINKED = {"kind": "polyline", "points": [[0, 0], [4000, 2000], [8000, 0]]}
NOISY = {"kind": "spline", "points": [[k * 500, 3 * (-1) ** k + k * (16 - k) * 10] for k in range(17)]}
STADIUM = {
    "kind": "polyline",
    "units": "m",
    "points": [[-20, -15], [20, -15], [20, 15], [-20, 15]],
    "bulges": [0, 1, 0, 1],
    "closed": True,
}
LOOP = {"kind": "bspline", "points": [[0, 0], [9000, 6000], [9000, 0], [0, 6000]], "closed": True}
OMEGA = {
    "kind": "polyline",
    "points": [[-300, 0], [-2500, 1500], [-2500, 4000], [0, 5500], [2500, 4000], [2500, 1500], [300, 0]],
}
LEANING = {"kind": "polyline", "points": [[0, 0], [-600, 1500], [-900, 3000]]}

CASES = {
    "kink": (changed(SMALL, rail={"curve": KINKED}), ["E-CURVE-KINK", "rail.curve", "°", "Fillet"]),
    "straight rail": (changed(SMALL, rail={"curve": STRAIGHT}), ["E-CURVE-STRAIGHT", "straight line"]),
    "noise": (changed(SMALL, rail={"curve": NOISY}), ["E-CURVE-NOISE", "Refit"]),
    "too coarse": (changed(SMALL, rail={"divide": {"nodes": 1}}), ["E-CURVE-ANGLE", "max_turning_deg"]),
    "less than one angle": (
        changed(SMALL, rail={"divide": {"angle_deg": 59}, "curve": {"kind": "arc", "span": 8000, "rise": 400}}),
        ["E-CURVE-FEW", "rail.divide"],
    ),
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
    "angle that does not divide the circle": (
        changed(sphere(15, 30), rail={"divide": {"angle_deg": 7}}),
        ["E-CURVE-ANGLE", "7° on a closed curve", "7.058824°"],
    ),
    "two nodes on a closed rail": (changed(sphere(15, 30), rail={"divide": {"nodes": 2}}), ["E-CURVE-COUNT", "3"]),
    "figure eight": (
        changed(sphere(15, 30), rail={"curve": LOOP, "divide": {"nodes": 20}}),
        ["E-CURVE-LOOP", "turns round", "crossings"],
    ),
    "unequal arcs": (
        changed(
            VAULT,
            generatrix={"curve": {"kind": "sine", "amplitude": 900, "wavelength": 9000, "waves": 1, "phase_deg": 20}},
        ),
        ["E-CURVE-ARCS", "per_arc"],
    ),
    "incommensurable arcs": (
        changed(VAULT, generatrix={"divide": {"angle_deg": 5}, "inflections": "refuse"}),
        ["E-CURVE-ARCS", "Nearest admissible angles"],
    ),
    "pole": (
        changed(sphere(5, 89), tolerances={"min_member": 0.1}),
        ["E-GENERATRIX-POLE", "rows", "min_pole_angle_deg"],
    ),
    "straight edge offset generatrix": (
        changed(
            sphere(15, 30), generatrix={"curve": {"kind": "polyline", "points": [[0, 0], [0, 5000]]}, "origin": [0, 0]}
        ),
        ["E-CURVE-STRAIGHT", "paper §4.3"],
    ),
    "edges flip": (
        changed(VAULT, generatrix={"origin": ["-9 m", 0]}),
        ["E-SURFACE-FLIP", "parallel", "offset from the rail", "generatrix.origin"],
    ),
    "beams flip": (
        changed(VAULT, members={"section": {"kind": "plate", "depth": 9000, "thickness": 10}}),
        ["E-SURFACE-FLIP"],
    ),
    "short members": (changed(SMALL, tolerances={"min_member": 3000}), ["E-SURFACE", "min_member"]),
    "deviation": (changed(SMALL, tolerances={"max_deviation": 1}), ["E-DEVIATION", "max_deviation = 1 mm"]),
    "too many panels": (changed(SMALL, limits={"max_panels": 10}), ["E-SIZE", "35 panels", "10"]),
    "a turning angle far too small": (
        changed(SMALL, rail={"divide": {"angle_deg": 1e-9}}),
        ["E-SIZE", "limits.max_panels", "200000"],
    ),
    "a turning angle far too small on a loop": (
        changed(sphere(15, 30), rail={"divide": {"angle_deg": 3.6e-7}}),
        ["E-SIZE", "1000000000 panels", "5000"],
    ),
    "stations without number": (
        changed(SMALL, generatrix={"divide": {"stations": 10**9}}),
        ["E-SIZE", "1000000000 panels"],
    ),
    "no division": (changed(SMALL, generatrix={"divide": {}}), ["E-CURVE-DIVIDE", "generatrix.divide"]),
    "stations off the curve": (
        changed(SMALL, generatrix={"divide": {"stations": ["1 m", "99 m"]}}),
        ["E-CURVE-STATION", "99000 mm"],
    ),
    "rail that crosses itself": (
        changed(
            SMALL,
            rail={
                "curve": {"kind": "polyline", "points": [[0, 0], [6000, 3000], [6000, 0], [0, 3000], [-4000, 3100]]},
                "divide": {},
            },
            surface={"kind": "moulding"},
        ),
        ["E-CURVE-CROSSING", "rail.curve", "edges 0 and 2 meet at"],
    ),
    "parallel that crosses itself": (
        changed(
            SMALL,
            rail={"curve": OMEGA, "plane": "xy", "divide": {}},
            generatrix={"curve": LEANING, "axes": "dz", "divide": {}},
            surface={"kind": "moulding"},
        ),
        ["E-SURFACE-CROSSING", "parallel 1", "edges 0 and 5 meet at (293.863, -430.999) mm", "generatrix"],
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_refused(case):
    data, words = CASES[case]
    with pytest.raises(Refused) as refusal:
        design(data)
    for word in words:
        assert word in str(refusal.value)


def test_coarse_rails_are_noted():
    arc = {"kind": "arc", "radius": 6000, "start_deg": 0, "end_deg": 170}
    notes = design(changed(SMALL, rail={"curve": arc, "divide": {"angle_deg": 40}})).form.notes
    assert "W-RAIL-COARSE rail.divide: the rail turns by 40.00° at a node, more than 30°" in map(str, notes)
