"""Rows of member lists, whatever file they come from: every field checked, ends of flat bars as outlines."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from isomould.intake.part_rows import (
    Row,
    get,
    mapping,
    refuse,
    refuse_repeated,
    refuse_unknown,
    show,
    to_id,
    to_number,
    to_quantity,
)
from isomould.nesting.layout import Member
from isomould.nesting.settings import StockSettings

STEEPEST = 80.0
"""Largest angle of an end from square, degrees."""

_KEYS = {"section", "id", "quantity", "length", "depth", "end_angle_start", "end_angle_end", "material", "grade"}


@dataclass(frozen=True, eq=False)
class MemberList:
    """A list of members with its stock."""

    name: str
    members: tuple[Member, ...]
    stock: StockSettings


def read_members(rows: Sequence[Row], file: str) -> tuple[Member, ...]:
    """Turn rows into members.

    A row with `depth` is a flat bar of that width whose ends lean by `end_angle_start` and `end_angle_end` degrees from
    square, positive where the top is longer; `length` is from end to end over all.

    Raises
    ------
    Refused
        E-NEST-11, naming the place in the file, what it says and what it should.
    """
    members = tuple(_read_member(*row) for row in rows)
    refuse_repeated(members, [field for _, field in rows], file)
    return members


def _read_member(row: object, field: str) -> Member:
    table = mapping(row, field)
    refuse_unknown(table, _KEYS, field)
    section = get(table, "section", field)
    if not isinstance(section, str) or not section.strip() or not section.isprintable() or len(section) > 120:
        refuse(f"{field}.section", show(section), "one line of printable text of at most 120 characters")
    length = to_number(get(table, "length", field), f"{field}.length")
    if length <= 0:
        refuse(f"{field}.length", f"{length:g} mm", "greater than zero")
    mark = to_id(get(table, "id", field), f"{field}.id")
    quantity = to_quantity(table.get("quantity", 1), f"{field}.quantity")
    ends = [_angle(table.get(key, 0), f"{field}.{key}") for key in ("end_angle_start", "end_angle_end")]
    outline = _outline(round(length, 3), table.get("depth"), ends, field)
    return Member(mark, section, round(length, 3), quantity, (), outline)


def _angle(value: object, field: str) -> float:
    angle = to_number(value, field)
    if abs(angle) > STEEPEST:
        refuse(field, f"{angle:g}°", f"at most {STEEPEST:g}° from square")
    return angle


def _outline(length: float, depth: object, ends: Sequence[float], field: str) -> tuple[tuple[float, float], ...]:
    """Give the outline of a flat bar, lower edge first; nothing where its ends are square or its width is not known."""
    if depth is None:
        return ()
    width = to_number(depth, f"{field}.depth")
    if width <= 0:
        refuse(f"{field}.depth", f"{width:g} mm", "greater than zero")
    if not any(ends):
        return ()
    (low, high), (off, over) = (_set_back(angle, width) for angle in ends)
    if min(length - low - off, length - high - over) <= 0:
        found = f"{length:g} mm with ends of {ends[0]:g}° and {ends[1]:g}° over {width:g} mm"
        refuse(
            f"{field}.length", found, f"more than {max(low + off, high + over):.3f} mm", "Is it the length over all?"
        )
    corners = [(low, 0.0), (length - off, 0.0), (length - over, width), (high, width)]
    return tuple((round(x, 3), y) for x, y in corners)


def _set_back(angle: float, width: float) -> tuple[float, float]:
    """Give what bottom and top stand back from the end, mm."""
    run = width * math.tan(math.radians(angle))
    return max(run, 0.0), max(-run, 0.0)


def refuse_unlike_ends(rows: Sequence[Row], stock: StockSettings) -> None:
    """Refuse ends that should lie head to tail on bars of unknown or different widths (E-NEST-11)."""
    widths = dict[object, object]()
    for row, field in rows if stock.bar_ends == "head-to-tail" else ():
        table = mapping(row, field)
        depth = table.get("depth")
        if depth is not None and widths.setdefault(table["section"], depth) != depth:
            limit = f"{widths[table['section']]:g} mm as before, for bars of one section"
            refuse(f"{field}.depth", f"{depth:g} mm", limit, "Give bars of another width another section.")
        if table.get("depth") is None and (table.get("end_angle_start") or table.get("end_angle_end")):
            way_out = 'Add a column depth, or nest with bar_ends = "square".'
            refuse(f"{field}.depth", "missing beside an end that is not square", "the width of the flat bar", way_out)
