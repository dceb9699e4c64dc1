"""Cells of part lists as numbers: which sign divides the decimals is found out for the whole file, never guessed."""

import re
from collections.abc import Iterable

from isomould.intake.part_rows import refuse, show

_POINT = re.compile(r"[+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?")
_COMMA = re.compile(r"[+-]?(?:\d+(?:,\d*)?|,\d+)")


def decimal_sign(cells: Iterable[str], separator: str, file: str) -> str:
    """Tell which sign the numbers of a file have before their decimals: a comma only where it separates no cells."""
    texts = list(cells)
    with_comma = next((text for text in texts if "," in text), None)
    with_point = next((text for text in texts if "." in text), None)
    if with_comma is None or separator == ",":
        return "."
    if with_point is not None:
        found = f"{with_comma!r} and {with_point!r}"
        refuse(file, found, "one decimal sign in all numbers, and none between thousands", "Write decimal points.")
    return ","


def to_number(text: str, sign: str, factor: float, field: str) -> float:
    """Give a cell as a number in mm; `factor` mm are one of its units."""
    pattern = _COMMA if sign == "," else _POINT
    if not pattern.fullmatch(text):
        limit = f"a number with a decimal {'comma' if sign == ',' else 'point'}, nothing between thousands"
        refuse(field, show(text), limit)
    return float(text.replace(",", ".")) * factor


def to_count(text: str, field: str) -> int:
    """Give a cell as a number of pieces."""
    if not text.isascii() or not text.isdigit() or len(text) > 9 or int(text) < 1:
        refuse(field, show(text) if text else "blank", "a whole number of at least 1")
    return int(text)
