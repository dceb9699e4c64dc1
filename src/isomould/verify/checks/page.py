"""V49: the page says of its folder what certificate, workbook and manifest say."""

from collections import Counter
from collections.abc import Iterator
from itertools import count, takewhile, zip_longest
from typing import Any
from urllib.parse import unquote

from isomould.verify.checks.manifest import LATER
from isomould.verify.delivery import Delivery
from isomould.verify.read.page import Row
from isomould.verify.rules import Measured, Rule, faults
from isomould.verify.shown_digits import shows

OWN = "V49"
_CHECK = ("id", "what", "count", "worst", "where", "limit", "unit", "status", "reason")
_MEASURED = ("worst", "limit")


def page(delivery: Delivery) -> Measured:
    """Compare its rows with the files that they come from; nothing may be loaded from elsewhere."""
    shown, files = delivery.page.tables, _files(delivery)
    pairs = (
        ("check", shown.get("certificate", []), _checks(delivery)),
        ("file", shown.get("files", []), files),
    )
    figures = _figures(delivery)
    problems = [problem for word, found, wanted in pairs for problem in _differences(word, found, wanted)]
    problems += _figure_faults(shown.get("summary", []), figures)
    problems += [f"loads {source}" for source in delivery.page.loaded]
    names = {row[0] for row in files}
    problems += [f"links to {link}" for link in delivery.page.linked if link[0] != "#" and unquote(link) not in names]
    return faults(len(figures) + sum(len(wanted) for _, _, wanted in pairs), problems)


def _differences(word: str, found: list[Row], wanted: list[tuple[Any, ...]]) -> list[str]:
    shown, expected = Counter(map(_values, found)), Counter(map(_values, wanted))
    return [f"{word} {' '.join(map(str, row))}" for row in (shown - expected) + (expected - shown)]


def _values(row: tuple[Any, ...]) -> tuple[str | float, ...]:
    return tuple(_value(cell) for cell in row)


def _value(cell: object) -> str | float:
    try:
        return float(cell)  # pyright: ignore[reportArgumentType] - what is no number is a text
    except (TypeError, ValueError):
        return "" if cell is None else str(cell)


def _checks(delivery: Delivery) -> list[tuple[Any, ...]]:
    """Give the rows of the certificate; the page shows six digits of what was measured."""
    rows = [{**row, **{name: _short(row[name]) for name in _MEASURED}} for row in delivery.certificate["checks"]]
    return [tuple(row[name] for name in _CHECK) for row in rows if row["id"] != OWN]


def _short(value: float | None) -> float | None:
    return None if value is None else float(f"{value:.6g}")


def _figures(delivery: Delivery) -> list[tuple[Any, ...]]:
    """Give the lines of the Summary sheet down to its first blank one."""
    cells = delivery.workbook.sheets["Summary"]
    rows = takewhile(lambda row: (row, 1) in cells, count(2))
    return [tuple(cells[row, column].value if (row, column) in cells else None for column in (1, 2, 3)) for row in rows]


def _files(delivery: Delivery) -> list[tuple[Any, ...]]:
    rows = delivery.manifest["files"]
    return [(row["path"], row["size"], row["sha256"]) for row in rows if row["path"] not in LATER]


def _figure_faults(found: list[Row], wanted: list[tuple[Any, ...]]) -> Iterator[str]:
    """Compare key figures in their order: texts letter by letter, values to the digits of their units."""
    for row, figure in zip_longest(found, wanted, fillvalue=()):
        if not _is_figure(row, figure):
            yield f"key figure {' '.join(map(str, row))}: the workbook has {' '.join(map(str, figure))}"


def _is_figure(row: Row, figure: tuple[Any, ...]) -> bool:
    if len(row) != len(figure) or not isinstance(figure[1], int | float):
        return False
    item, value, unit = figure
    unit = unit or ""
    return (row[0], row[2]) == (item, unit) and shows(row[1], float(value), unit)


RULES = (Rule(OWN, "the page shows what certificate, workbook and manifest say", 0, "rows", page),)
