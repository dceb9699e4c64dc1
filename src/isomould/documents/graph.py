"""The curvature graph of a divided curve with its tangency points (paper Fig. 21)."""

from collections.abc import Callable

import numpy as np

from isomould.arrays import Floats
from isomould.curves.curve import PlanarCurve
from isomould.curves.lengths import length, parameter_at
from isomould.documents.picture import INK, PALE, Caption, Dot, Item, Picture, Shape
from isomould.form.polygon import CurvePolygon
from isomould.measure.smooth import curvature

_WIDTH, _HEIGHT, _LEFT, _FOOT, _TOP = 960.0, 420.0, 84.0, 64.0, 24.0
_SAMPLES = 801


def curvature_picture(curve: PlanarCurve, polygon: CurvePolygon, name: str) -> Picture:
    """Give the curvature of a curve along its length; a dot where each edge of its polygon touches it.

    Equal areas lie under the graph between the dots of an isogonal subdivision (paper eq. 6).
    """
    stations = np.linspace(0.0, length(curve), _SAMPLES)
    places = parameter_at(curve, stations)
    bend = 1000 * curvature(curve, *places)
    contact = 1000 * curvature(curve, polygon.edges.piece, polygon.edges.parameter)
    top, low = _ceiling(float(bend.max())), 0.0 - _ceiling(float(-bend.min()))
    spans = np.array([stations[-1], max(top - low, 1e-9)])
    room = np.array([_WIDTH - _LEFT - _TOP, _HEIGHT - _FOOT - _TOP])

    def place(x: Floats, y: Floats) -> Floats:
        return np.stack([x, y - low], axis=-1) / spans * room + np.array([_LEFT, _FOOT])

    along = _stations_of(curve, polygon, stations)
    feet = place(along, contact)
    axis = place(along, np.zeros_like(contact))
    items: list[Item] = [Shape(np.stack(pair), False, None, PALE, 0.7) for pair in zip(axis, feet, strict=True)]
    items += [Shape(place(stations, bend), False, None, "#2b62c9", 1.6)]
    items += [Shape(place(np.array([0, stations[-1]]), np.zeros(2)), False, None, INK, 0.8)]
    items += [Dot((float(x), float(y)), 3.4, "#c9352b") for x, y in feet]
    items += _scales(place, stations[-1], (low, top), name)
    return Picture(f"{name}, curvature of the rail", _WIDTH, _HEIGHT, tuple(items))


def _stations_of(curve: PlanarCurve, polygon: CurvePolygon, stations: Floats) -> Floats:
    """Lengths (e,) mm along the curve of the contacts, between the samples by their pieces' parameters."""
    piece, parameter = parameter_at(curve, stations)
    return np.interp(polygon.edges.piece + polygon.edges.parameter, piece + parameter, stations)


def _ceiling(value: float) -> float:
    """Round up to 1, 1.5, 2, 3 or 5 times a power of ten; 0 for what is not positive."""
    if value <= 1e-12:
        return 0.0
    power = 10.0 ** np.floor(np.log10(value))
    return float(next(step * power for step in (1, 1.5, 2, 3, 5, 10) if value <= step * power * (1 + 1e-9)))


def _scales(
    place: Callable[[Floats, Floats], Floats], total: float, heights: tuple[float, float], name: str
) -> list[Item]:
    """Numbers at both axes, and what is shown."""
    low, high = heights
    ticks = np.unique([low, 0.0, high / 2, high])
    lengths = np.arange(0.0, total, _ceiling(total / 8))
    left, below = place(np.zeros_like(ticks), ticks), place(lengths, np.full_like(lengths, low))
    return [
        *(Caption(f"{y:g}", (x - 8, at - 4), 11.0, "end") for (x, at), y in zip(left.tolist(), ticks, strict=True)),
        *(
            Caption(f"{s / 1000:g}", (x, at - 16), 11.0, "middle")
            for (x, at), s in zip(below.tolist(), lengths, strict=True)
        ),
        Caption(
            f"{name}: curvature of the rail (1/m) along its length (m); dots: points of tangency", (_LEFT, 16.0), 13.0
        ),
    ]
