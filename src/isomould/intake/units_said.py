"""Units that a table says beside its numbers: in a column of their own, or in a title before the heading."""

import re
from collections.abc import Sequence

from isomould.intake.table_rows import Row
from isomould.intake.table_words import Line
from isomould.units import UNIT_WORDS, LengthUnit

_SAID = re.compile(
    r"\b(?:units?|dimensions?|sizes?|lengths?|measures?|measurements?|ma(?:ß|ss)e|einheit(?:en)?|l(?:ä|ae)ngen"
    r"|unités?|cotes|mesures|unidad(?:es)?|cotas|medidas|dimensiones|unità|misure|dimensioni)"
    r"(?:\s+(?:are|is|sind|sont|son|sono))?"
    r"(?:\s*[:=]\s*|\s+(?:in|en)\s+|\s+(?!in\b)(?=[(\[]?[a-z]{2}))[(\[]?(?P<unit>[a-z]+)\b",
    re.IGNORECASE,
)
"""Words for sizes, and behind them a unit: "Units: inches", "all dimensions in cm", "Maße in mm"."""


def unit_of_titles(rows: Sequence[Row]) -> LengthUnit | None:
    """Give the unit that the titles before a heading name; None where they name none, or several.

    Examples
    --------
    >>> unit_of_titles([(1, ["Cut list", "all dimensions in cm"])]), unit_of_titles([(1, ["Project in m"])])
    ('cm', None)
    """
    text = " ; ".join(" ".join(filter(None, cells)) for _, cells in rows)
    words = [found["unit"].casefold() for found in _SAID.finditer(text)]
    units: set[LengthUnit] = {UNIT_WORDS[word] for word in words if word in UNIT_WORDS}
    return units.pop() if len(units) == 1 else None


def with_units(lines: Sequence[Line], lengths: Sequence[str]) -> list[Line]:
    """Write the unit of a column of units behind the lengths of its row that have none.

    A column that holds anything else, such as pcs, says how pieces are counted.

    Parameters
    ----------
    lengths
        The columns whose headings name no unit.
    """
    said = [line.cells.get("unit", "").casefold().rstrip(".") for line in lines]
    if not all(unit in UNIT_WORDS for unit in said if unit):
        return list(lines)
    return [_with_unit(line, unit, lengths) if unit else line for line, unit in zip(lines, said, strict=True)]


def _with_unit(line: Line, unit: str, lengths: Sequence[str]) -> Line:
    bare = [name for name in lengths if line.cells.get(name, "")[-1:].isdigit()]
    return Line({**line.cells, **{name: f"{line.cells[name]} {unit}" for name in bare}}, line.field)
