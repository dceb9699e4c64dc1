"""Rows B and C of the failure modes, each provoked: code, field, value found with its unit, limit and way out."""

import re
from pathlib import Path

import numpy as np
import pytest

from isomould.errors import Refused
from museum import EDGE_OFFSET_VAULT, MONGE, SMALL, VAULT, changed, design, sphere

ARC = {"kind": "arc", "radius": 6000, "start_deg": 0, "end_deg": 170}
STRAIGHT = {"kind": "polyline", "points": [[0, 0], [8000, 0]]}
KINKED = {"kind": "polyline", "points": [[0, 0], [4000, 2000], [8000, 0]]}
NOISY = {"kind": "spline", "points": [[k * 500, 3 * (-1) ** k + k * (16 - k) * 10] for k in range(17)]}
FLICKERING = {"kind": "spline", "points": [[k * 500, 10.2 * (-1) ** k + k * (16 - k) * 60] for k in range(17)]}
LOOP = {"kind": "bspline", "points": [[0, 0], [9000, 6000], [9000, 0], [0, 6000]], "closed": True}
STRETCHED = {
    "kind": "polyline",
    "points": [[0, 0], [0, 6000], [8000, 6000], [8000, 0]],
    "bulges": [0, -1, 0],
}
CROSSED = {"kind": "polyline", "points": [[0, 0], [6000, 3000], [6000, 0], [0, 3000], [-4000, 3100]]}
OMEGA = {
    "kind": "polyline",
    "points": [[-300, 0], [-2500, 1500], [-2500, 4000], [0, 5500], [2500, 4000], [2500, 1500], [300, 0]],
}
LEANING = {"kind": "polyline", "points": [[0, 0], [-600, 1500], [-900, 3000]]}
WAVE = {"kind": "spline", "points": [[0, 0], [2000, 800], [5000, -900], [9000, 700]]}
MOULDING = {"surface": {"kind": "moulding"}}
AS_DRAWN = {"divide": {}}
RING = {"kind": "polyline", "points": [[5000, 0, 0], [0, 4000, 900], [-5000, 0, 300], [0, -4000, 0]], "closed": True}
"""Lifted on one side: its frame does not close."""
TURNS = np.linspace(0, 2.6 * np.pi, 27)
HELIX = [[5000 * np.cos(a), 5000 * np.sin(a), 1500 * a / (2 * np.pi)] for a in TURNS]


def wall(*stations):
    curve = {"kind": "polyline", "points": [[0, 0], [0, 4001]]}
    return changed(
        SMALL,
        generatrix={"curve": curve, "axes": "dz", "divide": {"stations": list(stations)}},
        tolerances={"min_member": 0.1},
        **MOULDING,
    )


def rail(data, **keys):
    return changed(data, rail=keys)


def generatrix(data, **keys):
    return changed(data, generatrix=keys)


CIRCLE = sphere(15, 30)

REFUSED = {
    "B1 kink": (
        rail(SMALL, curve=KINKED),
        ("E-CURVE-KINK", "rail.curve", r"53\.130102° at \(4000\.000, 2000\.000\) mm", "1e-9 rad", "Fillet it"),
    ),
    "B3 straight": (
        rail(SMALL, curve=STRAIGHT),
        ("E-CURVE-STRAIGHT", "rail.curve", "a straight line", "a curve that turns", "divide.stations"),
    ),
    "B3 less than one angle": (
        rail(SMALL, divide={"angle_deg": 59}, curve={"kind": "arc", "span": 8000, "rise": 400}),
        ("E-CURVE-FEW", "rail.divide", "1 tangent lines", "at least 2", "smaller turning angle"),
    ),
    "B4 refused": (
        generatrix(VAULT, divide={"angle_deg": 5}, inflections="refuse"),
        ("E-CURVE-ARCS", "generatrix.divide", r"turn by 55\.\d{6}°, 55\.", "whole multiples", r"angles by arc: 5\.0"),
    ),
    "B4 unequal arcs": (
        generatrix(VAULT, curve={"kind": "sine", "amplitude": 900, "wavelength": 9000, "waves": 1, "phase_deg": 20}),
        ("E-CURVE-ARCS", "generatrix.divide.per_arc", r"turn by \d+\.\d{6}°, ", "equal arcs", "divide.angle_deg"),
    ),
    "B4 an arc shorter than a step": (
        generatrix(SMALL, curve=NOISY, divide={"angle_deg": 2}),
        ("E-CURVE-ARC", "generatrix.divide", r"turns by \d+\.\d{4}°, too little", "about one", r"at most \d+\.\d{4}°"),
    ),
    "B4 nothing to fit": (
        generatrix(VAULT, inflections="fit"),
        ("E-CURVE-FIT", "generatrix", "sine", "bspline or spline", "inflections"),
    ),
    "B5 noise": (
        rail(SMALL, curve=NOISY),
        ("E-CURVE-NOISE", "rail.curve", r"\d+ arcs .* at \(\d.*\) mm", "does not flicker", "Refit"),
    ),
    "B6 rail": (
        changed(rail(SMALL, curve=CROSSED, **AS_DRAWN), **MOULDING),
        ("E-CURVE-CROSSING", "rail.curve", r"edges 0 and 2 meet at \(3000\.000, 1500\.000\) mm", "crossings", "Redraw"),
    ),
    "B6 parallel": (
        changed(
            rail(SMALL, curve=OMEGA, plane="xy", **AS_DRAWN),
            generatrix={"curve": LEANING, "axes": "dz", **AS_DRAWN},
            **MOULDING,
        ),
        (
            "E-SURFACE-CROSSING",
            "generatrix.origin",
            r"parallel 1 .* edges 0 and 5 meet at \(293\.863, -430\.999\) mm",
            "parallels without crossings",
            "Move the generatrix",
        ),
    ),
    "B7 figure eight": (
        rail(CIRCLE, curve=LOOP, divide={"nodes": 20}),
        ("E-CURVE-LOOP", "rail.curve", r"turns round 0\.0000 times", "once", "without crossings"),
    ),
    "B7 open that closes": (
        rail(SMALL, curve={"kind": "spline", "points": [[0, 0], [4000, 3000], [8000, 0], [4000, -3000], [0, 0]]}),
        ("E-CURVE-CLOSED", "rail.curve", "an open curve whose ends meet", "1e-06 mm", "closed = true"),
    ),
    "B8 angle": (
        rail(CIRCLE, divide={"angle_deg": 7}),
        ("E-CURVE-ANGLE", "rail.divide.angle_deg", "7° on a closed curve", "360°", r"6\.923077°, 7\.058824°"),
    ),
    "B8 count": (
        rail(CIRCLE, divide={"nodes": 2}),
        ("E-CURVE-COUNT", "rail.divide.nodes", "2 nodes", "at least 3", "more nodes"),
    ),
    "B9 too coarse": (
        rail(SMALL, divide={"nodes": 1}),
        ("E-CURVE-ANGLE", "rail.divide", r"100\.3\d+°", r"max_turning_deg = 60°", "more nodes"),
    ),
    "B10 deviation": (
        changed(SMALL, tolerances={"max_deviation": 1}),
        ("E-DEVIATION", "rail.divide", r"up to \d+\.\d{3} mm off", "max_deviation = 1 mm", "more nodes"),
    ),
    "B11 points in space": (
        changed(rail(SMALL, curve={"kind": "spline", "points": [[0, 0, 0], [4000, 3000, 1], [8000, 0, 0]]})),
        ("E-CURVE-SPATIAL", "rail.curve.points", "three coordinates", r"\[x, y\]", "'monge'"),
    ),
    "B12 frame": (
        rail(MONGE, curve=RING),
        ("E-RAIL-TWIST", "rail.curve", r"turned by -?\d+\.?\d*°: a gap of \d+\.?\d* mm", "0.01 mm", "closed = false"),
    ),
    "B13 antiparallel": (
        rail(MONGE, curve={"kind": "polyline", "points": [[0, 0, 0], [3000, 0, 0], [1000, 0, 0], [4000, 3000, 0]]}),
        ("E-RAIL-BACK", "rail.curve", r"vertex 1 at \(3000\.000, 0\.000, 0\.000\) mm", "bisecting plane", "Redraw"),
    ),
    "B15 panels": (
        changed(SMALL, limits={"max_panels": 10}),
        ("E-SIZE", "limits.max_panels", "at least 12 panels", "10", "more coarsely"),
    ),
    "B15 panels of caps": (
        changed(
            CIRCLE,
            generatrix={"curve": {"kind": "arc", "radius": 10_000, "start_deg": 0, "end_deg": 90}},
            surface={"pole": "cap", "min_pole_angle_deg": 25},
            limits={"max_panels": 144},
        ),
        ("E-SIZE", "limits.max_panels", "145 panels", "144", "more coarsely"),
    ),
    "B15 members": (
        changed(SMALL, tolerances={"min_member": 3000}),
        ("E-SURFACE-SHORT", "min_member|generatrix", r"\d+\.\d{3} mm", "3000 mm", "coarsely|fewer nodes"),
    ),
    "B15 set-backs": (
        changed(SMALL, members={"min_clear": "3 m"}),
        ("E-MEMBER-SHORT", r"members \(M", r"\d+\.\d{3} mm of a system line", "min_clear = 3000 mm", "min_clear"),
    ),
    "C1 pole": (
        changed(sphere(5, 89), tolerances={"min_member": 0.1}),
        ("E-GENERATRIX-POLE", "generatrix.curve", r"1\.0000° .*\d+ rows .* \d+\.\d mm high", "= 5°", "latitude is 85°"),
    ),
    "C2 straight": (
        generatrix(CIRCLE, curve={"kind": "polyline", "points": [[0, 0], [0, 5000]]}, origin=[0, 0]),
        ("E-CURVE-STRAIGHT", "generatrix.curve", "straight line", "paper §4.3", "divide.stations"),
    ),
    "C3 kink": (
        generatrix(EDGE_OFFSET_VAULT, curve=KINKED, flat_nodes=False),
        ("E-CURVE-KINK", "generatrix.curve", r"53\.130102° at \(\S+, \S+\) mm", "1e-9 rad", "Fillet it"),
    ),
    "C3 noise": (
        generatrix(changed(EDGE_OFFSET_VAULT, rail={"divide": {"nodes": 3}}), curve=FLICKERING, flat_nodes=False),
        ("E-CURVE-NOISE", "generatrix.curve", r"\d+ arcs .* mm", "does not flicker", "Refit"),
    ),
    "C5 crossing": (
        changed(
            SMALL, generatrix={"curve": CROSSED, "axes": "dz", "origin": ["10 m", 0], **AS_DRAWN}, **MOULDING
        ),
        ("E-CURVE-CROSSING", "generatrix.curve", r"edges 0 and 2 meet at \(.*\) mm", "crossings", "Redraw"),
    ),
    "C5 no plane": (
        generatrix(SMALL, curve={"kind": "dxf", "file": "a.dxf", "layer": "X", "drawn": "world"}),
        ("E-DRAWN-PLANE", "generatrix.curve.drawn", '"world"', "a plane to project on", "flat"),
    ),
    "C6 flip": (
        generatrix(VAULT, origin=["-9 m", 0]),
        (
            "E-SURFACE-FLIP",
            "generatrix.curve",
            r"parallel \d+ flips to -\d+\.\d{3} mm in strip \d+: its offset from the rail is -\d+\.\d{3} mm",
            r"at least -\d+\.\d{3} mm",
            "generatrix.origin",
        ),
    ),
    "C6 short": (
        generatrix(changed(SMALL, tolerances={"min_member": 1000}), origin=["-1.5 m", 0]),
        ("E-SURFACE-SHORT", "min_member", r"parallel 5 shrinks to 705\.882 mm", r"-\d+\.\d{3} mm .* 1000 mm", "origin"),
    ),
    "C7 beams flip": (
        changed(VAULT, members={"section": {"kind": "plate", "depth": 9000, "thickness": 10}}),
        ("E-SURFACE-FLIP", "generatrix.curve|members", r"\d+\.\d{3} mm", "at least|positive", "."),
    ),
    "C9 sliver": (
        wall(2000, 2000.5),
        ("E-PANEL-SLIVER", "panel of row 1, strip 0", r"a side of 0\.500 mm", "at least 1 mm", "more coarsely"),
    ),
    "C10 clash": (
        rail(MONGE, curve={"kind": "polyline", "points": HELIX}, up=[-1, 0, 0]),
        ("E-SURFACE-CLASH", "generatrix.curve", r"\d+\.\d{3} mm deep", "stay apart", "Part the curves"),
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_refused_with_value_limit_and_way_out(case):
    data, expected = REFUSED[case]
    with pytest.raises(Refused) as refusal:
        design(data)
    said = refusal.value
    assert said.code == expected[0]
    for words, text in zip(expected[1:], (said.field, said.found, said.limit, said.way_out), strict=True):
        assert re.search(words, text), str(said)
        assert text in str(said)


NOTED = {
    "B2 long edges": (rail(VAULT, max_edge=1000), "W-CURVE-LONG", r"\d+ edges .* 1000 mm"),
    "B2 flat nodes": (
        changed(EDGE_OFFSET_VAULT, rail={"curve": STRETCHED, "divide": {"nodes": 9}, "max_edge": "2 m"}),
        "W-RAIL-FLAT",
        r"\d flat rail nodes: .* up to 1\.543 mm apart",
    ),
    "B4 leftover": (
        generatrix(VAULT, divide={"angle_deg": 5}, inflections="residual", flat_nodes=False),
        "W-CURVE-LEFTOVER",
        r"nodes of \d\.\d{4}° at \d",
    ),
    "B9 coarse": (rail(SMALL, curve=ARC, divide={"angle_deg": 40}), "W-RAIL-COARSE", r"40\.00° .* more than 30°"),
    "C1 open": (
        changed(
            CIRCLE,
            generatrix={"curve": {"kind": "arc", "radius": 10_000, "start_deg": 0, "end_deg": 90}},
            surface={"pole": "open", "min_pole_angle_deg": 25},
        ),
        "W-GENERATRIX-POLE",
        "nearer than 25°",
    ),
    "C5 overhang": (
        generatrix(
            SMALL, curve={**ARC, "radius": 1500, "start_deg": -120, "end_deg": 50}, axes="dz", divide={"nodes": 8}
        ),
        "W-GENERATRIX-OVERHANG",
        r"\d of \d rows hang over",
    ),
    "C9 slender": (
        changed(SMALL, generatrix={"curve": {"kind": "arc", "span": "60 m", "rise": "6 m"}, "divide": {"nodes": 1}}),
        "W-PANEL-SLIVER",
        "sides more than 20 times as long",
    ),
}


@pytest.mark.parametrize("case", NOTED)
def test_noted_with_value(case):
    data, code, words = NOTED[case]
    assert any(note.code == code and re.search(words, note.text) for note in design(data).notes)


def test_every_row_is_provoked_or_proved():
    """Rows without a case here are answered by checks of the certificate alone: tests/verify has their faults."""
    page = Path(__file__).parents[2] / "docs" / "failure-modes.md"
    rows = dict(re.findall(r"^\| ([BC]\d+) \|.*\| ([^|]+) \|$", page.read_text("utf-8"), re.M))
    provoked = {case.split()[0] for case in (*REFUSED, *NOTED)}
    proved = {row for row, answer in rows.items() if not re.search(r"\b[EW]-", answer)}
    assert provoked | proved == set(rows)
    assert not provoked & proved
    codes = {code for row in provoked for code in re.findall(r"[EW]-[A-Z-]+[A-Z]", rows[row])}
    assert codes - {expected[0] for _, expected in REFUSED.values()} - {code for _, code, _ in NOTED.values()} == set()
