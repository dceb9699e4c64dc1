"""Section 9 of docs/worked-example.md: parts of other templates, in plain Python. Lengths in mm.

What the shape gives (lengths, elevations and azimuths of arms, the tilt of an axis) is taken from the schedules of
those templates; what the detail makes of it is worked out.
"""

from math import ceil, cos, floor, hypot, pi, radians, sin, sqrt, tan

from worked_by_hand import STEEL, area, perimeter, regular_polygon, rounded

# Faceted node N02, member M01 and end plate F01 of dome-hollow-sections

FALL, GAPS = radians(-4.6477), [radians(gap) for gap in (86.3471, 93.6529, 93.6529, 86.3471)]
TUBE, WALL, END_PLATE, FACET = (120.0, 60.0), 5.0, 12.0, 43.0
BORDER, COVER, BOLT, BOLT_HOLE, SOCKET = 3.0, 3.0, 12.0, 13.0, 25.0
THREADED = 30 - END_PLATE - 2.5 + 3 * 1.75
"""Bolt M12x30 less plate and washer, and three pitches."""


def uncut():
    """The distance from which the plane of a facet clears its neighbour at the smallest gap."""
    gap, half_depth, half_width = min(GAPS), TUBE[0] / 2, TUBE[1] / 2 + BORDER
    between = cos(FALL) ** 2 * cos(gap) + sin(FALL) ** 2
    up = cos(FALL) * sin(FALL) * (1 - cos(gap))
    return (half_width * cos(FALL) * sin(gap) + half_depth * abs(up)) / (1 - between)


def faceted_radius():
    return hypot(FACET * cos(FALL) + TUBE[0] / 2 * sin(-FALL), TUBE[1] / 2 + BORDER)


def faceted_diameter():
    return 5 * ceil(2 * faceted_radius() / 5)


def faceted_levels():
    """The ends of the drum, outwards to 0.001."""
    middle, half = FACET * sin(FALL), TUBE[0] / 2 * cos(FALL) + COVER
    return floor((middle - half) * 1000) / 1000, ceil((middle + half) * 1000) / 1000


def beyond(points, direction, limit):
    """What is left of a polygon when a line takes all beyond it, square to a direction at a distance."""
    kept = []
    for (x, y), (u, v) in zip(points, points[1:] + points[:1], strict=True):
        a, b = (p * direction[0] + q * direction[1] - limit for p, q in ((x, y), (u, v)))
        if a <= 0:
            kept.append((x, y))
        if a * b < 0:
            kept.append((x + (u - x) * a / (a - b), y + (v - y) * a / (a - b)))
    return kept


def faceted_volume(slices=400):
    """Slices of a disc less what lies beyond the facets, less bore and threaded holes."""
    low, high = faceted_levels()
    disc, thick = regular_polygon(faceted_diameter() / 2), (high - low) / slices
    turns = [sum(GAPS[:k]) for k in range(4)]
    total = 0.0
    for k in range(slices):
        face, level = disc, low + (k + 0.5) * thick
        for turn in turns:
            face = beyond(face, (cos(turn), sin(turn)), (FACET - level * sin(FALL)) / cos(FALL))
        total += (area(face) - area(regular_polygon(10.0))) * thick
    return total - 8 * area(regular_polygon(BOLT / 2)) * THREADED


HOLLOW_LENGTH = 820.541


def tube_area():
    """EN 10219 up to 6 mm of wall: outer radius twice the wall, inner radius the wall."""
    (depth, width), round_off = TUBE, 4 - pi
    void = (depth - 2 * WALL) * (width - 2 * WALL) - round_off * WALL**2
    return depth * width - round_off * (2 * WALL) ** 2 - void


def access_area():
    """Bolt 30 and its head 7.5 and 10 more, as wide as the socket."""
    return pi / 4 * SOCKET**2 + SOCKET * (30 + 7.5 + 10 - SOCKET)


def end_plate_face():
    return (TUBE[0] - 2 * WALL) * (TUBE[1] - 2 * WALL) - (4 - pi) * WALL**2 - 2 * pi / 4 * BOLT_HOLE**2


def hollow_volume():
    cut = HOLLOW_LENGTH - 2 * FACET
    return tube_area() * cut - 4 * access_area() * WALL + 2 * end_plate_face() * END_PLATE


# Cap F01 and member M01 of pavilion-lipped-caps

CAP_RADIUS, CAP_HOLE, CAP, LIP, LIP_WIDTH, RIM, LOOSE = 52.5, 9.0, 8.0, 6.0, 5.0, 5.0, 0.5
PLATE, CAPPED_FALL, CAPPED_LENGTH = (160.0, 10.0), radians(-3.527), 1132.95167
LIP_OUTSIDE, LIP_INSIDE = CAP_RADIUS - RIM, CAP_RADIUS - RIM - LIP_WIDTH
CAPPED_END, CAPPED_SHOULDER = CAP_RADIUS - 27 + 2, CAP_RADIUS + 2


def cap_volume():
    disc, hole, outside, inside = map(regular_polygon, (CAP_RADIUS, CAP_HOLE, LIP_OUTSIDE, LIP_INSIDE))
    return CAP * (area(disc) - area(hole)) + LIP * (area(outside) - area(inside))


def cap_surface():
    disc, hole, outside, inside = map(regular_polygon, (CAP_RADIUS, CAP_HOLE, LIP_OUTSIDE, LIP_INSIDE))
    walls = CAP * (perimeter(disc) + perimeter(hole)) + LIP * (perimeter(outside) + perimeter(inside))
    return 2 * (area(disc) - area(hole)) + walls


def notch():
    """Where a notch begins and ends, from the axis."""
    return sqrt(LIP_INSIDE**2 - PLATE[1] ** 2 / 4) - LOOSE, LIP_OUTSIDE + LOOSE


def capped_height():
    exact = 2 * (PLATE[0] / 2 / cos(CAPPED_FALL) - CAPPED_SHOULDER * tan(-CAPPED_FALL))
    return floor(exact * 1000 + 1e-6) / 1000


def capped_end(elevation, height):
    """Corners of a member's end, x from the node's axis along it, from the bottom of its body to the top."""
    (begin, end), half = notch(), height / 2
    top = [(CAPPED_END, half), (begin, half), (begin, half - LIP - LOOSE), (end, half - LIP - LOOSE), (end, half)]
    top += [(CAPPED_SHOULDER, half)]
    middle, rest = CAPPED_SHOULDER * tan(elevation), PLATE[0] / 2 / cos(elevation)
    body = [(CAPPED_SHOULDER, middle + side * rest) for side in (-1, 1)]
    corners = [body[0], *((r, -v) for r, v in reversed(top)), *top, body[1]]
    return [(r * cos(elevation) + v * sin(elevation), v * cos(elevation) - r * sin(elevation)) for r, v in corners]


def capped_outline():
    """Counter-clockwise: the end at N-01-00, seen from the other side, then the start at N-00-00."""
    start = capped_end(0.0, PLATE[0])
    end = [(CAPPED_LENGTH - x, y) for x, y in capped_end(CAPPED_FALL, capped_height())]
    return rounded(end + start[::-1])


# Base of node N01 of dome-finned-nodes

HUB, HUB_HEIGHT, UPRIGHT = 32.5, 148.88, 0.540169229
"""Radius and height of the hub; what of its axis is upright, axis_z of N-00-03-A."""
MARGIN, CLEAR, SEAT, BASE, STEM, SILL = 60.0, 10.0, 0.9, 15.0, 15.0, 160.0
LEVEL_PART = sqrt(1 - UPRIGHT**2)


def base_size():
    along = HUB * UPRIGHT + HUB_HEIGHT / 2 * LEVEL_PART + MARGIN
    return 2 * ceil(along), 2 * ceil(HUB + MARGIN)


def base_level():
    return ceil(CLEAR + max(SILL / 2, HUB * LEVEL_PART + HUB_HEIGHT / 2 * UPRIGHT))


def stem():
    """Corners, counter-clockwise from the foot on the left: the hub's lowest corner is a notch of its top."""
    half = SEAT * min(HUB / UPRIGHT, HUB_HEIGHT / 2 / LEVEL_PART)
    x = HUB * UPRIGHT - HUB_HEIGHT / 2 * LEVEL_PART
    y = base_level() - HUB * LEVEL_PART - HUB_HEIGHT / 2 * UPRIGHT
    right, left = y + (half - x) * UPRIGHT / LEVEL_PART, y + (half + x) * LEVEL_PART / UPRIGHT
    return rounded([(-half, 0.0), (half, 0.0), (half, right), (x, y), (-half, left)])


def base_volume():
    length, width = base_size()
    return (length * width - 4 * pi / 4 * 18**2) * BASE + area(stem()) * STEM


def other_templates():
    """Numbers by symbol."""
    return {
        "s_f": [uncut()],
        "R_f, 2R_f": [faceted_radius(), faceted_diameter()],
        "z_1, z_2, H_f": [*faceted_levels(), faceted_levels()[1] - faceted_levels()[0]],
        "V_f": [faceted_volume() / 1e3],
        "faceted mass": [faceted_volume() * STEEL / 1e9],
        "cut_h": [HOLLOW_LENGTH - 2 * FACET],
        "A_h": [tube_area()],
        "A_a": [access_area()],
        "V_e": [end_plate_face() * END_PLATE],
        "mass of end plate": [end_plate_face() * END_PLATE * STEEL / 1e9],
        "hollow mass": [hollow_volume() * STEEL / 1e9],
        "n_c": notch(),
        "V_c": [cap_volume()],
        "mass of cap": [cap_volume() * STEEL / 1e9],
        "cap surface": [cap_surface()],
        "H_c": [capped_height()],
        "top_c, bottom_c, cut_c": capped_lengths(),
        "F_c": [area(capped_outline())],
        "capped mass": [area(capped_outline()) * PLATE[1] * STEEL / 1e9],
        "base plate": [*base_size(), base_level()],
        "stem": [value for corner in stem() for value in corner],
        "V_b": [base_volume()],
        "mass of base": [base_volume() * STEEL / 1e9],
    }


def capped_lengths():
    """Along the top and the bottom of the body, and of all."""
    outline = capped_outline()
    along = [[x for x, y in outline if abs(y - level) < 1e-6] for level in (80.0, -80.0)]
    across = [x for x, _ in outline]
    inner = [(min(x for x in row if x > 50), max(row)) for row in along]
    return inner[0][1] - inner[0][0], inner[1][1] - inner[1][0], max(across) - min(across)


def scheduled():
    """Cells of the schedules of those templates: what the arithmetic says of marks of a table."""
    top, bottom, cut = capped_lengths()
    length, width = base_size()
    return {
        ("dome-hollow-sections", "nodes", "N02"): {
            "drum_diameter_mm": float(faceted_diameter()),
            "drum_height_mm": faceted_levels()[1] - faceted_levels()[0],
            "mass_kg": faceted_volume() * STEEL / 1e9,
        },
        ("dome-hollow-sections", "members", "M01"): {
            "cut_length_mm": HOLLOW_LENGTH - 2 * FACET,
            "set_back_start_mm": FACET,
            "end_angle_start_deg": 0.0,
            "mass_kg": hollow_volume() * STEEL / 1e9,
        },
        ("dome-hollow-sections", "fittings", "F01"): {
            "mass_kg": end_plate_face() * END_PLATE * STEEL / 1e9,
        },
        ("pavilion-lipped-caps", "fittings", "F01"): {
            "mass_kg": cap_volume() * STEEL / 1e9,
            "coated_area_m2": cap_surface() / 1e6,
        },
        ("pavilion-lipped-caps", "members", "M01"): {
            "top_length_mm": top,
            "bottom_length_mm": bottom,
            "cut_length_mm": cut,
            "end_angle_end_deg": 3.527,
            "set_back_start_mm": CAPPED_END,
            "set_back_end_mm": CAPPED_END / cos(CAPPED_FALL),
            "mass_kg": area(capped_outline()) * PLATE[1] * STEEL / 1e9,
        },
        ("dome-finned-nodes", "nodes", "N01"): {
            "base_length_mm": float(length),
            "base_width_mm": float(width),
            "base_level_mm": float(base_level()),
            "base_holes": 4,
            "base_mass_kg": base_volume() * STEEL / 1e9,
        },
    }
