"""The same meshes once more, at fifty digits and by other formulas: closed-form tangencies, intersected offset lines.

Nothing here is the program's: tangency points are inverted derivatives, nodes are where the offset tangent lines of
neighbouring rail edges meet, at the level that the profile's own lines meet at.
"""

import itertools

import pytest
from mpmath import acos, atan, atanh, cos, mp, mpf, pi, sin, tan, tanh

from museum import EDGE_OFFSET_VAULT, VAULT, changed, design, sphere

mp.dps = 50


def meet(one, other):
    """Intersection of two lines, each a point and a direction angle."""
    (x1, y1, a1), (x2, y2, a2) = one, other
    reach = ((x2 - x1) * sin(a2) - (y2 - y1) * cos(a2)) / sin(a2 - a1)
    return x1 + reach * cos(a1), y1 + reach * sin(a1)


def foot(line, point):
    x, y, a = line
    along = (point[0] - x) * cos(a) + (point[1] - y) * sin(a)
    return x + along * cos(a), y + along * sin(a)


def shifted(line, offset):
    """The line moved to its right."""
    x, y, a = line
    return x + offset * sin(a), y - offset * cos(a), a


def parabola_lines(span, rise, count):
    """Tangents of the arch from right to left, outside above, with steps of one angle."""
    steepest = atan(4 * mpf(rise) / span)
    lines = []
    for k in range(count + 1):
        slope = tan(-steepest + 2 * steepest * k / count)
        x = -slope * mpf(span) ** 2 / (8 * mpf(rise))
        lines.append((x, rise * (1 - (2 * x / span) ** 2), pi - steepest + 2 * steepest * k / count))
    return lines


def sine_tangent(amplitude, wavelength, arc, slope_angle):
    """Tangent of the wave, drawn along z, on its arc number `arc`, where dd/dz = tan(slope_angle)."""
    wave = 2 * pi / mpf(wavelength)
    phase = acos(tan(slope_angle) / (amplitude * wave))
    phase = phase + pi * arc if arc % 2 == 0 else -phase + pi * (arc + 1)
    return amplitude * sin(phase), phase / wave, pi / 2 - slope_angle


def vault_profile():
    """Oracle C: seven nodes on every arc and flat ones between."""
    steepest = atan(2 * pi * 1000 / mpf(12000))
    vertices = [(mpf(0), mpf(0))]
    for arc in range(4):
        turn = -1 if arc % 2 == 0 else 1
        angles = [-turn * steepest + turn * 2 * steepest * k / 7 for k in range(8)]
        lines = [sine_tangent(1000, 12000, arc, angle) for angle in angles]
        vertices += [meet(a, b) for a, b in itertools.pairwise(lines)]
        vertices.append((mpf(0), mpf(6000) * (arc + 1)))
    return vertices


def compare(result, lines, ends, profile, plane):
    """Largest distance of the program's nodes from those at fifty digits, over a sample of them."""
    parallels, generatrices = result.kit.mesh.shape
    nodes = result.kit.mesh.nodes.reshape(parallels, generatrices, 3)
    assert len(profile) == parallels
    worst = mpf(0)
    for i in range(0, parallels, 3):
        d, z = profile[i]
        moved = [shifted(line, d) for line in lines]
        inner = [meet(a, b) for a, b in itertools.pairwise(moved)]
        row = inner if ends is None else [ends[0](moved[0], d), *inner, ends[1](moved[-1], d)]
        for j in range(0, generatrices, 2):
            exact = plane(row[j], z)
            worst = max(worst, *(abs(mpf(float(a)) - b) for a, b in zip(nodes[i, j], exact, strict=True)))
    return worst


def upright(point, z):
    return point[0], -z, point[1]


def square(end):
    return lambda line, d: foot(line, end)


def mitred(end, turning, sign):
    """As if the rail went on turning: the foot moves along the edge by d·tan(α/2)."""

    def place(line, d):
        x, y = foot(line, end)
        reach = sign * d * tan(turning / 2)
        return x + reach * cos(line[2]), y + reach * sin(line[2])

    return place


ENDS = ((mpf(10000), mpf(0)), (mpf(-10000), mpf(0)))


def test_vault():
    lines = parabola_lines(20000, 7500, 18)
    ends = (square(ENDS[0]), square(ENDS[1]))
    assert compare(design(VAULT), lines, ends, vault_profile(), upright) < mpf("1e-9")


def koebe(turning, start, index):
    return 2 * atan(tanh(start + index * atanh(sin(turning / 2))))


def sphere_profile(turning, band, radius):
    """Tangents of the meridian with the slopes of the Koebe mesh, one edge astride the equator."""
    start = -atanh(sin(turning / 2)) / 2
    slopes = []
    for k in range(-60, 60):
        slope = (koebe(turning, start, k) + koebe(turning, start, k + 1)) / 2
        if abs(slope) <= band:
            slopes.append(slope)
    lines = [(radius * cos(m) - radius, radius * sin(m), m + pi / 2) for m in slopes]
    tips = [(radius * cos(band) - radius, side * radius * sin(band)) for side in (-1, 1)]
    inner = [meet(a, b) for a, b in itertools.pairwise(lines)]
    return [foot(lines[0], tips[0]), *inner, foot(lines[-1], tips[1])]


@pytest.mark.parametrize(("angle", "band"), [(5, 60), (15, 30)])
def test_edge_offset_sphere(angle, band):
    radius, turning = mpf(10000), pi * angle / 180
    count = 360 // angle
    lines = [(radius * sin(k * turning), -radius * cos(k * turning), k * turning) for k in range(-1, count)]
    profile = sphere_profile(turning, pi * band / 180, radius)
    worst = compare(design(sphere(angle, band)), lines, None, profile, lambda point, z: (*point, z))
    assert worst < mpf("1e-9")


def test_edge_offset_arch():
    """An open rail with mitred ends, and a generatrix without inflection."""
    data = changed(
        EDGE_OFFSET_VAULT,
        generatrix={
            "curve": {"kind": "arc", "radius": 9000, "start_deg": -40, "end_deg": 40},
            "origin": [-9000, 0],
            "axes": "dz",
            "flat_nodes": False,
        },
    )
    steepest = atan(mpf(4) * 7500 / 20000)
    turning = 2 * steepest / 18
    lines = parabola_lines(20000, 7500, 18)
    ends = (mitred(ENDS[0], turning, -1), mitred(ENDS[1], turning, 1))
    profile = sphere_profile(turning, pi * 40 / 180, mpf(9000))
    assert compare(design(data), lines, ends, profile, upright) < mpf("1e-9")


def test_slopes_touch_the_sphere():
    """The recurrence of the latitudes against its defining equation, sin((λ'−λ)/2) = s·cos((λ'+λ)/2)."""
    turning = pi / 15
    for k in range(-20, 20):
        low, high = koebe(turning, mpf("0.013"), k), koebe(turning, mpf("0.013"), k + 1)
        assert abs(sin((high - low) / 2) - sin(turning / 2) * cos((high + low) / 2)) < mpf("1e-45")
