"""What is wrong with a value of a project file, in words: what was found, the limit, a way out.

Our own validators say "found; limit", or the limit alone ("must be …"); pydantic's texts all end in the limit.
"""

import re
from typing import NamedTuple

from pydantic_core import ErrorDetails

_OPENINGS = re.compile(r"(Value error, )?(Input should be |String should (have |match )?|must (be |lie )?)?")
_COMMA = re.compile(r"\d,\d")
_TOGETHER = "keys that do not go together"


_SAID = {
    "model_type": "a table {key = value, …}",
    "dict_type": "a table {key = value, …}",
    "tuple_type": "a list […]",
    "union_tag_not_found": "a table with its kind",
}
"""Limits that pydantic words for programmers."""


class Words(NamedTuple):
    """The last three parts of a refusal."""

    found: str
    limit: str
    way_out: str


def word(detail: ErrorDetails) -> list[Words]:
    """Word a finding about a value, or about values that do not go together: those come one a line.

    >>> word({"type": "less_than_equal", "loc": (), "msg": "Input should be less than or equal to 9", "input": 12})
    [Words(found='12', limit='less than or equal to 9', way_out='Change the value.')]
    """
    return [_word({**detail, "msg": line}) for line in detail["msg"].split("\n")]


def _word(detail: ErrorDetails) -> Words:
    found, semicolon, limit = detail["msg"].removeprefix("Value error, ").partition("; ")
    if semicolon:
        return Words(found, limit, _way_out(detail["input"]))
    return Words(_shown(detail["input"]), _limit(detail), _way_out(detail["input"]))


def _shown(value: object) -> str:
    if isinstance(value, dict):
        return _TOGETHER
    text = repr(value)
    return text if len(text) <= 48 else f"{text[:45]}…"


def _limit(detail: ErrorDetails) -> str:
    context = detail.get("ctx", {})
    if "expected_tags" in context:
        return f"one of {context['expected_tags']}"
    text = _SAID.get(detail["type"], detail["msg"])
    return text[_OPENINGS.match(text).end() :]  # type: ignore[union-attr]


def _way_out(value: object) -> str:
    if isinstance(value, str) and _COMMA.search(value):
        return f"Write a decimal point: {value.replace(',', '.')}."
    return "Change one of them." if isinstance(value, dict) else "Change the value."
