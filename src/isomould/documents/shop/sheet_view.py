"""The view of a cut sheet: parts with numbers and marks, the trim, the offcut hatched, overall dimensions."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import shapely

from isomould.arrays import Floats
from isomould.documents.shop.checks import text_box
from isomould.documents.shop.dimensions import Span, below, left_of, stack, stack_height
from isomould.documents.shop.font import drawable
from isomould.documents.shop.page import NORMAL, SMALL, SMALLEST, Item, Line, Text, point
from isomould.documents.shop.placing import led, place_all, place_or_wait, within
from isomould.documents.shop.rows import length_text
from isomould.documents.shop.view import View, fit_scale
from isomould.nesting.layout import Placement, Sheet

_HATCH = 5.0
"""Distance of the lines of a hatching, mm on paper."""
_CLEAR = 0.4
_NUMBERS = (NORMAL, SMALL, SMALLEST)


@dataclass(frozen=True, eq=False)
class SheetView:
    """A sheet, what lies on it in cutting order, its trim in mm, and the offcut: x, y, width and height in mm."""

    sheet: Sheet
    placements: Sequence[Placement]
    trim: float
    offcut: tuple[float, float, float, float]


def sheet_items(shown: SheetView, box: tuple[float, float, float, float]) -> tuple[float, list[Item]]:
    """Draw a sheet into a box (left, bottom, right, top; mm on paper); give its scale too."""
    left, bottom, right, top = box
    size = np.array([shown.sheet.width, shown.sheet.height])
    spans = [Span(0.0, 0.0, length_text(side)) for side in size]
    reach = stack_height(spans[:1]) + 3.0
    scale = fit_scale(size, (right - left - reach - 3.0, top - bottom - reach - 3.0))
    place = np.array([left + reach, top - 2.0 - size[1] / scale])
    view = View(scale, np.zeros(2), place)
    drawn = [*_outlines(shown, view), *_hatching(shown, view), *_dimensions(size, view)]
    names, waiting = _names(shown, view)
    items = [*drawn, *names]
    return scale, [*items, *led(waiting, items, np.array([[left, bottom], [right, top]]))]


def _outlines(shown: SheetView, view: View) -> list[Item]:
    sheet = shown.sheet
    items: list[Item] = [view.outline(_box(0.0, 0.0, sheet.width, sheet.height), "frame")]
    if shown.trim:
        inside = _box(shown.trim, shown.trim, sheet.width - 2 * shown.trim, sheet.height - 2 * shown.trim)
        items.append(view.outline(inside, "hidden"))
    return [*items, *(view.outline(placement.points) for placement in shown.placements)]


def _dimensions(size: Floats, view: View) -> list[Item]:
    low, high = view.place(np.zeros(2)), view.place(size)
    across = Span(0.0, float(high[0] - low[0]), length_text(float(size[0])))
    upright = Span(0.0, float(high[1] - low[1]), length_text(float(size[1])))
    return [*stack(below(low), [across]), *stack(left_of(low), [upright])]


def _hatching(shown: SheetView, view: View) -> list[Item]:
    """Hatch the offcut around its size; nothing where it is too thin to be seen."""
    x, y, width, height = shown.offcut
    corners = view.place(_box(x, y, width, height))
    low, high = corners.min(axis=0), corners.max(axis=0)
    if min(high - low) < 1.0:
        return []
    label = _offcut_label(width, height, corners)
    taken = shapely.union_all([shapely.Polygon(text_box(text)).buffer(0.8) for text in label])
    inside = shapely.box(*(low + 0.3), *(high - 0.3))
    reach = float((high - low).sum())
    starts = np.arange(_HATCH, reach, _HATCH)
    lines = [shapely.LineString([(low[0], low[1] + s), (low[0] + s, low[1])]) for s in starts.tolist()]
    kept = [line.intersection(inside).difference(taken) for line in lines]
    pieces = [part for one in kept for part in getattr(one, "geoms", [one]) if part.length > 0.5]
    frame = Line("thin", corners, closed=True)
    return [frame, *(Line("thin", np.array(part.coords)) for part in pieces), *label]


def _offcut_label(width: float, height: float, corners: Floats) -> list[Text]:
    """Write the size of the offcut into it, along its longer side, where it has room."""
    text = f"Offcut {length_text(width)} x {length_text(height)}"
    centre = corners.mean(axis=0)
    level = [Text(text, point(centre - [0.0, size / 2]), size, "middle") for size in (SMALL, SMALLEST)]
    upright = [
        Text(text, (float(centre[0]) + size / 2, float(centre[1])), size, "middle", float(np.pi / 2))
        for size in (SMALL, SMALLEST)
    ]
    fitting = (label for label in (*level, *upright) if within(label, corners))
    return [label for label in [next(fitting, None)] if label]


def _names(shown: SheetView, view: View) -> tuple[list[Item], list[tuple[str, Floats]]]:
    """Write number, mark and location into every part; numbers that find no room wait for leaders."""
    items, waiting = list[Item](), list[tuple[str, Floats]]()
    for number, placement in enumerate(shown.placements, start=1):
        outline = view.place(placement.points)
        loop = outline if shapely.Polygon(outline).exterior.is_ccw else outline[::-1]
        target = np.array(shapely.Polygon(outline).representative_point().coords[0])
        around = [Line("outline", loop, closed=True)]
        texts, without = place_or_wait([(str(number), target, _number(str(number), target, loop))], around, _CLEAR)
        waiting += without
        items += [*texts, *place_all(_marks(placement, target, loop), [*around, *texts], _CLEAR)]
    return items, waiting


def _number(text: str, target: Floats, loop: Floats) -> Iterator[Text]:
    """Ways to write the number of a part: large above its middle, where the mark has room below, or in it."""
    for size in _NUMBERS:
        for rise in (0.6, -size / 2):
            label = Text(text, point(target + np.array([0.0, rise])), size, "middle", bold=True)
            if _inside(label, loop):
                yield label


def _marks(placement: Placement, target: Floats, loop: Floats) -> Iterator[list[Text]]:
    """Ways to write mark and location below the number, or upright beside it."""
    mark, location = drawable(str(placement.id)), drawable(placement.location or "")
    for k, text in enumerate(filter(None, (mark, location))):
        yield [
            label
            for size in (SMALL, SMALLEST)
            for label in (
                Text(text, point(target - [0.0, (k + 1) * (size + 1.2) - 0.4]), size, "middle"),
                Text(
                    text,
                    (float(target[0]) + (k + 1) * (size + 1.2) + 1.0, float(target[1])),
                    size,
                    "middle",
                    float(np.pi / 2),
                ),
            )
            if _inside(label, loop)
        ]


def _inside(label: Text, loop: Floats) -> bool:
    """Tell whether a text lies inside an outline that need not be convex."""
    return within(label, loop) or bool(shapely.Polygon(loop).contains(shapely.Polygon(text_box(label))))


def _box(x: float, y: float, width: float, height: float) -> Floats:
    return np.array([[x, y], [x + width, y], [x + width, y + height], [x, y + height]])
