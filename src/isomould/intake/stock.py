"""What a user says about the stock beside a part list: the `[stock]` table of a TOML file, or options of a command."""

import re
import tomllib
from pathlib import Path
from typing import Any

from isomould.intake.instance import read_text
from isomould.intake.part_rows import mapping, refuse
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
    """Give the stock sheet that an option says: its width and height.

    Raises
    ------
    ValueError
        If it is none.

    Examples
    --------
    >>> sheet_of("6000x3210"), sheet_of("2.5 m x 49 in")["height"]
    ({'name': '6000 x 3210', 'width': 6000.0, 'height': 3210.0}, 1244.6)
    """
    sides = [side.strip() for side in re.split("[xX×]", text)]
    if len(sides) != 2:
        message = f"{text!r} is no sheet; width x height, such as 6000x3210 or '6 m x 3.21 m'"
        raise ValueError(message)
    width, height = map(length_of, sides)
    return {"name": f"{width:.12g} x {height:.12g}", "width": width, "height": height}


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
    """
    section, _, length = text.rpartition("=")
    if not section.strip():
        message = f"{text!r} is no bar; section=length, such as 'FL200*12=6 m'"
        raise ValueError(message)
    return {"section": section.strip(), "length": length_of(length.strip())}
