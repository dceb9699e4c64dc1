"""JSON read strictly: no NaN, no duplicate keys, nothing but an object at the top."""

import json
from collections.abc import Callable
from functools import wraps
from pathlib import Path
from typing import Any, NoReturn, ParamSpec, TypeVar

from isomould.verify.rules import Unreadable

P = ParamSpec("P")
T = TypeVar("T")
Json = dict[str, Any]


def refusing(read: Callable[[Path], T]) -> Callable[[Path], T]:
    """Turn whatever goes wrong while a file is read into `Unreadable`, naming the file."""

    @wraps(read)
    def reader(path: Path) -> T:
        try:
            return read(path)
        except Exception as fault:
            message = f"{path.parent.name}/{path.name}: {fault or type(fault).__name__}"
            raise Unreadable(message) from fault

    return reader


@refusing
def read_json(path: Path) -> Json:
    """Read a JSON object."""
    text = path.read_text("utf-8")
    found: object = json.loads(text, parse_constant=_no_constant, object_pairs_hook=_unique)
    if not isinstance(found, dict):
        _refuse("not a JSON object")
    return found  # pyright: ignore[reportUnknownVariableType] - keys of JSON objects are strings


def _no_constant(name: str) -> NoReturn:
    _refuse(f"{name} is not a JSON number")


def _unique(pairs: list[tuple[str, Any]]) -> Json:
    found = dict(pairs)
    if len(found) < len(pairs):
        _refuse("duplicate key")
    return found


def _refuse(message: str) -> NoReturn:
    raise Unreadable(message)
