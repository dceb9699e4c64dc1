"""What the settings found wrong in the tables of a project: where, and in words, with the nearest key."""

import difflib
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from isomould.project.keys import known_keys
from isomould.project.wording import Words, word


def describe(error: ValidationError, data: Mapping[str, Any]) -> Iterator[tuple[str, Words]]:
    """Give field and words of everything that was found."""
    for each in error.errors():
        for words in _describe(each, data):
            yield _field(each, data), words


def _field(detail: ErrorDetails, data: Mapping[str, Any]) -> str:
    """Name the field that one of pydantic's findings is about."""
    path, _ = _locate(detail["loc"], data, lost=detail["type"] == "missing")
    return ".".join(path) or "project file"


def _describe(detail: ErrorDetails, data: Mapping[str, Any]) -> list[Words]:
    """Say value found, limit and way out of one of pydantic's findings, which may be several in one."""
    path, siblings = _locate(detail["loc"], data, lost=detail["type"] == "missing")
    if detail["type"] == "extra_forbidden":
        known = known_keys(path[:-1], data)
        near = difflib.get_close_matches(path[-1], known, 1, 0.5)
        if path[-1] in known_keys(path[:-1]):
            limit = f"one of {', '.join(known)}"
            return [Words("a key of another kind of this table", limit, "Remove it, or change the kind.")]
        hint = f"Did you mean {near[0]!r}?" if near else "Remove it or see docs/project-file.md for the keys."
        return [Words("unknown key", f"one of {', '.join(known)}", hint)]
    if detail["type"] == "missing":
        given = ", ".join(siblings) or "empty"
        return [Words("missing", "required", f"Add it to {'.'.join(path[:-1]) or 'the file'} ({given} given).")]
    return word(detail)


def _locate(location: Sequence[str | int], data: Mapping[str, Any], lost: bool) -> tuple[list[str], list[str]]:
    """Path of a finding, a lost key among them, without pydantic's names for members of unions; keys beside it."""
    path: list[str] = []
    place: Any = data
    siblings: list[str] = []
    for depth, part in enumerate(location):
        last = depth == len(location) - 1
        here = isinstance(place, dict) and (part in place or (last and lost))
        if here or (isinstance(part, int) and isinstance(place, list)):
            siblings = [str(key) for key in place] if isinstance(place, dict) else []
            path.append(str(part))
            place = place.get(part) if isinstance(place, dict) else _item(place, int(part))
    return path, siblings


def _item(values: list[Any], number: int) -> Any:
    """Item of a list, None beyond its end: a list that is too short is itself the finding."""
    return values[number] if number < len(values) else None
