"""From parts and stock to what the search works on: classes of equal outlines, kinds and frames."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely

from isomould.arrays import Floats, Ints
from isomould.errors import Refused
from isomould.nesting.bound import Room, bound_stock, fits, room_inside
from isomould.nesting.cover import PLENTY, Rack
from isomould.nesting.layout import Id, Part
from isomould.nesting.linked import measure_links
from isomould.nesting.material import Grain
from isomould.nesting.settings import SheetStock, StockSettings, allowed_rotations_deg
from isomould.nesting.shapes import UM, micrometres, round_away, stand
from isomould.nesting.sheets import Frame
from isomould.nesting.strips import Grid, Item, Kind, sort_kinds

STEP = 1000
"""Micrometres; the grid on which strips are filled, unless the stock is very long."""

LONGEST = 12_000
"""Grid steps in the longest strip."""

COARSE = 1500
"""The same on a coarse grid, on which a strip loses two parts in a thousand."""


FREE = 1e-6
"""What a remnant without a price costs, in shares of the dearest sheet."""


@dataclass(frozen=True, eq=False)
class PartClass:
    """Parts with the same outline and holes, whatever their marks; pieces in the order in which they are placed."""

    polygon: shapely.Polygon
    outline: Floats
    grain: Grain | None
    pieces: tuple[tuple[Id, str | None], ...]


@dataclass(frozen=True)
class Case:
    """One way to cut a sheet: strips of a length, stacked to a height, micrometres; cost, area: shares."""

    stock: int
    turned: bool
    length: int
    height: int
    cost: float
    area: float
    zones: bool = True


def sort_classes(parts: Sequence[Part]) -> tuple[PartClass, ...]:
    """Join the parts with equal outlines, holes and grain, in the order of their first."""
    groups = dict[tuple[Grain | None, tuple[bytes, ...]], list[Part]]()
    for part in parts:
        groups.setdefault((part.grain, _form(part)), []).append(part)
    return tuple(_part_class(group) for group in groups.values())


def _form(part: Part) -> tuple[bytes, ...]:
    """Give outline and holes from the corner of the box: equal for parts that are equal."""
    corner = micrometres(part.outline).min(axis=0)
    return tuple((micrometres(ring) - corner).tobytes() for ring in (part.outline, *part.holes))


def _part_class(group: list[Part]) -> PartClass:
    pieces = tuple((part.id, location) for part in group for location in locations(part.locations, part.quantity))
    return PartClass(group[0].polygon, group[0].outline, group[0].grain, pieces)


def locations(given: tuple[str, ...], quantity: int) -> tuple[str | None, ...]:
    """Give one location per piece, None where there are none."""
    return given or (None,) * quantity


def make_rack(classes: Sequence[PartClass], stock: StockSettings, *, coarse: bool = False) -> Rack:
    """Set up every way to cut every stock sheet, measured on a fine or a coarse grid."""
    rooms = [room_inside(sheet.width, sheet.height, stock.trim) for sheet in stock.sheets]
    longest = max(max(room.width, room.height) for room in rooms)
    grid = make_grid(longest, stock, COARSE if coarse else LONGEST)
    frames = [frame for index in range(len(rooms)) for frame in _frames(index, rooms, classes, stock, grid)]
    pieces = [PLENTY if sheet.quantity is None else sheet.quantity for sheet in stock.sheets]
    areas = _areas(classes, rooms)
    return Rack(tuple(frames), np.array(pieces, dtype=np.int64), areas, _goal(classes, stock))


def _goal(classes: Sequence[PartClass], stock: StockSettings) -> int:
    """Give the bound where fewer sheets are all that can be gained: with a single kind of sheet."""
    pieces = [kind.polygon for kind in classes for _ in kind.pieces]
    return bound_stock(pieces, stock).sheets if len(stock.sheets) == 1 else 0


def make_blank_rack(classes: Sequence[PartClass], stock: StockSettings) -> Rack:
    """Set up blanks to order: the longest strip, as high as the highest part, without quarter turns."""
    height = max(int(np.ptp(micrometres(kind.outline)[:, 1])) for kind in classes)
    room = Room(blank_length(stock), height)
    grid = make_grid(room.width, stock)
    kinds = classes_by_kind(classes, lambda _: (0,), grid)
    frame = _frame(Case(0, False, room.width, room.height, 1.0, 1.0), kinds, grid)
    return Rack((frame,), np.array([PLENTY]), _areas(classes, [room]))


def blank_length(stock: StockSettings) -> int:
    """Give the room for a strip in the longest blank, micrometres."""
    return room_inside(stock.max_blank_length, stock.max_blank_length, stock.trim).width


def make_grid(longest: int, stock: StockSettings, steps: int = LONGEST) -> Grid:
    """Give a grid that is fine enough for panels and coarse enough for coils."""
    step = STEP * max(1, -(-longest // (STEP * steps)))
    return Grid(step, stock.gap * UM, flips=stock.turning != "none", turns_over=stock.turn_over)


def _areas(classes: Sequence[PartClass], rooms: Sequence[Room]) -> Floats:
    largest = max(room.width * room.height for room in rooms) / UM**2
    return np.array([shapely.Polygon(kind.outline).area for kind in classes]) / largest


def _frames(
    index: int, rooms: Sequence[Room], classes: Sequence[PartClass], stock: StockSettings, grid: Grid
) -> list[Frame]:
    """Give both ways to cut a sheet: strips along its width, and along its height.

    A strip along the height is planned lying and then turned, so that a part keeps its own position on the sheet when
    it stands turned by a quarter in the plan. Without half turns a part must not be mirrored there, nor lie in
    a zone: either would come out upside down.
    """
    sheet, room = stock.sheets[index], rooms[index]
    quarters = 90 in allowed_rotations_deg(stock, sheet)
    share = room.width * room.height / max(room.width * room.height for room in rooms)
    cost = _cost(sheet, stock.sheets, share)
    lying = Case(index, False, room.width, room.height, cost, share)
    upright = Case(index, True, room.height, room.width, cost, share, zones=grid.flips)
    over = grid if grid.flips else replace(grid, turns_over=False)
    free = quarters and not any(kind.grain for kind in classes)
    along = classes_by_kind(classes, lambda kind: _turns_lying(kind, quarters=quarters), grid)
    across = along if free else classes_by_kind(classes, lambda kind: _turns_upright(kind, quarters=quarters), over)
    return [_frame(lying, along, grid), _frame(upright, across, grid)]


def _turns_lying(kind: PartClass, *, quarters: bool) -> tuple[int, ...]:
    """Give how a class may stand in a strip along the width, which is where the grain of sheets runs."""
    if kind.grain == "across":
        return (90,)
    return (0,) if kind.grain == "along" or not quarters else (0, 90)


def _turns_upright(kind: PartClass, *, quarters: bool) -> tuple[int, ...]:
    """Give how a class may stand in a strip along the height, which is turned by a quarter when it is cut."""
    return tuple((turn + 90) % 180 for turn in _turns_lying(kind, quarters=quarters))


def _cost(sheet: SheetStock, sheets: Sequence[SheetStock], share: float) -> float:
    """Give the price if any sheet has one, else the area, as shares of the largest; sheets for nothing cost little."""
    dearest = max(other.price for other in sheets)
    return sheet.price / dearest or FREE * share if dearest else share


def classes_by_kind(
    classes: Sequence[PartClass], turns: Callable[[PartClass], tuple[int, ...]], grid: Grid
) -> tuple[Kind, ...]:
    """Stand every class on the strip in its rotations and sort the shapes into kinds."""
    shapes = [(index, stand(kind.outline, turn)) for index, kind in enumerate(classes) for turn in turns(kind)]
    return sort_kinds(shapes, [len(kind.pieces) for kind in classes], grid)


def _frame(case: Case, kinds: Sequence[Kind], grid: Grid) -> Frame:
    """Give the frame of a case, with what fits into it."""
    gap = round_away(grid.gap)
    capacity = (case.length + gap) // grid.step
    low = (kind for kind in kinds if kind.height <= case.height)
    fitting = (part for kind in low for part in _fitting(kind, case.length, capacity, grid))
    return Frame(
        stock=case.stock,
        turned=case.turned,
        capacity=capacity,
        room=case.height + gap,
        gap=gap,
        step=grid.step,
        cost=case.cost,
        area=case.area,
        kinds=tuple(kind for kind in fitting if kind.items),
        zones=case.zones,
    )


def _fitting(kind: Kind, length: int, capacity: int, grid: Grid) -> tuple[Kind, Kind]:
    """Give the items that fit with the ends of a chain, and those of which just the box does."""
    items = [item for item in kind.items if item.shape.width <= length]
    nested = tuple(item for item in items if _alone(kind, item, grid) <= capacity)
    boxes = [grid.box(item.part, item.shape) for item in items if _alone(kind, item, grid) > capacity]
    alone = tuple(replace(box, size=min(box.size, capacity)) for box in boxes)
    return replace(kind, items=nested), Kind(kind.height, None, alone)


def _alone(kind: Kind, item: Item, grid: Grid) -> int:
    """Give what a chain of one takes, in grid steps."""
    if kind.links:
        links = measure_links([item], grid)
        return int((links.start + links.end).max())
    return item.size + (kind.ends.odd if kind.ends else 0)


def piece_counts(classes: Sequence[PartClass]) -> Ints:
    """Give the pieces of every class."""
    return np.array([len(kind.pieces) for kind in classes], dtype=np.int64)


def refuse_oversize(parts: Sequence[Part], stock: StockSettings) -> None:
    """Refuse a part that fits no sheet in any rotation that is allowed there, with the size that it needs."""
    for part in parts:
        if not any(fits(part.outline, sheet, stock, part.grain) for sheet in stock.sheets):
            width, height = box(part.outline)
            found = f"needs {width + 2 * stock.trim:g} x {height + 2 * stock.trim:g} mm with the trim"
            limit = " or ".join(f"{sheet.width:g} x {sheet.height:g} mm ({sheet.name})" for sheet in stock.sheets)
            way_out = "Add a larger sheet or divide the part."
            if part.grain:
                found += f", its grain {part.grain} the first of them and that of sheets along their width"
                way_out = "Add a larger sheet, or write one whose grain runs the other way as HEIGHTxWIDTH."
            raise Refused("E-NEST-01", f"part {part.id}", found, limit, way_out)


def box(outline: Floats) -> tuple[float, float]:
    """Give the size of the bounding box, mm."""
    width, height = np.ptp(micrometres(outline), axis=0) / UM
    return float(width), float(height)
