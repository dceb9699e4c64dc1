"""Part lists with their stock: the value that all readers of part lists make, and its JSON file.

    {"name": "...", "sheet": [width, height], "gap": 5, "trim": 20, "kerf": 3,
     "parts": [{"id": 1, "row": 0, "a": 900, "b": 880, "h": 700, "ol": 10, "orr": 10, "quantity": 4},
               {"id": "X", "points": [[0, 0], [500, 0], [0, 400]]}]}

Lengths in mm. A part is the trapezoid (0, 0), (a, 0), (a - orr, h), (ol, h) or a polygon; `row` and `quantity` may be
left out. Instead of `sheet` there may be `sheets`, and beside them `kerf`, `turning`, `turn_over` and `guillotine`:
they hold what the `[stock]` table of a project holds.
"""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any, Literal, NoReturn

from pydantic import ValidationError

from isomould.errors import OutputFault
from isomould.intake.part_rows import get, mapping, numbers, read_parts, refuse, refuse_unknown, show
from isomould.nesting.layout import Part
from isomould.nesting.settings import StockSettings

_STOCK = {"sheets", "gap", "trim", "kerf", "turning", "turn_over", "guillotine"}
_HEAD = {"name", "sheet", "parts", *_STOCK}
_NEEDED = {"sheets": ("sheet", "6000x3210"), "bars": ("bar", "'FL200*12=6 m'")}
NOTHING: Mapping[str, Any] = MappingProxyType({})


@dataclass(frozen=True, eq=False)
class Instance:
    """A part list with its stock."""

    name: str
    parts: tuple[Part, ...]
    stock: StockSettings


def read_instance(path: Path, asked: Mapping[str, Any] = NOTHING) -> Instance:
    """Read a part list.

    Parameters
    ----------
    path
        A JSON file.
    asked
        Keys of the `[stock]` table that take the place of the file's own.

    Raises
    ------
    Refused
        Naming the file and the field, if anything in it is not as the format says.
    OutputFault
        If the file cannot be read.
    """
    return parse_instance(read_text(path, "a JSON file in UTF-8"), str(path), asked)


def read_text(path: Path, limit: str) -> str:
    """Read a text in UTF-8, with or without a byte order mark."""
    try:
        return path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as fault:
        refuse(str(path), f"byte {fault.start} is not UTF-8", limit, "Save the file as UTF-8.")
    except OSError as fault:
        message = f"E-NEST-10 {path}: {fault.strerror}. Give a file that can be read."
        raise OutputFault(message) from fault


def parse_instance(text: str, file: str = "instance", asked: Mapping[str, Any] = NOTHING) -> Instance:
    """Read a part list from a text; `file` is how messages name it."""
    table = mapping(parse_json(text, file), file)
    refuse_unknown(table, _HEAD, file)
    name = _text(get(table, "name", file), f"{file}: name")
    return Instance(name, _read_parts(table, file), _read_stock(table, file, asked))


def parse_json(text: str, file: str) -> object:
    """Read a JSON text strictly: finite numbers, every key once."""
    try:
        return json.loads(text, parse_constant=_no_constant, object_pairs_hook=_no_duplicates)
    except (ValueError, RecursionError) as fault:
        refuse(file, str(fault), "a JSON text with finite numbers and every key once")


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


def _read_stock(table: Mapping[str, Any], file: str, asked: Mapping[str, Any]) -> StockSettings:
    own = {key: table[key] for key in table if key in _STOCK}
    if "sheet" in table:
        if "sheets" in table:
            refuse(f"{file}: sheet, sheets", "both", "one of them", "Move the sheet to the list of sheets.")
        width, height = numbers(table["sheet"], f"{file}: sheet", 2)
        own["sheets"] = [{"name": "sheet", "width": width, "height": height}]
    given = {**own, **asked}
    for key in ("gap", "trim"):
        get(given, key, file)
    return make_stock(given, file)


def make_stock(given: Mapping[str, Any], file: str, needs: Literal["sheets", "bars"] = "sheets") -> StockSettings:
    """Check what is said about the stock, the keys of a `[stock]` table.

    Raises
    ------
    Refused
        E-NEST-11, naming the field; without any sheet, or bar where bars are needed, too.
    """
    if not given.get(needs):
        one, example = _NEEDED[needs]
        way_out = f"Give --{one} {example}, or --stock FILE.toml with a [stock] table that has {needs}."
        refuse(f"{file}: {one}", "missing", f"at least one stock {one}", way_out)
    try:
        return StockSettings.model_validate(dict(given))
    except ValidationError as fault:
        detail = fault.errors()[0]
        field = ".".join(str(key) for key in detail["loc"]) or "sheets, gap, trim, kerf"
        found, _, limit = detail["msg"].removeprefix("Value error, ").partition("; ")
        if detail["type"] == "missing":
            refuse(f"{file}: {field}", "missing", "a value as the [stock] table asks", "Give the value.")
        shown = "" if limit else f"{show(detail['input'])}: "
        refuse(f"{file}: {field}", f"{shown}{found}", limit or "a value as the [stock] table asks", "Change the value.")


def _read_parts(table: Mapping[str, object], file: str) -> tuple[Part, ...]:
    rows = get(table, "parts", file)
    if not isinstance(rows, list) or not rows:
        refuse(f"{file}: parts", show(rows), "a list with at least one part")
    return read_parts([(row, f"{file}: parts[{k}]") for k, row in enumerate(rows)], file)


def _text(value: object, field: str) -> str:
    if not isinstance(value, str):
        refuse(field, show(value), "a text")
    return value
