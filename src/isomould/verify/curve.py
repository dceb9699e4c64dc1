"""The five kinds of curve piece, evaluated from their descriptors, and their integrals of curvature."""

from itertools import pairwise
from math import comb

import numpy as np

from isomould.verify.read.text import Json
from isomould.verify.rules import Floats, Unreadable

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(24)


def evaluate(piece: Json, t: Floats) -> Floats:
    """Give point, first and second derivative by t, (3, n, 2), or (3, n, 3) for a piece in space."""
    kind = piece["kind"]
    if kind == "bezier":
        return _bezier(np.array(piece["points"], dtype=np.float64), np.array(piece["weights"], dtype=np.float64), t)
    if kind == "line":
        start, end = np.array(piece["start"], dtype=np.float64), np.array(piece["end"], dtype=np.float64)
        return _affine(start, end - start, 0 * start, (t, np.ones_like(t), 0 * t), (0 * t, 0 * t, 0 * t))
    return _transcendental(piece, t)


def _transcendental(piece: Json, t: Floats) -> Floats:
    """Ellipse, sine and catenary: two functions f, g of a parameter that is linear in t."""
    step = piece["end"] - piece["start"]
    u = piece["start"] + step * t
    c, s, ch, sh, one = np.cos(u), np.sin(u), np.cosh(u), np.sinh(u), np.ones_like(u)
    names, f, g = {
        "ellipse": (("centre", "major", "minor"), (c, -s, -c), (s, c, -s)),
        "sine": (("origin", "along", "across"), (u, one, 0 * u), (s, c, -s)),
        "catenary": (("origin", "along", "across"), (u, one, 0 * u), (ch, sh, ch)),
    }[piece["kind"]]
    origin, first, second = (np.array(piece[name], dtype=np.float64) for name in names)
    scale = np.array([1.0, step, step**2])[:, None, None]
    return scale * _affine(origin, first, second, f, g)


def _affine(origin: Floats, first: Floats, second: Floats, f: tuple[Floats, ...], g: tuple[Floats, ...]) -> Floats:
    found = np.stack(f)[..., None] * first + np.stack(g)[..., None] * second
    found[0] += origin
    return found


def _bezier(points: Floats, weights: Floats, t: Floats) -> Floats:
    """Rational Bézier by differences of homogeneous control points, then the quotient rule."""
    rows = np.column_stack((points * weights[:, None], weights))
    n = len(rows) - 1
    h0, h1 = _bernstein(rows, t), n * _bernstein(np.diff(rows, axis=0), t)
    h2 = n * (n - 1) * _bernstein(np.diff(rows, 2, axis=0), t)
    w0, w1, w2 = h0[:, -1:], h1[:, -1:], h2[:, -1:]
    p0 = h0[:, :-1] / w0
    p1 = (h1[:, :-1] - p0 * w1) / w0
    return np.stack((p0, p1, (h2[:, :-1] - 2 * p1 * w1 - p0 * w2) / w0))


def _bernstein(rows: Floats, t: Floats) -> Floats:
    n = len(rows) - 1
    if n < 0:
        return np.zeros((len(t), rows.shape[1]))
    basis = np.stack([comb(n, k) * t**k * (1 - t) ** (n - k) for k in range(n + 1)], axis=1)
    return basis @ rows


def turned_within(piece: Json, end: float) -> float:
    """Integrate the curvature from t = 0 to `end` (eq. 6) on ever more panels until it settles."""
    last = np.inf
    for panels in 2 ** np.arange(2, 12):
        found = _integral(piece, end, int(panels))
        if abs(found - last) < 1e-13:
            return found
        last = found
    message = f"curvature of a {piece['kind']} does not integrate"
    raise Unreadable(message)


def _integral(piece: Json, end: float, panels: int) -> float:
    middles = (np.arange(panels)[:, None] + (_NODES + 1) / 2).ravel() * (end / panels)
    _, first, second = evaluate(piece, middles)
    rate = _cross(first, second) / (first**2).sum(axis=1)
    return float((rate.reshape(panels, -1) @ _WEIGHTS).sum() * end / (2 * panels))


def _cross(a: Floats, b: Floats) -> Floats:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def _corner(here: Json, there: Json) -> float:
    """Give the angle at which the second piece leaves the end of the first (zero on a smooth curve)."""
    a, b = evaluate(here, np.ones(1))[1, 0], evaluate(there, np.zeros(1))[1, 0]
    return float(np.arctan2(_cross(a, b), a @ b))


def turned_at(pieces: tuple[Json, ...], contacts: list[tuple[int, float]], *, closed: bool) -> tuple[Floats, float]:
    """Give the turning from the curve's start to every contact, (n,), and all round, rad."""
    whole = np.array([turned_within(piece, 1.0) for piece in pieces])
    joints = np.array([_corner(a, b) for a, b in pairwise(pieces)])
    before = np.concatenate(([0.0], np.cumsum(whole[:-1] + joints)))
    round_trip = float(before[-1] + whole[-1]) + (_corner(pieces[-1], pieces[0]) if closed else 0.0)
    return np.array([before[k] + turned_within(pieces[k], t) for k, t in contacts]), round_trip


def is_loop(pieces: tuple[Json, ...]) -> bool:
    """Tell whether a curve ends where it starts."""
    start, end = evaluate(pieces[0], np.zeros(1))[0, 0], evaluate(pieces[-1], np.ones(1))[0, 0]
    return bool(np.linalg.norm(end - start) <= 1e-6)


def distance_to(pieces: tuple[Json, ...], points: Floats) -> Floats:
    """Give the distance of each point to the curve, mm: dense samples, then Newton steps to the foot."""
    t = np.linspace(0.0, 1.0, 129)
    nearest = [_piece_distance(piece, points, t) for piece in pieces]
    return np.min(nearest, axis=0)


def _piece_distance(piece: Json, points: Floats, t: Floats) -> Floats:
    samples = evaluate(piece, t)[0]
    foot = t[((points[:, None] - samples) ** 2).sum(axis=2).argmin(axis=1)]
    best = _distance(piece, points, foot)
    for _ in range(8):
        foot = np.clip(foot - _newton_step(piece, points, foot), 0.0, 1.0)
        best = np.minimum(best, _distance(piece, points, foot))
    return best


def _distance(piece: Json, points: Floats, t: Floats) -> Floats:
    return np.linalg.norm(evaluate(piece, t)[0] - points, axis=1)


def _newton_step(piece: Json, points: Floats, t: Floats) -> Floats:
    p0, p1, p2 = evaluate(piece, t)
    slope = (p1 * p1).sum(axis=1) + ((p0 - points) * p2).sum(axis=1)
    speed = (p1 * p1).sum(axis=1)
    return ((p0 - points) * p1).sum(axis=1) / np.where(slope > 0.01 * speed, slope, speed)
