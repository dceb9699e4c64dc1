"""Part lists of any origin: a JSON file with one sheet size and the parts to cut from it.

    {"name": "...", "sheet": [width, height], "gap": 5, "trim": 20, "kerf": 3,
     "parts": [{"id": 1, "row": 0, "a": 900, "b": 880, "h": 700, "ol": 10, "orr": 10, "quantity": 4},
               {"id": "X", "points": [[0, 0], [500, 0], [0, 400]]}]}

Lengths in mm. A part is the trapezoid (0, 0), (a, 0), (a - orr, h), (ol, h) or a polygon; `kerf`, `row` and
`quantity` may be left out. Outlines are rounded once to 0.001 mm.
"""

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
import shapely

from isomould.arrays import Floats, read_only, round_um
from isomould.errors import OutputFault, Refused
from isomould.nesting.layout import Id, Part
from isomould.nesting.settings import SheetStock, StockSettings

LONGEST = 1e6
"""mm; no stock is a kilometre long."""

MOST_PIECES = 200_000

_HEAD = {"name", "sheet", "gap", "trim", "kerf", "parts"}
_TRAPEZOID = ("a", "b", "h", "ol", "orr")
_PART = {"id", "row", "quantity", "points", *_TRAPEZOID}


@dataclass(frozen=True, eq=False)
class Instance:
    """A part list with its stock."""

    name: str
    parts: tuple[Part, ...]
    stock: StockSettings


def read_instance(path: Path) -> Instance:
    """Read a part list.

    Raises
    ------
    Refused
        Naming the file and the field, if anything in it is not as the format says.
    OutputFault
        If the file cannot be read.
    """
    try:
        text = path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as fault:
        _refuse(str(path), f"byte {fault.start} is not UTF-8", "a JSON file in UTF-8")
    except OSError as fault:
        message = f"E-NEST-10 {path}: {fault.strerror}. Give a file that can be read."
        raise OutputFault(message) from fault
    return parse_instance(text, str(path))


def parse_instance(text: str, file: str = "instance") -> Instance:
    """Read a part list from a text; `file` is how messages name it."""
    table = _mapping(_parse(text, file), file)
    _refuse_unknown(table, _HEAD, file)
    width, height = _numbers(_get(table, "sheet", file), f"{file}: sheet", 2)
    lengths: dict[str, Any] = {
        key: _length(table, key, file) for key in ("gap", "trim", "kerf") if key in table or key != "kerf"
    }
    name = _text(_get(table, "name", file), f"{file}: name")
    return Instance(name, _read_parts(table, file), _stock(width, height, lengths, file))


def _parse(text: str, file: str) -> object:
    try:
        return json.loads(text, parse_constant=_no_constant, object_pairs_hook=_no_duplicates)
    except (ValueError, RecursionError) as fault:
        _refuse(file, str(fault), "a JSON text with finite numbers and every key once")


def _no_constant(constant: str) -> NoReturn:
    message = f"{constant} is not a number"
    raise ValueError(message)


def _no_duplicates(pairs: list[tuple[str, object]]) -> dict[str, object]:
    table = dict(pairs)
    if len(table) < len(pairs):
        keys = [key for key, _ in pairs]
        message = f"key {next(key for key in keys if keys.count(key) > 1)!r} is given twice"
        raise ValueError(message)
    return table


def _stock(width: float, height: float, lengths: Mapping[str, Any], file: str) -> StockSettings:
    try:
        sheet = SheetStock(name="sheet", width=width, height=height)
        return StockSettings(sheets=(sheet,), **lengths)
    except ValueError as fault:
        _refuse(f"{file}: sheet, gap, trim, kerf", _first_message(fault), "a sheet with room inside the trim")


def _first_message(fault: ValueError) -> str:
    errors = getattr(fault, "errors", None)
    return str(errors()[0]["msg"]) if errors else str(fault)


def _read_parts(table: Mapping[str, object], file: str) -> tuple[Part, ...]:
    rows = _get(table, "parts", file)
    if not isinstance(rows, list) or not rows:
        _refuse(f"{file}: parts", _show(rows), "a list with at least one part")
    parts = tuple(_read_part(row, f"{file}: parts[{k}]") for k, row in enumerate(rows))
    _refuse_repeated(parts, file)
    return parts


def _refuse_repeated(parts: tuple[Part, ...], file: str) -> None:
    seen = set[Id]()
    for k, part in enumerate(parts):
        if part.id in seen:
            _refuse(f"{file}: parts[{k}].id", f"{part.id!r} is given twice", "every id once")
        seen.add(part.id)
    if sum(part.quantity for part in parts) > MOST_PIECES:
        _refuse(f"{file}: parts", f"{sum(part.quantity for part in parts)} pieces", f"at most {MOST_PIECES}")


def _read_part(row: object, field: str) -> Part:
    table = _mapping(row, field)
    _refuse_unknown(table, _PART, field)
    mark = _id(_get(table, "id", field), f"{field}.id")
    group = None if table.get("row") is None else _id(table["row"], f"{field}.row")
    quantity = _quantity(table.get("quantity", 1), f"{field}.quantity")
    return Part(mark, _outline(table, field), quantity, group)


def _outline(table: Mapping[str, object], field: str) -> Floats:
    points = _polygon(table["points"], f"{field}.points") if "points" in table else _trapezoid(table, field)
    outline = round_um(points)
    polygon = shapely.Polygon(outline)
    if not polygon.is_valid or polygon.area <= 0:
        _refuse(field, "an outline that has no area, touches or crosses itself", "a simple polygon")
    return read_only(outline)


def _polygon(points: object, field: str) -> Floats:
    if not isinstance(points, list) or len(points) < 3:
        _refuse(field, _show(points), "a list of at least 3 points")
    return np.array([_numbers(point, f"{field}[{k}]", 2) for k, point in enumerate(points)])


def _trapezoid(table: Mapping[str, object], field: str) -> Floats:
    a, b, h, ol, orr = (_number(_get(table, key, field), f"{field}.{key}") for key in _TRAPEZOID)
    if min(a, h) <= 0 or b < 0:
        _refuse(field, f"a = {a:g}, b = {b:g}, h = {h:g} mm", "a and h greater than zero, b not negative")
    if abs(a - ol - orr - b) > 0.0021:
        _refuse(f"{field}.b", f"{b:g} mm", f"a - ol - orr = {a - ol - orr:g} mm")
    corners = [(0.0, 0.0), (a, 0.0), (a - orr, h), (ol, h)]
    return np.array(corners if round(a - orr, 3) != round(ol, 3) else corners[:3])


def _quantity(value: object, field: str) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or value < 1:
        _refuse(field, _show(value), "a whole number of at least 1")
    return value


def _id(value: object, field: str) -> Id:
    if isinstance(value, bool) or not isinstance(value, int | str) or value == "":
        _refuse(field, _show(value), "a whole number or a text")
    return value


def _text(value: object, field: str) -> str:
    if not isinstance(value, str):
        _refuse(field, _show(value), "a text")
    return value


def _length(table: Mapping[str, object], key: str, file: str) -> float:
    value = _number(_get(table, key, file), f"{file}: {key}")
    if value < 0:
        _refuse(f"{file}: {key}", f"{value:g} mm", "0 mm or more")
    return value


def _numbers(value: object, field: str, count: int) -> list[float]:
    if not isinstance(value, list) or len(value) != count:
        _refuse(field, _show(value), f"a list of {count} numbers")
    return [_number(item, f"{field}[{k}]") for k, item in enumerate(value)]


def _number(value: object, field: str) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        _refuse(field, _show(value), "a number in mm")
    if not (math.isfinite(value) and abs(value) <= LONGEST):
        _refuse(field, f"{value} mm", f"a finite number up to {LONGEST:g} mm")
    return float(value)


def _mapping(value: object, field: str) -> dict[str, Any]:
    if not isinstance(value, dict):
        _refuse(field, _show(value), "a table with named fields")
    return value


def _get(table: Mapping[str, object], key: str, field: str) -> object:
    if key not in table:
        _refuse(f"{field}: {key}", "missing", "a value")
    return table[key]


def _refuse_unknown(table: Mapping[str, object], known: set[str], field: str) -> None:
    for key in table:
        if key not in known:
            near = get_close_matches(key, sorted(known), 1, 0.0)[0]
            _refuse(
                f"{field}: {key}",
                "an unknown key",
                f"one of {', '.join(sorted(known))}",
                f"Did you mean {near}?",
            )


def _show(value: object) -> str:
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


def _refuse(field: str, found: str, limit: str, way_out: str = "Correct the file.") -> NoReturn:
    raise Refused("E-NEST-11", field, found, limit, way_out)
