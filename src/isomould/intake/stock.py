"""What a user says about the stock beside a part list: the `[stock]` table of a TOML file, such as a project."""

import tomllib
from pathlib import Path
from typing import Any

from isomould.nesting.instance import read_text
from isomould.nesting.part_rows import mapping, refuse


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
