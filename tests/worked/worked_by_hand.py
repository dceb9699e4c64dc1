"""The worked example of docs/worked-example.md once more: plain Python, nothing of the program.

Written from docs/geometry.md and docs/fabrication.md. Lengths in mm, angles in radians. Node (i, j) lies on
parallel i and generatrix j; a direction is a step (di, dj).
"""

from functools import cache
from math import acos, asin, atan, atan2, ceil, cos, dist, floor, pi, sin, sqrt, tan

SPAN, RISE, INNER = 24000.0, 9000.0, 18
AMPLITUDE, WAVELENGTH, WAVES, PER_ARC = 1000.0, 14000.0, 2, 8
DEPTH, THICK, SECTION, GRADE, STEEL = 200.0, 12.0, "FL200*12", "S355", 7850.0
CLEARANCE, END_GAP, BORE, MIN_CORE, MIN_WEB = 0.5, 2.0, 20.0, 8.0, 6.0
STEP, BAR_ALLOWANCE, FACING = 5.0, 2.0, 4.0
GLASS, GLASS_DENSITY, GAP, SPACER, SEAT_WIDTH, SEAT_HEIGHT = 13.5, 2500.0, 16.0, 3.0, 60.0, 10.0
GLASS_ROUND, GLASS_MIN = 10.0, 0.3

ROWS, STRIPS = 2 * WAVES * PER_ARC + 1, INNER + 1
ALPHA = 2 * atan(4 * RISE / SPAN) / INNER
WAVE = 2 * pi / WAVELENGTH
PHI0 = atan(AMPLITUDE * WAVE)
BETA = 2 * PHI0 / PER_ARC
COMPASS = ((1, 0), (0, -1), (-1, 0), (0, 1))  # counter-clockwise from outside
CORNERS = ((0, 0), (0, 1), (1, 1), (1, 0))


def plus(a, b, k=1.0):
    return tuple(x + k * y for x, y in zip(a, b, strict=True))


def times(k, a):
    return tuple(k * x for x in a)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b, strict=True))


def cross(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def unit(a):
    return times(1 / sqrt(dot(a, a)), a)


# The two curves and their tangent polygons


def psi(k):
    """Slope angle of edge k of the arch; the arch runs from right to left, so that outside is up."""
    return -atan(4 * RISE / SPAN) + k * ALPHA


def contact(k):
    """Abscissa where edge k touches the parabola y = RISE - x²/(2p)."""
    return -(SPAN**2) / (8 * RISE) * tan(psi(k))


def arch_node(j):
    before, after = contact(max(j - 1, 0)), contact(min(j, INNER))
    return (before + after) / 2, RISE - before * after / (SPAN**2 / (4 * RISE))


def mitre(j):
    if j in (0, STRIPS):
        end = psi(min(j, INNER))
        return -sin(end), cos(end)
    middle = psi(j - 0.5)
    return -sin(middle) / cos(ALPHA / 2), cos(middle) / cos(ALPHA / 2)


def phi(k):
    """Slope angle of edge k of the wave: down the peaks and up the valleys, a step each."""
    arc, step = divmod(k, PER_ARC)
    return (1 - 2 * (arc % 2)) * (PHI0 - step * BETA)


def touch(k):
    """Where edge k touches the wave d = AMPLITUDE sin(WAVE z): (d, z)."""
    arc, step = divmod(k, PER_ARC)
    u = acos(min(1.0, tan(PHI0 - step * BETA) / tan(PHI0))) + arc * pi
    return AMPLITUDE * sin(u), u / WAVE


@cache
def profile_vertex(i):
    if i in (0, ROWS):
        return touch(min(i, ROWS - 1))
    (d0, z0), (d1, z1), t0, t1 = touch(i - 1), touch(i), tan(phi(i - 1)), tan(phi(i))
    z = (d1 - d0 + z0 * t0 - z1 * t1) / (t0 - t1)
    return d0 + (z - z0) * t0, z


def profile_offset(i):
    """Vertex i (a, b) of the polygon around the unit circle whose sides have the normals of the wave's edges."""
    before, after = -phi(max(i - 1, 0)), -phi(min(i, ROWS - 1))
    middle, half = (before + after) / 2, (after - before) / 2
    return cos(middle) / cos(half), sin(middle) / cos(half)


# The surface


@cache
def node(i, j):
    (x, y), (p, q), (d, z) = arch_node(j), mitre(j), profile_vertex(i)
    return x + d * p, -z, y + d * q


@cache
def offset(i, j):
    (p, q), (a, b) = mitre(j), profile_offset(i)
    return a * p, -b, a * q


def axis(i, j):
    return unit(offset(i, j))


def inside(i, j):
    return 0 <= i <= ROWS and 0 <= j <= STRIPS


def edge(i, j, di, dj):
    """Length and unit direction of the system line from node (i, j)."""
    line = plus(node(i + di, j + dj), node(i, j), -1)
    return sqrt(dot(line, line)), unit(line)


@cache
def elevation(i, j, di, dj):
    return asin(dot(edge(i, j, di, dj)[1], axis(i, j)))


def flat_direction(i, j, di, dj):
    """Unit direction of an arm's projection onto the plane perpendicular to the node axis."""
    along, up = edge(i, j, di, dj)[1], axis(i, j)
    return unit(plus(along, up, -dot(along, up)))


def azimuth_between(i, j, first, second):
    a, b = flat_direction(i, j, *first), flat_direction(i, j, *second)
    return atan2(dot(cross(a, b), axis(i, j)), dot(a, b)) % (2 * pi)


@cache
def arms(i, j):
    """Directions of the arms of a node, arm 1 first: the start from which it reads smallest."""
    there = [way for way in COMPASS if inside(i + way[0], j + way[1])]
    return min(starts(there), key=lambda ways: sequence(i, j, ways))


def starts(ways):
    return [ways[k:] + ways[:k] for k in range(len(ways))]


def reading(i, j, ways):
    """Gaps to the next azimuths, elevations and families (generatrix before parallel) of the arms of a node."""
    return arm_gaps(i, j, ways), [elevation(i, j, *way) for way in ways], [abs(way[1]) for way in ways]


def sequence(i, j, ways, read=reading):
    """A reading arm by arm, for comparison: less than 1e-6 rad is noise. All sections are the same."""
    return [round(value, 6) for arm in zip(*read(i, j, ways), strict=True) for value in arm]


def arm_gaps(i, j, ways):
    """Azimuth from each arm to the next."""
    return [azimuth_between(i, j, a, b) for a, b in zip(ways, ways[1:] + ways[:1], strict=True)]


def azimuths(i, j):
    return [azimuth_between(i, j, arms(i, j)[0], way) if way != arms(i, j)[0] else 0.0 for way in arms(i, j)]


def mismatch(i, j):
    meets = [DEPTH / 2 / cos(elevation(i, j, *way)) for way in arms(i, j)]
    return max(meets) - min(meets)


def torsion(i, j):
    """Largest angle between the axis of a neighbour and the plane of the member and this node's axis."""
    normals = [(unit(cross(axis(i, j), edge(i, j, *way)[1])), way) for way in arms(i, j)]
    return max(abs(asin(dot(normal, axis(i + way[0], j + way[1])))) for normal, way in normals)


# Drums


def drum_radius():
    """Smallest drum that suits every node, its diameter rounded up to STEP."""
    slot, width = END_GAP + max(25.0, 2 * THICK), THICK + CLEARANCE
    floors = [BORE / 2 + MIN_CORE]
    gaps = [gap for i in range(ROWS + 1) for j in range(STRIPS + 1) for gap in arm_gaps(i, j, arms(i, j))]
    floors += [(MIN_WEB / 2 + width / 2 * cos(gap / 2)) / sin(gap / 2) for gap in gaps]
    return STEP * ceil(round(2 * (max(floors) + slot) / STEP, 9)) / 2


RADIUS = drum_radius()
FLOOR = RADIUS - (END_GAP + max(25.0, 2 * THICK))
PLATE_END, SHOULDER = FLOOR + END_GAP, RADIUS + END_GAP


@cache
def drum_height(i, j):
    angles = [elevation(i, j, *way) for way in arms(i, j)]
    exact = 2 * min(DEPTH / 2 / cos(e) - SHOULDER * tan(abs(e)) for e in angles)
    return floor(exact * 1000 + 1e-6) / 1000


def facets(radius):
    return 4 * ceil(pi / acos(1 - 0.002 / max(radius, 1.0)) / 4)


def regular_polygon(radius):
    count = facets(radius)
    return [(radius * cos(2 * pi * k / count), radius * sin(2 * pi * k / count)) for k in range(count)]


def turn(point, angle):
    return point[0] * cos(angle) - point[1] * sin(angle), point[0] * sin(angle) + point[1] * cos(angle)


def area(polygon):
    return sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(polygon, polygon[1:] + polygon[:1], strict=True)) / 2


def perimeter(polygon):
    return sum(dist(a, b) for a, b in zip(polygon, polygon[1:] + polygon[:1], strict=True))


def clip(polygon, axis_no, sign, limit):
    """Keep the part of a convex polygon where sign × coordinate ≤ limit."""
    kept = []
    for a, b in zip(polygon, polygon[1:] + polygon[:1], strict=True):
        s, t = sign * a[axis_no] - limit, sign * b[axis_no] - limit
        if s <= 0:
            kept.append(a)
        if s * t < 0:
            kept.append((a[0] + (b[0] - a[0]) * s / (s - t), a[1] + (b[1] - a[1]) * s / (s - t)))
    return kept


def slot_piece(azimuth):
    """What a slot takes out of the drum's polygon: its area, and how much outline it adds to the drum's own."""
    half = (THICK + CLEARANCE) / 2
    piece = [turn(point, -azimuth) for point in regular_polygon(RADIUS)]
    for axis_no, sign, limit in ((0, -1, -FLOOR), (1, 1, half), (1, -1, half)):
        piece = clip(piece, axis_no, sign, limit)
    walls = [max(x for x, y in piece if abs(y - side) < 1e-9) - FLOOR for side in (half, -half)]
    rim = perimeter(piece) - 2 * half - sum(walls)
    return area(piece), 2 * half + sum(walls) - rim


def drum_section(i, j):
    """Area and outline length of a drum's cross-section, with bore and slots."""
    disc, hole, slots = regular_polygon(RADIUS), regular_polygon(BORE / 2), map(slot_piece, azimuths(i, j))
    areas, lengths = zip(*slots, strict=True)
    return area(disc) - area(hole) - sum(areas), perimeter(disc) + perimeter(hole) + sum(lengths)


# Members


def end_profile(i, j, di, dj):
    """End of a plate, bottom up, x along the system line from the node, y to the outside."""
    e, half = elevation(i, j, di, dj), drum_height(i, j) / 2
    low, high = (SHOULDER * tan(e) + side * DEPTH / 2 / cos(e) for side in (-1, 1))
    inner = [(PLATE_END, -half), (PLATE_END, half)]
    below = [(SHOULDER, low)] + ([(SHOULDER, -half)] if -half - low > 0.002 else [])
    above = ([(SHOULDER, half)] if high - half > 0.002 else []) + [(SHOULDER, high)]
    return [(r * cos(e) + z * sin(e), z * cos(e) - r * sin(e)) for r, z in below + inner + above]


def member_angles(i, j, di, dj):
    """Elevations at the two ends of a member, each measured at its own node."""
    return elevation(i, j, di, dj), elevation(i + di, j + dj, -di, -dj)


def member_outline(i, j, di, dj):
    """Outline of the plate from node (i, j), before rounding: start end from the top, then end from the bottom."""
    length = edge(i, j, di, dj)[0]
    end = [(length - x, y) for x, y in end_profile(i + di, j + dj, -di, -dj)]
    return end_profile(i, j, di, dj)[::-1] + end


def rounded(outline):
    return [(round(x, 3), round(y, 3)) for x, y in outline]


# Panels


def panel_corners(i, j):
    return [(i + di, j + dj) for di, dj in CORNERS]


def panel_normal(i, j):
    a, b, _, d = (node(*corner) for corner in panel_corners(i, j))
    return unit(cross(plus(b, a, -1), plus(d, a, -1)))


def flatness(i, j):
    a, _, c, _ = (node(*corner) for corner in panel_corners(i, j))
    return abs(dot(panel_normal(i, j), plus(c, a, -1)))


@cache
def fall(i, j, side):
    """Angle β between the panel and the top face of the member on a side, positive where the panel falls away."""
    start, end = panel_corners(i, j)[side], panel_corners(i, j)[(side + 1) % 4]
    along = edge(*start, end[0] - start[0], end[1] - start[1])[1]
    up = unit(plus(axis(*start), along, -dot(axis(*start), along)))
    normal = panel_normal(i, j)
    return atan2(-dot(cross(normal, along), up), dot(normal, up))


def seat(beta):
    """Height of the highest seat point under the glass above the plane of the mesh face."""
    reach = SEAT_WIDTH / 2 if beta >= 0 else GAP / 2
    return (DEPTH / 2 + SEAT_HEIGHT) * cos(beta) + reach * sin(beta)


@cache
def lift():
    """Distance D of the glass from the mesh faces: one for the whole design."""
    return SPACER + max(seat(fall(i, j, k)) for i in range(ROWS) for j in range(STRIPS) for k in range(4))


def pull_back(i, j, side):
    """Distance of the glass edge from the trace of the member's centre plane; none on the boundary."""
    (di, dj), (i0, j0) = ((-1, 0), (0, 1), (1, 0), (0, -1))[side], (i, j)
    if not (0 <= i0 + di < ROWS and 0 <= j0 + dj < STRIPS):
        return 0.0
    beta = fall(i, j, side)
    return (GAP / 2 + GLASS * max(0.0, -sin(beta))) / cos(beta)


def traces(i, j, first=0):
    """Traces' corners in the plane of the glass, from corner `first`: origin there, x along the next side."""
    lifted = [plus(node(*corner), offset(*corner), lift()) for corner in panel_corners(i, j)]
    lifted = lifted[first:] + lifted[:first]
    x = unit(plus(lifted[1], lifted[0], -1))
    y = cross(panel_normal(i, j), x)
    return [(dot(plus(p, lifted[0], -1), x), dot(plus(p, lifted[0], -1), y)) for p in lifted]


def pulled_side(a, b, by):
    """Line parallel to a → b, `by` to the left: (nx, ny, c) with n·x = c and n to the left."""
    nx, ny = -(b[1] - a[1]) / dist(a, b), (b[0] - a[0]) / dist(a, b)
    return nx, ny, nx * a[0] + ny * a[1] + by


def meet(one, two):
    det = one[0] * two[1] - one[1] * two[0]
    return (one[2] * two[1] - one[1] * two[2]) / det, (one[0] * two[2] - one[2] * two[0]) / det


@cache
def glass(i, j, first=0):
    """Outline of the glass, before rounding, from corner `first`; that corner is the origin, x along the next side."""
    corners = traces(i, j, first)
    lines = [pulled_side(corners[k], corners[(k + 1) % 4], pull_back(i, j, (k + first) % 4)) for k in range(4)]
    points = [meet(lines[k - 1], lines[k]) for k in range(4)]
    return [plus(point, points[0], -1) for point in points]
