"""Rows of part lists, whatever file they come from: every field checked, outlines rounded once to 0.001 mm."""

import math
from collections.abc import Iterable, Mapping, Sequence
from difflib import get_close_matches
from typing import Any, NoReturn

import numpy as np
import shapely

from isomould.arrays import Floats, read_only, round_um
from isomould.errors import Refused
from isomould.nesting.layout import Id, Member, Part
from isomould.nesting.material import NAMES, Grain, Material

LONGEST = 1e6
"""mm; no stock is a kilometre long."""

MOST_PIECES = 200_000

TRAPEZOID = ("a", "b", "h", "ol", "orr")
"""Lower and upper side, height, and what the upper side stands back at its left and right."""

_GRAINS: dict[object, Grain] = {"length": "along", "width": "across"}
"""By the words of lists: the length of a part lies along x."""

_KEYS = {"id", "row", "quantity", "points", "grain", *NAMES, *TRAPEZOID}

Row = tuple[object, str]
"""What a file says of a part, and how messages call it: its place in the file."""


def read_parts(rows: Sequence[Row], file: str) -> tuple[Part, ...]:
    """Turn rows into parts.

    Raises
    ------
    Refused
        E-NEST-11, naming the place in the file, what it says and what it should.
    """
    parts = tuple(_read_part(*row) for row in rows)
    refuse_repeated(parts, [field for _, field in rows], file)
    return parts


def refuse_repeated(parts: Sequence[Part | Member], fields: Sequence[str], file: str) -> None:
    """Refuse ids that are there twice, and more pieces than can be nested."""
    seen = dict[str, str]()
    for part, field in zip(parts, fields, strict=True):
        if str(part.id) in seen:
            refuse(f"{field}.id", f"{part.id!r} is given twice, first in {seen[str(part.id)]}", "every id once")
        seen[str(part.id)] = field
    pieces = sum(part.quantity for part in parts)
    if pieces > MOST_PIECES:
        refuse(f"{file}: parts", f"{pieces} pieces", f"at most {MOST_PIECES}")


def _read_part(row: object, field: str) -> Part:
    table = mapping(row, field)
    refuse_unknown(table, _KEYS, field)
    mark = to_id(get(table, "id", field), f"{field}.id")
    group = None if table.get("row") is None else to_id(table["row"], f"{field}.row")
    quantity = to_quantity(table.get("quantity", 1), f"{field}.quantity")
    grain = _grain(table.get("grain"), f"{field}.grain")
    outline = _outline(table, field)
    return Part(mark, outline, quantity, group, material=to_material(table, field), grain=grain)


def _grain(value: object, field: str) -> Grain | None:
    if value is not None and value not in _GRAINS:
        refuse(field, show(value), "length, width, or nothing")
    return _GRAINS.get(value)


def to_material(table: Mapping[str, object], field: str) -> Material:
    """Give the material, grade and thickness of a row."""
    material, grade = (_word(table.get(name), f"{field}.{name}") for name in ("material", "grade"))
    if table.get("thickness") is None:
        return Material(material, grade)
    thickness = to_number(table["thickness"], f"{field}.thickness")
    if thickness <= 0:
        refuse(f"{field}.thickness", f"{thickness:g} mm", "greater than zero")
    return Material(material, grade, round(thickness, 3))


def _word(value: object, field: str) -> str:
    if value is None:
        return ""
    if not isinstance(value, str) or not value.isprintable() or len(value) > 120:
        refuse(field, show(value), "one line of printable text of at most 120 characters")
    return value.strip()


def _outline(table: Mapping[str, object], field: str) -> Floats:
    points = _polygon(table["points"], f"{field}.points") if "points" in table else _trapezoid(table, field)
    outline = round_um(points)
    polygon = shapely.Polygon(outline)
    if not polygon.is_valid or polygon.area <= 0:
        refuse(field, "an outline that has no area, touches or crosses itself", "a simple polygon")
    return read_only(outline)


def _polygon(points: object, field: str) -> Floats:
    if not isinstance(points, list) or len(points) < 3:
        refuse(field, show(points), "a list of at least 3 points")
    return np.array([numbers(point, f"{field}[{k}]", 2) for k, point in enumerate(points)])


def _trapezoid(table: Mapping[str, object], field: str) -> Floats:
    a, b, h, ol, orr = (to_number(get(table, key, field), f"{field}.{key}") for key in TRAPEZOID)
    if min(a, h) <= 0 or b < 0:
        refuse(field, f"a = {a:g}, b = {b:g}, h = {h:g} mm", "a and h greater than zero, b not negative")
    if abs(a - ol - orr - b) > 0.0021:
        refuse(f"{field}.b", f"{b:g} mm", f"a - ol - orr = {a - ol - orr:g} mm")
    corners = [(0.0, 0.0), (a, 0.0), (a - orr, h), (ol, h)]
    return np.array(corners if round(a - orr, 3) != round(ol, 3) else corners[:3])


def to_quantity(value: object, field: str) -> int:
    """Give a number of pieces."""
    if isinstance(value, bool) or not isinstance(value, int) or value < 1:
        refuse(field, show(value), "a whole number of at least 1")
    return value


def to_id(value: object, field: str) -> Id:
    """Give the name of a part."""
    if isinstance(value, bool) or not isinstance(value, int | str) or value == "":
        refuse(field, show(value), "a whole number or a text")
    if not str(value).isprintable() or len(str(value)) > 120:
        refuse(field, show(value), "one line of printable text of at most 120 characters")
    return value


def numbers(value: object, field: str, count: int) -> list[float]:
    """Give a list of so many finite numbers, mm."""
    if not isinstance(value, list) or len(value) != count:
        refuse(field, show(value), f"a list of {count} numbers")
    return [to_number(item, f"{field}[{k}]") for k, item in enumerate(value)]


def to_number(value: object, field: str) -> float:
    """Give a finite number, mm."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        refuse(field, show(value), "a number in mm")
    if not (math.isfinite(value) and abs(value) <= LONGEST):
        refuse(field, f"{value} mm", f"a finite number up to {LONGEST:g} mm")
    return float(value)


def mapping(value: object, field: str) -> dict[str, Any]:
    """Give a table with named fields."""
    if not isinstance(value, dict):
        refuse(field, show(value), "a table with named fields")
    return value


def get(table: Mapping[str, object], key: str, field: str) -> object:
    """Give a field that has to be there."""
    if key not in table:
        refuse(f"{field}: {key}", "missing", "a value")
    return table[key]


def refuse_unknown(table: Iterable[str], known: set[str], field: str) -> None:
    """Refuse keys that mean nothing, naming the nearest that does."""
    for key in table:
        if key not in known:
            near = get_close_matches(key, sorted(known), 1, 0.0)[0]
            limit = f"one of {', '.join(sorted(known))}"
            refuse(f"{field}: {key}", "an unknown key", limit, f"Did you mean {near}?")


def show(value: object) -> str:
    """Quote a value in a message, shortened."""
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


def refuse(field: str, found: str, limit: str, way_out: str = "Correct the file.") -> NoReturn:
    """Refuse a part list."""
    raise Refused("E-NEST-11", field, found, limit, way_out)
