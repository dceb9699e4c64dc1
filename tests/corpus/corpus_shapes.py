"""The shapes of the corpus: what is drawn, and what length and area it has by construction.

Entities are lists: ["line", x, y, x, y], ["arc", x, y, radius, start, end] in degrees, counter-clockwise,
["circle", x, y, radius], ["ellipse", x, y, a, b, turn, start, end] with parameters in radians,
["polyline", points, closed] and ["spline", points], a clamped cubic of uniform knots.
"""

from dataclasses import dataclass
from itertools import pairwise
from math import cos, hypot, pi, radians, sin
from typing import Any

import numpy as np
from scipy.integrate import quad
from scipy.interpolate import BSpline

Entity = list[Any]


@dataclass(frozen=True)
class Drawn:
    """Entities, mm, that make loops and open curves: the sorted lengths of all, whether all are closed, net area."""

    entities: list[Entity]
    lengths: list[float]
    closed: bool
    area: float | None = None


def length_of(entity: Entity) -> float:
    kind, *rest = entity
    match kind:
        case "line":
            return hypot(rest[2] - rest[0], rest[3] - rest[1])
        case "arc":
            return rest[2] * radians((rest[4] - rest[3]) % 360)
        case "circle":
            return 2 * pi * rest[2]
        case "ellipse":
            a, b, start, end = rest[2], rest[3], rest[5], rest[6]
            return quad(lambda t: hypot(a * sin(t), b * cos(t)), start, end, epsabs=1e-10)[0]
        case "polyline":
            points = rest[0] + (rest[0][:1] if rest[1] else [])
            return sum(hypot(q[0] - p[0], q[1] - p[1]) for p, q in pairwise(points))
        case _:
            way = spline(rest[0]).derivative()
            marks = [k / (len(rest[0]) - 3) for k in range(len(rest[0]) - 2)]
            spans = pairwise(marks)
            return sum(quad(lambda t: hypot(*way(t)), low, high, epsabs=1e-10)[0] for low, high in spans)


def spline(points: list[list[float]]) -> BSpline:
    inner = np.linspace(0, 1, len(points) - 2)
    return BSpline(np.concatenate([[0] * 3, inner, [1] * 3]), np.array(points), 3)


def turned(points: list[list[float]], degrees: float) -> list[list[float]]:
    c, s = cos(radians(degrees)), sin(radians(degrees))
    return [[c * x - s * y, s * x + c * y] for x, y in points]


def one(entities: list[Entity], *, closed: bool, area: float | None = None) -> Drawn:
    return Drawn(entities, [sum(map(length_of, entities))], closed, area)


def rounded(width: float, height: float, radius: float, degrees: float) -> list[Entity]:
    """A rectangle with round corners, turned about the origin."""
    w, h, r = width, height, radius
    straight = [[r, 0, w - r, 0], [w, r, w, h - r], [w - r, h, r, h], [0, h - r, 0, r]]
    centres = [[w - r, r], [w - r, h - r], [r, h - r], [r, r]]
    lines = [["line", *turned([line[:2]], degrees)[0], *turned([line[2:]], degrees)[0]] for line in straight]
    arcs = [
        ["arc", *turned([centre], degrees)[0], r, (start + degrees) % 360, (start + degrees + 90) % 360]
        for centre, start in zip(centres, (-90, 0, 90, 180), strict=True)
    ]
    return [entity for pair in zip(lines, arcs, strict=True) for entity in pair]


ELL = [[0, 0], [900, 0], [900, 250], [300, 250], [300, 700], [0, 700]]
FOLDED = [[0, 0], [2400, 700], [5200, 1100], [8100, 600], [9900, -300]]
WAVES = [[0, 0], [3000, 2600], [7000, 3100], [11000, -1500], [15000, -900], [18000, 1700]]
CUT_OUT = (150, 250, 60), (600, 250, 90)
_HALF = 8000 * cos(radians(35)), 8000 * sin(radians(35))

SHAPES = {
    "rail": one(
        [
            ["line", -_HALF[0] - 3000 * sin(radians(35)), _HALF[1] - 3000 * cos(radians(35)), -_HALF[0], _HALF[1]],
            ["arc", 0, 0, 8000, 35, 145],
            ["line", *_HALF, _HALF[0] + 3000 * sin(radians(35)), _HALF[1] - 3000 * cos(radians(35))],
        ],
        closed=False,
    ),
    "plate": one(rounded(1200, 700, 80, 17), closed=True, area=1200 * 700 - (4 - pi) * 80**2),
    "circle": one([["circle", 1500, 400, 1250]], closed=True, area=pi * 1250**2),
    "arc": one([["arc", 0, 0, 9000, 200, 340]], closed=False),
    "folded": one([["polyline", FOLDED, False]], closed=False),
    "ell": one([["polyline", turned(ELL, 30), True]], closed=True, area=900 * 250 + 300 * 450),
    "waves": one([["spline", WAVES]], closed=False),
    "oval": one([["ellipse", 200, 100, 2600, 1400, 0.4, 0, 2 * pi]], closed=True, area=pi * 2600 * 1400),
    "arch": one([["ellipse", 0, 0, 7000, 4200, 0, 0, pi]], closed=False),
    "lines": one(
        [["line", *p, *q] for p, q in pairwise(FOLDED)][::-1],
        closed=False,
    ),
    "holes": Drawn(
        [
            ["polyline", [[0, 0], [800, 0], [800, 500], [0, 500]], True],
            ["circle", 150, 250, 60],
            ["circle", 600, 250, 90],
        ],
        sorted([2600, 120 * pi, 180 * pi]),
        True,
        800 * 500 - pi * (60**2 + 90**2),
    ),
}
"""Rails and parts that every program draws as far as it can."""


def polygon_of(radius: float, count: int) -> tuple[float, float]:
    """Perimeter and area of the polygon that a circle becomes in OpenSCAD."""
    return 2 * count * radius * sin(pi / count), count / 2 * radius**2 * sin(2 * pi / count)


_FINE, _HOLE = polygon_of(1250, 64), polygon_of(90, 48)

SCAD = {
    "square": ("square([800, 300]);", Drawn([], [2200], True, 240_000)),
    "circle": ("translate([100, 50]) circle(r = 1250, $fn = 64);", Drawn([], [_FINE[0]], True, _FINE[1])),
    "ell": (f"rotate(30) polygon({ELL});", Drawn([], [3200], True, 360_000)),
    "plate": (
        "difference() { square([800, 500]); translate([600, 250]) circle(r = 90, $fn = 48); }",
        Drawn([], sorted([2600, _HOLE[0]]), True, 400_000 - _HOLE[1]),
    ),
    "two": ("square([300, 200]); translate([500, 0]) square([150, 150]);", Drawn([], [600, 1000], True)),
    "slope": (
        "polygon([[0, 0], [1200, 100], [1100, 640.5], [150, 500]]);",
        one([["polyline", [[0, 0], [1200, 100], [1100, 640.5], [150, 500]], True]], closed=True, area=556_262.5),
    ),
}
"""Programs of OpenSCAD, and what they draw."""

_SVG = '<svg xmlns="http://www.w3.org/2000/svg" width="900mm" height="600mm" viewBox="0 0 900 600">{}</svg>'
_STYLE = 'fill="none" stroke="#000"'
INK = {
    "square": (f'<path {_STYLE} d="M 10 10 H 410 V 210 H 10 Z"/>', Drawn([], [1200], True, 80_000)),
    "open": (f'<path {_STYLE} d="M 10 10 L 310 410 L 610 10"/>', Drawn([], [1000], False)),
    "circle": (f'<circle {_STYLE} cx="300" cy="250" r="200"/>', Drawn([], [400 * pi], True)),
    "line": (f'<path {_STYLE} d="M 0 0 L 300 400"/>', Drawn([], [500], False)),
    "bezier": (
        f'<path {_STYLE} d="M 50 400 C 200 50 500 50 700 400"/>',
        Drawn(
            [],
            [
                quad(
                    lambda t: hypot(
                        450 * (1 - t) ** 2 + 1800 * (1 - t) * t + 600 * t**2, -1050 * (1 - t) ** 2 + 1050 * t**2
                    ),
                    0,
                    1,
                )[0]
            ],
            False,
        ),
    ),
    "turned": (
        f'<path {_STYLE} transform="rotate(20)" d="M 200 20 H 500 V 120 H 200 Z"/>',
        Drawn([], [800], True, 30_000),
    ),
    "two": (
        f'<path {_STYLE} d="M 10 10 H 110 V 110 H 10 Z"/><path {_STYLE} d="M 200 10 H 500 V 60 H 200 Z"/>',
        Drawn([], [400, 700], True),
    ),
}
"""Drawings of Inkscape, mm, and what they show."""


def svg_of(body: str) -> str:
    return _SVG.format(body)
