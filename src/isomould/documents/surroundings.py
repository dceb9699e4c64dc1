"""What stands around a building in its picture: sky, ground and shadow, a person, a scale bar, axes and north."""

import numpy as np
import shapely

from isomould.arrays import Floats
from isomould.documents.camera import Camera
from isomould.documents.picture import INK, Caption, Frame, Item, Shape, blend

SKY_HIGH, SKY_LOW = "#bcd3e8", "#f4f7f9"
GROUND, SHADOW = "#dfdcd3", "#c4c1b8"
_PERSON = "#4a4f55"
_SUN = np.array([0.45, -0.5, 0.74])
"""Towards the sun."""

_BANDS = 40

_SILHOUETTE = np.array(
    [(-0.09, 0), (-0.02, 0), (0.0, 0.78), (0.03, 0), (0.1, 0), (0.14, 0.8), (0.24, 0.85), (0.2, 1.4), (0.07, 1.5),
     (0.11, 1.6), (0.09, 1.71), (0.0, 1.75), (-0.09, 1.71), (-0.11, 1.6), (-0.07, 1.5), (-0.2, 1.4), (-0.24, 0.85),
     (-0.14, 0.8)]
)  # fmt: skip
"""A person of 1.75 m, m."""


def sky(width: float, height: float) -> list[Item]:
    """Give bands from the horizon's light to the blue above."""
    edges = np.linspace(0.0, height, _BANDS + 1)
    shades = np.linspace(0.0, 1.0, _BANDS)
    return [
        Shape(_rectangle(0.0, float(low), width, float(high) + 0.5), True, blend(SKY_LOW, SKY_HIGH, share), None)
        for low, high, share in zip(edges[:-1], edges[1:], shades.tolist(), strict=True)
    ]


def _rectangle(left: float, low: float, right: float, high: float) -> Floats:
    return np.array([[left, low], [right, low], [right, high], [left, high]])


def footprint(nodes: Floats, level: float) -> Floats:
    """Corners (4, 3) of the ground at a level that is shown: the building's box, wider by a sixth."""
    low, high = nodes.min(axis=0), nodes.max(axis=0)
    room = 0.17 * float(max(high[:2] - low[:2]))
    (left, near), (right, far) = low[:2] - room, high[:2] + room
    return np.array([[left, near, level], [right, near, level], [right, far, level], [left, far, level]])


def ground(corners: Floats, camera: Camera, frame: Frame, width: float) -> list[Item]:
    """Give the ground: a plane from above, all below the feet in elevations."""
    if camera.level:
        level = float(frame.place(camera.flat(corners)).max(axis=0)[1])
        return [
            Shape(_rectangle(0.0, 0.0, width, level), True, GROUND, None),
            Shape(np.array([[0.0, level], [width, level]]), False, None, INK, 1.0),
        ]
    return [Shape(frame.place(camera.flat(corners)), True, GROUND, None)]


def shadow(outlines: list[Floats], corners: Floats, camera: Camera, frame: Frame) -> list[Item]:
    """Give the shadow of panels (k, 3) on the ground that is shown (4, 3), in one piece or several."""
    if camera.level:
        return []
    level = float(corners[0, 2])
    cast = [outline - ((outline[:, 2:] - level) / _SUN[2]) * _SUN for outline in outlines]
    merged = shapely.union_all([shapely.convex_hull(shapely.MultiPoint(each[:, :2])) for each in cast], grid_size=1.0)
    shown = shapely.intersection(merged, shapely.Polygon(corners[:, :2]))
    parts = [part for part in shapely.get_parts(shown) if isinstance(part, shapely.Polygon)]
    rings = [np.array(shapely.get_coordinates(part.exterior)) for part in parts]
    return [
        Shape(frame.place(camera.flat(np.column_stack([ring, np.full(len(ring), level)]))), True, SHADOW, None)
        for ring in rings
    ]


def person(corners: Floats, camera: Camera, frame: Frame) -> list[Item]:
    """Give a person of 1.75 m beside the building, who faces the eye; from above a circle of shoulders."""
    middle = corners.mean(axis=0)
    nearest = corners[int(np.round(camera.depth(corners) - 1e-3 * (corners @ camera.right), 3).argmax())]
    feet = middle + 0.87 * (nearest - middle)
    upright = np.array([0.0, 0.0, 1.0])
    if camera.from_above:
        turns = np.linspace(0.0, 2 * np.pi, 12, endpoint=False)
        body = feet + 250.0 * np.stack([np.cos(turns), 0.6 * np.sin(turns), np.zeros_like(turns)], axis=1)
    else:
        body = feet + 1000.0 * (_SILHOUETTE[:, :1] * camera.right + _SILHOUETTE[:, 1:] * upright)
    return [Shape(frame.place(camera.flat(body)), True, _PERSON, None)]


def scale_bar(frame: Frame, place: tuple[float, float], wanted: float = 150.0) -> list[Item]:
    """Give a bar of 1, 2 or 5 times a power of ten metres, two fields, about as long as wanted (points).

    Lengths along the picture's horizontal are true in every view.
    """
    metres = wanted / frame.scale / 1000.0
    power = 10.0 ** np.floor(np.log10(metres))
    length = float(max(step * power for step in (1.0, 2.0, 5.0) if step * power <= metres * (1 + 1e-9)))
    size, (x, y) = length * 1000.0 * frame.scale, place
    halves = [_rectangle(x, y, x + size / 2, y + 5), _rectangle(x + size / 2, y, x + size, y + 5)]
    return [
        Shape(halves[0], True, INK, INK, 0.6),
        Shape(halves[1], True, "#ffffff", INK, 0.6),
        Caption("0", (x, y + 9), 10.0, "middle"),
        Caption(f"{length:g} m", (x + size, y + 9), 10.0, "middle"),
    ]


def compass(camera: Camera, place: tuple[float, float], north_deg: float = 0.0) -> list[Item]:
    """Give the axes as they are seen, and where north is.

    Parameters
    ----------
    place
        Where the axes begin, points.
    north_deg
        Angle of the project's x axis from the site's (east), counter-clockwise.
    """
    turn = np.radians(north_deg)
    items = list[Item]()
    for axis, word in zip(np.eye(3), "xyz", strict=True):
        items += _arrow(camera.flat(axis), place, 26.0, word, INK)
    north = camera.flat(np.array([np.sin(turn), np.cos(turn), 0.0]))
    return [*items, *_arrow(north, place, 52.0, "N", "#b3261e")]


def _arrow(direction: Floats, place: tuple[float, float], size: float, word: str, ink: str) -> list[Item]:
    """Give an arrow with its letter; none for what points at the eye."""
    reach = float(np.hypot(*direction))
    if reach < 0.05:
        return []
    start = np.array(place)
    tip = start + size * direction
    along = direction / reach
    across = np.array([-along[1], along[0]])
    head = np.array([tip, tip - 5 * along + 2 * across, tip - 5 * along - 2 * across])
    x, y = (tip + 7 * along).tolist()
    return [
        Shape(np.array([start, tip]), False, None, ink, 1.0),
        Shape(head, True, ink, None),
        Caption(word, (x, y - 3.5), 10.0, "middle"),
    ]
