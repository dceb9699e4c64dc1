"""`tables/*.parquet` through pyarrow, which `isomould[parquet]` installs."""

import math
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from isomould.verify.read.text import refusing
from isomould.verify.rules import Unreadable


@refusing
def read_parquet(path: Path) -> dict[str, tuple[Any, ...]]:
    """Read the columns of a table by name; None for a blank number or truth."""
    if find_spec("pyarrow") is None:
        message = "cannot be read without pyarrow. Run: pip install 'isomould[parquet]'"
        raise Unreadable(message)
    found: dict[str, list[Any]] = import_module("pyarrow.parquet").read_table(path).to_pydict()
    return {name: tuple(map(_plain, values)) for name, values in found.items()}


def _plain(value: Any) -> Any:
    return None if isinstance(value, float) and math.isnan(value) else value
