"""Section 8 of docs/worked-example.md: other details on flat arms, in plain arithmetic."""

from math import acos, ceil, cos, hypot, pi, radians, sin, sqrt, tan

STEEL = 7850e-9
HOLE = 30 - 12 - 2.5 + 3 * 1.75
ENDS = (12 + 6) / (2 * sin(pi / 4)), 10 + 8.0
S = float(max(ceil(max(ENDS) + HOLE), (25 + 3) / tan(pi / 4)))
DRUM = 5.0 * ceil(2 * hypot(S, 28) / 5), 100 + 2 * 3.0
TUBE = 100 * 50 - 92 * 42 - (4 - pi) * (8**2 - 4**2)
END_PLATE = 12 * (92 * 42 - (4 - pi) * 4**2 - 2 * pi / 4 * 13**2)
OPENING = pi / 4 * 25**2 + 25 * (30 + 7.5 + 10 - 25)
NOTCH = sqrt(35**2 - 6**2) - 0.5, 40.5, 6.5
CAP = pi * (8 * (45**2 - 6.5**2) + 6 * (40**2 - 35**2))
BASE = (220 * 210 - 4 * pi / 4 * 18**2) * 15 + 0.9 * 100 * 10 * 15


def drum_volume() -> float:
    """Round, with four facets, a bore and eight threaded holes; mm³."""
    radius = DRUM[0] / 2
    angle = 2 * acos(S / radius)
    segment = radius**2 / 2 * (angle - sin(angle))
    return (pi * (radius**2 - 10**2) - 4 * segment) * DRUM[1] - 8 * pi * 6**2 * HOLE


def tube_volume(length: float) -> float:
    """A member of some system length between two such nodes, mm³."""
    return TUBE * (length - 2 * S) - 4 * 4 * OPENING + 2 * END_PLATE


def detail_steps() -> dict[str, list[float]]:
    return {
        "hole": [HOLE],
        "its end": [*ENDS],
        "s": [S],
        "drum": [*DRUM],
        "drum volume": [drum_volume()],
        "tube": [TUBE],
        "end plate": [END_PLATE],
        "opening": [OPENING],
        "tube cut": [1000 - 2 * S],
        "tube mass": [tube_volume(1000) * STEEL],
        "notch": [*NOTCH],
        "hook": [NOTCH[0] - 20],
        "cap": [CAP * STEEL],
        "bolt": [200 + 2 * 8 + 2 * 2.5 + 10.8 + 2 * 1.75],
        "level": [45 + 10],
        "plate": [100 + 2 * 60, 90 + 2 * 60],
        "base holes": [220 / 2 - 30, 210 / 2 - 30],
        "base mass": [BASE * STEEL],
        "sill set-back": [45 * cos(radians(30)) + 100 * sin(radians(30)) + 2],
    }
