"""What a user says about the stock beside a part list: the `[stock]` table of a TOML file, or options of a command."""

import re
import tomllib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from isomould.intake.instance import read_text
from isomould.intake.part_rows import mapping, refuse
from isomould.intake.vocabulary import says
from isomould.nesting.material import Material
from isomould.units import parse_length


def read_stock(path: Path) -> dict[str, Any]:
    """Give the `[stock]` table of a TOML file.

    Raises
    ------
    Refused
        E-NEST-11, naming the file.
    OutputFault
        If the file cannot be read.
    """
    try:
        table = tomllib.loads(read_text(path, "a TOML file in UTF-8"))
    except (ValueError, RecursionError) as fault:
        refuse(str(path), str(fault), "valid TOML", "Mend the line.")
    if "stock" not in table:
        refuse(f"{path}: stock", "missing", "a [stock] table", "Put the keys below [stock].")
    return mapping(table["stock"], f"{path}: stock")


def length_of(text: str) -> float:
    """Give the length that an option says: mm, or a number with its unit.

    Raises
    ------
    ValueError
        If it is none.

    Examples
    --------
    >>> length_of("5"), length_of("1/2 in")
    (5.0, 12.7)
    """
    try:
        number = float(text)
    except ValueError:
        return parse_length(text)
    return parse_length(number)


def sheet_of(text: str) -> dict[str, Any]:
    """Give the stock sheet that an option says: its width and height, and behind them other keys.

    Raises
    ------
    ValueError
        If it is none.

    Examples
    --------
    >>> sheet_of("6000x3210"), sheet_of("2.5 m x 49 in")["height"]
    ({'name': '6000 x 3210', 'width': 6000.0, 'height': 3210.0}, 1244.6)
    >>> sheet_of("2500x1250 material=Clear float thickness=18")["name"]
    '2500 x 1250 Clear float 18 mm'
    """
    size, said = _with_keys(text, _SHEET_KEYS)
    sides = [side.strip() for side in re.split("[xX×]", size)]
    if len(sides) != 2:
        message = f"{text!r} is no sheet; width x height, such as 6000x3210 or '6 m x 3.21 m'"
        raise ValueError(message)
    width, height = map(length_of, sides)
    material = Material(said.get("material", ""), said.get("grade", ""), said.get("thickness"))
    name = f"{width:.12g} x {height:.12g} {material}".strip()
    return {"name": name, "width": width, "height": height, **said}


def _with_keys(text: str, keys: Mapping[str, Callable[[str], Any]]) -> tuple[str, dict[str, Any]]:
    """Take keys with their values from behind a size: `2500x1250 material=Clear float price=30`."""
    size, *pairs = re.split(rf"\s+(?=(?:{'|'.join(keys)})\s*=)", text.strip())
    said = dict[str, Any]()
    for pair in pairs:
        key, _, value = (part.strip() for part in pair.partition("="))
        if key in said or not value:
            message = f"{pair!r}: {key} has no value, or is said twice"
            raise ValueError(message)
        said[key] = keys[key](value)
    return size, said


def _flag(text: str) -> bool:
    if not says(text, "yes") and not says(text, "no"):
        message = f"{text!r} is neither yes nor no"
        raise ValueError(message)
    return says(text, "yes")


_SHEET_KEYS: dict[str, Callable[[str], Any]] = {
    "name": str,
    "material": str,
    "grade": str,
    "thickness": length_of,
    "price": float,
    "quantity": int,
    "grain": _flag,
}

_BAR_KEYS: dict[str, Callable[[str], Any]] = {"grade": str, "price": float, "quantity": int}


def bar_of(text: str) -> dict[str, Any]:
    """Give the stock bar that an option says: its section and length.

    Raises
    ------
    ValueError
        If it is none.

    Examples
    --------
    >>> bar_of("FL200*12=6 m")
    {'section': 'FL200*12', 'length': 6000.0}
    >>> bar_of("HEA200=12 m grade=S355")["grade"]
    'S355'
    """
    size, said = _with_keys(text, _BAR_KEYS)
    section, _, length = size.rpartition("=")
    if not section.strip():
        message = f"{text!r} is no bar; section=length, such as 'FL200*12=6 m'"
        raise ValueError(message)
    return {"section": section.strip(), "length": length_of(length.strip()), **said}
