"""V41d: the Parquet files say what the CSV files say, type by type."""

from collections.abc import Iterator
from typing import Any

from isomould.verify.delivery import Delivery
from isomould.verify.read.parquet import read_parquet
from isomould.verify.read.tables import Table, number
from isomould.verify.rules import Measured, NotApplicable, Rule, faults


def twins(delivery: Delivery) -> Measured:
    """Compare every cell of every table with its Parquet twin."""
    if not delivery.design.raw["parquet"]:
        raise NotApplicable("the project asks for no Parquet files")
    files = {path.stem: path for path in delivery.files("tables", "parquet")}
    problems = [f"tables/{name}.parquet has no twin" for name in sorted(files.keys() ^ delivery.tables.keys())]
    for name in sorted(files.keys() & delivery.tables.keys()):
        problems += _faults(delivery.tables[name], read_parquet(files[name]))
    return faults(sum(table.rows * len(table.columns) for table in delivery.tables.values()), problems)


def _faults(table: Table, found: dict[str, tuple[Any, ...]]) -> Iterator[str]:
    if [*found] != [*table.columns]:
        yield f"tables/{table.name}.parquet has other columns"
        return
    for name, texts in table.columns.items():
        if len(found[name]) != len(texts):
            yield f"tables/{table.name}.parquet {name}: {len(found[name])} rows, {len(texts)} in the CSV"
        for row, (value, text) in enumerate(zip(found[name], texts, strict=False), start=2):
            if not _same(value, text):
                yield f"tables/{table.name}.parquet {name} row {row}: {value!r}, {text!r} in the CSV"


def _same(value: Any, text: str) -> bool:
    if isinstance(value, bool):
        return text == ("yes" if value else "no")
    if isinstance(value, int | float):
        return bool(text) and float(value) == number(text)
    return (value or "") == text


RULES = (Rule("V41d", "Parquet files = tables, types and values", 0, "cells", twins),)
