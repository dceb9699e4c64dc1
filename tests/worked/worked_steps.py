"""The steps of docs/worked-example.md: the numbers behind every symbol of its tables."""

from math import cos, degrees, dist, pi, sin, tan

from worked_by_hand import (
    ALPHA,
    BETA,
    BORE,
    CLEARANCE,
    DEPTH,
    FLOOR,
    PHI0,
    PLATE_END,
    RADIUS,
    RISE,
    SHOULDER,
    SPAN,
    STEEL,
    THICK,
    WAVE,
    arch_node,
    area,
    arm_gaps,
    arms,
    axis,
    azimuths,
    contact,
    drum_height,
    drum_section,
    edge,
    elevation,
    facets,
    fall,
    flat_direction,
    glass,
    lift,
    member_angles,
    member_outline,
    mismatch,
    mitre,
    node,
    offset,
    panel_normal,
    perimeter,
    phi,
    profile_offset,
    profile_vertex,
    psi,
    pull_back,
    regular_polygon,
    rounded,
    seat,
    slot_piece,
    touch,
    traces,
)

ROW, STRIP = 5, 7
SIDES = range(4)
WAYS = arms(ROW, STRIP)


def steps():
    """Numbers by symbol, angles in degrees."""
    return _curves() | _node() | _drum() | _member() | _panel()


def _curves():
    return {
        "p": [SPAN**2 / (8 * RISE)],
        "ψ_0": [degrees(psi(0))],
        "α": [degrees(ALPHA)],
        "ψ_5 … ψ_8": [degrees(psi(k)) for k in range(5, 9)],
        "c_5 … c_8": [contact(k) for k in range(5, 9)],
        **{f"R_{j}": arch_node(j) for j in (6, 7, 8)},
        **{f"A_{j}": mitre(j) for j in (6, 7, 8)},
        "k": [WAVE],
        "φ_0": [degrees(PHI0)],
        "δ": [degrees(BETA)],
        "φ_3 … φ_6": [degrees(phi(k)) for k in range(3, 7)],
        **{f"K_{k}": touch(k) for k in range(3, 7)},
        **{f"Q_{i}": profile_vertex(i) for i in (4, 5, 6)},
        **{f"(a, b)_{i}": profile_offset(i) for i in (5, 6)},
    }


def _node():
    elevations = [elevation(ROW, STRIP, *way) for way in WAYS]
    places = {f"V({ROW + di},{STRIP + dj})": node(ROW + di, STRIP + dj) for di, dj in ((0, 0), *WAYS)}
    return {
        **places,
        "O(5,7)": offset(ROW, STRIP),
        "n": axis(ROW, STRIP),
        **{f"e_{k}": edge(ROW, STRIP, *way)[1] for k, way in enumerate(WAYS, 1)},
        "ε_1 … ε_4": [degrees(e) for e in elevations],
        "γ_1 … γ_4": [degrees(gap) for gap in arm_gaps(ROW, STRIP, WAYS)],
        "azimuths": [degrees(angle) for angle in azimuths(ROW, STRIP)],
        "ref": flat_direction(ROW, STRIP, *WAYS[0]),
        "m_1 … m_4": [DEPTH / 2 / cos(e) for e in elevations],
        "mismatch": [mismatch(ROW, STRIP)],
        "H_1/2 … H_4/2": [DEPTH / 2 / cos(e) - SHOULDER * tan(abs(e)) for e in elevations],
    }


def _drum():
    disc, hole = regular_polygon(RADIUS), regular_polygon(BORE / 2)
    slots = [slot_piece(angle) for angle in azimuths(ROW, STRIP)]
    (face, outline), height = drum_section(ROW, STRIP), drum_height(ROW, STRIP)
    gap = min(arm_gaps(ROW, STRIP, WAYS))
    return {
        "ρ, 2R": [FLOOR, 2 * RADIUS],
        "s, t": [PLATE_END, SHOULDER],
        "web": [2 * (FLOOR * sin(gap / 2) - (THICK + CLEARANCE) / 2 * cos(gap / 2))],
        "H": [height],
        "n_R, n_b": [facets(RADIUS), facets(BORE / 2)],
        "F_R, U_R": [area(disc), perimeter(disc)],
        "F_b, U_b": [area(hole), perimeter(hole)],
        "f_1 … f_4": [taken for taken, _ in slots],
        "u_1 … u_4": [added for _, added in slots],
        "F": [face],
        "U": [outline],
        "volume": [face * height],
        "node mass": [face * height * STEEL / 1e9],
        "node surface": [2 * face + outline * height],
        "removed": [pi / 4 * 95**2 * (height + 4) - face * height],
    }


def _member():
    outline = member_outline(ROW - 2, STRIP, 1, 0)
    corners = rounded(outline)
    start, end = member_angles(ROW - 2, STRIP, 1, 0)
    return {
        "L": [edge(ROW, STRIP, 1, 0)[0]],
        "n(6,7)": axis(ROW + 1, STRIP),
        "ε_s, ε_e": [degrees(start), degrees(end)],
        "ε_p": [degrees(elevation(ROW + 1, STRIP, 0, 1))],
        "H_s, H_e": [drum_height(ROW + 1, STRIP), drum_height(ROW, STRIP)],
        "set-backs": [PLATE_END / cos(start), PLATE_END / cos(end)],
        **{f"P_{k}": (*outline[k - 1], *corners[k - 1]) for k in range(1, 13)},
        "top, bottom, cut": [corners[b][0] - corners[a][0] for a, b in ((0, 11), (5, 6), (2, 9))],
        "F_m, U_m": [area(corners), perimeter(corners)],
        "member mass": [area(corners) * THICK * STEEL / 1e9],
        "member surface": [2 * area(corners) + THICK * perimeter(corners)],
    }


def _panel():
    betas = [fall(ROW, STRIP, side) for side in SIDES]
    trace, points = traces(ROW, STRIP, 2), glass(ROW, STRIP, 2)
    corners = rounded(points)
    return {
        "N": panel_normal(ROW, STRIP),
        "β_a … β_d": [degrees(beta) for beta in betas],
        "q_a … q_d": [seat(beta) for beta in betas],
        "q_max": [seat(ALPHA / 2)],
        "D": [lift()],
        "packers": [lift() - seat(beta) for beta in betas],
        "g_a … g_d": [pull_back(ROW, STRIP, side) for side in SIDES],
        "L_7, ℓ": [dist(arch_node(7), arch_node(8)), dist(profile_vertex(5), profile_vertex(6))],
        "c', a', y'": [dist(trace[0], trace[1]), dist(trace[2], trace[3]), trace[2][1]],
        "tan τ": [(trace[2][0] - trace[1][0]) / trace[2][1]],
        "w_c, w_a": [points[1][0], points[2][0] - points[3][0]],
        "y": [points[2][1]],
        **{f"G_{k}": (*points[k - 1], *corners[k - 1]) for k in range(1, 5)},
        "glass area": [area(corners)],
        "legs": [dist(corners[k], corners[k + 1]) for k in (1, -1)],
        "diagonals": [dist(corners[0], corners[2]), dist(corners[1], corners[3])],
    }
