"""Classes and schedule rows of the worked example, from the numbers of `worked_by_hand`."""

from decimal import Decimal
from functools import cache
from math import acos, atan2, ceil, cos, degrees, dist, pi

from worked_by_hand import (
    BAR_ALLOWANCE,
    DEPTH,
    FACING,
    GLASS,
    GLASS_DENSITY,
    GLASS_MIN,
    GLASS_ROUND,
    GRADE,
    PLATE_END,
    RADIUS,
    ROWS,
    SECTION,
    STEEL,
    STEP,
    STRIPS,
    THICK,
    area,
    arms,
    axis,
    azimuths,
    dot,
    drum_height,
    drum_section,
    edge,
    elevation,
    end_profile,
    fall,
    flat_direction,
    flatness,
    glass,
    lift,
    member_angles,
    member_outline,
    mismatch,
    node,
    panel_corners,
    panel_normal,
    perimeter,
    plus,
    reading,
    rounded,
    seat,
    sequence,
    starts,
    torsion,
)

LENGTH, ANGLE = 0.5, 0.05 * pi / 180  # two parts that differ by less are one

# Classes: numbered by their first instance, in the order of the locations


def classify(instances):
    """Class of every instance: [(class, variant)]; instances are lists of equal descriptions (labels, numbers)."""
    founders, found = [], []
    for variants in instances:
        hits = ((k, v) for k, f in enumerate(founders) for v, row in enumerate(variants) if agree(row, f))
        hit = next(hits, (len(founders), 0))
        founders += [variants[0]] if hit[0] == len(founders) else []
        found.append(hit)
    return found


def agree(one, two):
    pairs = zip(one[1], two[1], two[2], strict=True)
    return one[0] == two[0] and all(abs(a - b) <= tolerance for a, b, tolerance in pairs)


def apart(one, two, levers=(1.0,) * 8):
    """Largest difference of two descriptions' numbers, each times its lever."""
    return max(abs(a - b) * lever for a, b, lever in zip(one[1], two[1], levers, strict=False))


@cache
def node_classes():
    places = [(i, j) for i in range(ROWS + 1) for j in range(STRIPS + 1)]
    return dict(zip(places, classify([[node_description(*place)] for place in places]), strict=True))


def node_description(i, j):
    return described(reading(i, j, arms(i, j)))


def described(read):
    gaps, elevations, families = read
    return families, gaps + elevations, (ANGLE,) * (2 * len(gaps))


@cache
def member_classes():
    ways = [(i, j, 1, 0) for i in range(ROWS) for j in range(STRIPS + 1)]
    ways += [(i, j, 0, 1) for i in range(ROWS + 1) for j in range(STRIPS)]
    return dict(zip(ways, classify([member_variants(*way) for way in ways]), strict=True))


def member_variants(i, j, di, dj):
    """As it stands, end for end, upside down, both."""
    length, (e, f) = edge(i, j, di, dj)[0], member_angles(i, j, di, dj)
    h, g = drum_height(i, j), drum_height(i + di, j + dj)
    rows = ((e, f, h, g), (f, e, g, h), (-e, -f, h, g), (-f, -e, g, h))
    return [((dj, h1, h2), (length, e1, e2), (LENGTH, ANGLE, ANGLE)) for e1, e2, h1, h2 in rows]


@cache
def panel_classes():
    places = [(i, j) for i in range(ROWS) for j in range(STRIPS)]
    variants = [[panel_description(i, j, first) for first in range(4)] for i, j in places]
    return dict(zip(places, classify(variants), strict=True))


def panel_description(i, j, first):
    return (), panel_numbers(i, j, first), (LENGTH,) * 6


def panel_numbers(i, j, first):
    points = glass(i, j)[first:] + glass(i, j)[:first]
    sides, diagonals = [(k, (k + 1) % 4) for k in range(4)], [(0, 2), (1, 3)]
    return tuple(dist(points[a], points[b]) for a, b in sides + diagonals)


def mark(prefix, classes, key):
    count = 1 + max(number for number, _ in classes.values())
    return f"{prefix}{classes[key][0] + 1:0{max(2, len(str(count)))}d}"


def same(classes, key):
    """All instances of a class, in order."""
    return [place for place, (number, _) in classes.items() if number == classes[key][0]]


def first_of(classes, key):
    return same(classes, key)[0]


# The rows of the schedules


def location(prefix, i, j):
    return f"{prefix}-{i:02d}-{j:02d}"


TURNED = ("none", "end_for_end", "upside_down", "both")


def member_location(i, j, di, dj):
    """Name of a member, seen from any of its nodes."""
    return location("MG" if di else "MP", i + min(di, 0), j + min(dj, 0))


def panel_location(i, j):
    return location("P", i, j) if 0 <= i < ROWS and 0 <= j < STRIPS else ""


def node_row(i, j):
    """The schedule row of the class of node (i, j)."""
    count, (face, outline), height = len(arms(i, j)), drum_section(i, j), drum_height(i, j)
    volume, bar = face * height, STEP * ceil((2 * RADIUS + BAR_ALLOWANCE) / STEP)
    row = {"mark": mark("N", node_classes(), (i, j)), "quantity": len(same(node_classes(), (i, j)))}
    row |= {"kind": "interior" if count == 4 else "boundary", "valence": count, "handed": node_hand(i, j)}
    for k, (way, azimuth) in enumerate(zip(arms(i, j), azimuths(i, j), strict=True), 1):
        row |= {f"azimuth_{k}_deg": degrees(azimuth), f"elevation_{k}_deg": degrees(elevation(i, j, *way))}
        row |= {f"family_{k}": "generatrix" if way[0] else "parallel", f"section_{k}": SECTION}
    row |= {"drum_diameter_mm": 2 * RADIUS, "drum_height_mm": height}
    row |= mass(volume * STEEL / 1e9, row["quantity"])
    row |= {"volume_cm3": volume / 1e3, "coated_area_m2": (2 * face + outline * height) / 1e6}
    row |= {"bar_diameter_mm": bar, "blank_length_mm": height + FACING}
    blank = pi / 4 * bar**2 * (height + FACING)
    row |= {"bar_mass_kg": blank * STEEL / 1e9, "removed_volume_cm3": (blank - volume) / 1e3}
    row |= {"slots": count, "facets": 0, "fins": 0, "holes": 1, "threads": 0, "weld_length_mm": 2 * height * count}
    angle = max(apart(node_description(*place), node_description(i, j)) for place in same(node_classes(), (i, j)))
    row |= {"max_deviation_mm": angle * RADIUS, "max_deviation_deg": degrees(angle)}
    files = f"nodes/{row['mark']}.dxf;{sheet('nodes', row['mark'])}"
    return row | {"solid_file": f"nodes/{row['mark']}.3mf", "drawing_file": files}


def mass(one, count):
    """Mass of a piece and of all: the total is that of the printed mass, as the workbook's formula gives it."""
    return {"mass_kg": one, "total_mass_kg": count * round(one, 3)}


def node_hand(i, j):
    """None if a node reads the same in a mirror; else L if it reads smaller than its mirror image, from arm 1 each."""
    one, mirrors = arms(i, j), starts(arms(i, j)[::-1])
    if any(agree(described(mirrored(i, j, ways)), node_description(i, j)) for ways in mirrors):
        return "none"
    return "L" if sequence(i, j, one) < min(sequence(i, j, ways, mirrored) for ways in mirrors) else "R"


def mirrored(i, j, ways):
    """Reading of a node's mirror image: that of the node itself, clockwise."""
    gaps, *others = reading(i, j, ways)
    return [2 * pi - gap for gap in gaps], *others


def node_instance_row(i, j):
    faces = {(1, 0): (0, -1), (0, -1): (-1, -1), (-1, 0): (-1, 0), (0, 1): (0, 0)}  # on the left of an arm
    row = {"location": location("N", i, j), "mark": mark("N", node_classes(), (i, j)), "i": i, "j": j}
    vectors = {"{}_mm": node(i, j), "axis_{}": axis(i, j), "ref_{}": flat_direction(i, j, *arms(i, j)[0])}
    for name, vector in vectors.items():
        row |= {name.format(letter): value for letter, value in zip("xyz", vector, strict=True)}
    row |= {"mismatch_mm": mismatch(i, j), "torsion_deg": degrees(torsion(i, j))}
    row["members"] = ";".join(member_location(i, j, *way) for way in arms(i, j))
    row["panels"] = ";".join(panel_location(i + faces[way][0], j + faces[way][1]) for way in arms(i, j))
    angle = apart(node_description(i, j), node_description(*first_of(node_classes(), (i, j))))
    return row | {"deviation_mm": angle * RADIUS, "deviation_deg": degrees(angle)}


def member_row(i, j, di, dj):
    """The schedule row of the class of a member, measured on its first piece."""
    classes, way = member_classes(), (i, j, di, dj)
    i, j, di, dj = first_of(classes, way)
    outline, count = rounded(member_outline(i, j, di, dj)), len(same(classes, way))
    angles, corner = member_angles(i, j, di, dj), len(end_profile(i, j, di, dj))
    top, bottom, face = outline[-1][0] - outline[0][0], outline[corner][0] - outline[corner - 1][0], area(outline)
    row = {"mark": mark("M", classes, way), "quantity": count}
    row |= {"family": "generatrix" if di else "parallel", "section": SECTION, "grade": GRADE, "holes": 0}
    row |= {"system_length_mm": edge(i, j, di, dj)[0], "top_length_mm": top, "bottom_length_mm": bottom}
    row["cut_length_mm"] = max(x for x, _ in outline) - min(x for x, _ in outline)
    ends = list(zip(("start", "end"), angles, strict=True))
    row |= {f"end_angle_{end}_deg": -degrees(angle) for end, angle in ends}
    row |= {f"set_back_{end}_mm": PLATE_END / cos(angle) for end, angle in ends}
    row |= mass(face * THICK * STEEL / 1e9, count)
    row["coated_area_m2"] = (2 * face + THICK * perimeter(outline)) / 1e6
    files = [f"members/{row['mark']}.{kind}" for kind in ("dxf", "nc1")]
    return row | {"files": ";".join([*files, sheet("members", row["mark"])])}


def sheet(book, name):
    """The page of a class: they are drawn in the order of their marks."""
    return f"drawings/{book}.pdf#page={int(name[1:])}"


def member_instance_row(i, j, di, dj):
    left, right = ((0, -1), (0, 0)) if di else ((0, 0), (-1, 0))
    way, variant = (i, j, di, dj), member_classes()[i, j, di, dj][1]
    row = {"location": member_location(*way), "mark": mark("M", member_classes(), way)}
    row |= {"turned": TURNED[variant], "node_start": location("N", i, j), "node_end": location("N", i + di, j + dj)}
    row |= {"panel_left": panel_location(i + left[0], j + left[1])}
    row |= {"panel_right": panel_location(i + right[0], j + right[1])}
    one, founder = member_variants(i, j, di, dj)[variant], member_variants(*first_of(member_classes(), way))[0]
    return row | {"deviation_mm": apart(one, founder, (1.0, DEPTH / 2, DEPTH / 2))}


def panel_row(i, j):
    """The schedule row of the class of a panel, measured on its first piece."""
    classes, count = panel_classes(), len(same(panel_classes(), (i, j)))
    points = rounded(glass(*first_of(classes, (i, j))))
    face, width, height = square_metres(points), max(x for x, _ in points) - min(x for x, _ in points), points[2][1]
    row = {"mark": mark("P", classes, (i, j)), "quantity": count}
    row |= {f"side_{side}_mm": dist(points[k], points[(k + 1) % 4]) for k, side in enumerate("abcd")}
    row |= {f"diagonal_{k + 1}_mm": dist(points[k], points[k + 2]) for k in (0, 1)}
    row["height_mm"] = height
    row |= {f"angle_{k + 1}_deg": degrees(corner_angle(points, k)) for k in range(4)}
    row |= {"outline": "", "area_m2": face, "total_area_m2": count * face}
    blank = [GLASS_ROUND * ceil(round(size / GLASS_ROUND, 9)) for size in (width, height)]
    row |= {"charged_area_m2": max(GLASS_MIN, blank[0] * blank[1] / 1e6)}
    row |= {"box_width_mm": width, "box_height_mm": height}
    row |= mass(face * GLASS / 1e3 * GLASS_DENSITY, count)
    return row | {"handed": panel_hand(i, j), "files": f"panels/{row['mark']}.dxf;{sheet('panels', row['mark'])}"}


def square_metres(points):
    """Area of a rounded outline, as printed: whole µm leave no doubt at a tie."""
    return printed(area([(round(1000 * x), round(1000 * y)) for x, y in points]) / 1e12, 12)


def corner_angle(points, k):
    ahead, behind = plus(points[(k + 1) % 4], points[k], -1), plus(points[k - 1], points[k], -1)
    return atan2(ahead[0] * behind[1] - ahead[1] * behind[0], dot(ahead, behind))


def panel_hand(i, j):
    """A panel is its own mirror image where its sides and diagonals read the same clockwise."""
    a, b, c, d, e, f = panel_numbers(i, j, 0)
    mirrors = ((a, d, c, b, f, e), (d, c, b, a, e, f), (c, b, a, d, f, e), (b, a, d, c, e, f))
    alike = any(agree(((), mirror), panel_description(i, j, 0)) for mirror in mirrors)
    return "none" if alike else "L or R"


def panel_instance_row(i, j):
    corners, sides = panel_corners(i, j), ((i, j, 0, 1), (i, j + 1, 1, 0), (i + 1, j, 0, 1), (i, j, 1, 0))
    row = {"location": panel_location(i, j), "mark": mark("P", panel_classes(), (i, j)), "i": i, "j": j}
    row |= {"first_corner": panel_classes()[i, j][1] + 1}
    row["nodes"] = ";".join(location("N", *corner) for corner in corners)
    row["members"] = ";".join(member_location(*way) for way in sides)
    row["packers_mm"] = ";".join(text(lift() - seat(fall(i, j, k)), 3) for k in range(4))
    row |= {"slope_deg": degrees(acos(panel_normal(i, j)[2])), "flatness_mm": flatness(i, j)}
    founder, variant = first_of(panel_classes(), (i, j)), panel_classes()[i, j][1]
    return row | {"deviation_mm": apart(panel_description(i, j, variant), panel_description(*founder, 0))}


DECIMALS = {"mm": 3, "deg": 4, "kg": 3, "m2": 12, "cm3": 3}


def decimals(column):
    """Decimals of a column by its unit; directions have 9."""
    return DECIMALS.get(column.rpartition("_")[2], 9)


def printed(value, places):
    """Round half to even, snapped three decimals further first, so that noise decides no tie."""
    return float(round(Decimal(f"{value:.{places + 3}f}"), places)) + 0.0


def text(value, places):
    """A number as the tables print it: no trailing zeros, never -0."""
    return f"{printed(value, places):.{places}f}".rstrip("0").rstrip(".")
