"""The base of a support on its node's sheet: the stem in its plane, under it the plate from above, both with sizes."""

import numpy as np

from isomould.arrays import Floats
from isomould.documents.shop.dimensions import below, left_of, running
from isomould.documents.shop.page import SMALL, Arc, Item, Line, Text, point
from isomould.documents.shop.rows import length_text
from isomould.documents.shop.view import View, fit_scale, scale_text
from isomould.parts.features import Hole
from isomould.parts.supports import Base

_BESIDE, _UNDER, _BETWEEN, _HEAD = 24.0, 24.0, 24.0, 14.0
"""Room for running dimensions on the left and under the plate, between plate and stem, for captions, mm."""
_CROSS, _FLAT = 1.5, 0.0005


def base_views(base: Base, box: tuple[float, float, float, float]) -> list[Item]:
    """Draw a base into a box (left, bottom, right, top), mm on paper, at a scale of its own."""
    left, bottom, right, top = box
    (wide, deep), high = np.ptp(base.plate, axis=0).tolist(), float(np.ptp(base.stem[:, 1]))
    space = (right - left - _BESIDE, top - bottom - _UNDER - _BETWEEN - _HEAD)
    scale = fit_scale((wide, deep + high), space)
    corner = np.array([(left + _BESIDE + right - wide / scale) / 2, top - _HEAD - _BETWEEN - (deep + high) / scale])
    plate = View(scale, base.plate.min(axis=0), corner)
    seat = corner + np.array([wide / 2 / scale, deep / scale + _BETWEEN])
    stem = View(scale, np.array([0.0, base.stem[:, 1].min()]), seat)
    return [*_captions(base, scale, (left, top)), *_plate(base, plate), *_stem(base, stem)]


def _captions(base: Base, scale: float, corner: tuple[float, float]) -> list[Text]:
    """Say what the views do not dimension."""
    diameters = sorted({hole.diameter for hole in base.holes})
    lines = (
        f"Base {scale_text(scale)}: stem {length_text(base.stem_thickness)} thick, over plate from above",
        f"Plate {length_text(base.plate_thickness)} thick, "
        f"{len(base.holes)} holes Ø{' and Ø'.join(map(length_text, diameters))}",
    )
    return [Text(line, (corner[0], corner[1] - SMALL - 4.5 * k), SMALL) for k, line in enumerate(lines)]


def _plate(base: Base, view: View) -> list[Item]:
    """Draw the plate with its holes and the foot of the stem; running dimensions from its lower left corner."""
    measured = np.array([*base.plate.tolist(), *((hole.x, hole.y) for hole in base.holes)])
    return [
        view.outline(base.plate),
        view.outline(_foot(base), "hidden"),
        *(item for hole in base.holes for item in _hole(hole, view)),
        *_from_corner(measured, view.place(measured.min(axis=0)), view.scale),
    ]


def _foot(base: Base) -> Floats:
    """Give the outline (4, 2) of the stem where it stands on the plate."""
    x = base.stem[base.stem[:, 1] < base.stem[:, 1].min() + _FLAT, 0]
    half = base.stem_thickness / 2
    return np.array([[x.min(), -half], [x.max(), -half], [x.max(), half], [x.min(), half]])


def _hole(hole: Hole, view: View) -> list[Item]:
    centre, radius = view.place(np.array([hole.x, hole.y])), hole.diameter / 2 / view.scale
    arms = np.eye(2) * (radius + _CROSS)
    return [
        Arc("outline", point(centre), radius),
        *(Line("centre", np.array([centre - arm, centre + arm])) for arm in arms),
    ]


def _stem(base: Base, view: View) -> list[Item]:
    """Draw the stem; running dimensions of its corners from the lower left one."""
    low = base.stem.min(axis=0)
    return [view.outline(base.stem), *_from_corner(base.stem, view.place(low), view.scale)]


def _from_corner(points: Floats, corner: Floats, scale: float) -> list[Item]:
    """Draw running dimensions of points (n, 2) across and up, from the lower left corner of their box."""
    across, up = (np.unique(axis.round(3)).tolist() for axis in (points - points.min(axis=0)).T)
    return [
        *running(below(corner), [(u / scale, length_text(u)) for u in across]),
        *running(left_of(corner), [(u / scale, length_text(u)) for u in up]),
    ]
