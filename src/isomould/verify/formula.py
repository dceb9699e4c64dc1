"""A small evaluator of spreadsheet formulas: what schedules use, anything else is refused."""

import math
import operator
import re
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from isomould.verify.read.workbook import Value, Workbook
from isomould.verify.rules import Unreadable

_TOKEN = re.compile(
    r"""\s*(?:(?P<number>\d+\.?\d*(?:[eE][+-]?\d+)?)|(?P<text>"(?:[^"]|"")*")
    |(?P<table>\w*\[(?:[^\[\]]|\[[^\[\]]*\])*\])
    |(?P<cell>(?:(?:'[^']+'|\w+)!)?\$?[A-Z]{1,3}\$?\d+(?::\$?[A-Z]{1,3}\$?\d+)?)(?![\w(])
    |(?P<name>[A-Za-z_][\w.]*)|(?P<sign><>|<=|>=|[-+*/^&=<>(),]))""",
    re.VERBOSE,
)
_LEVELS: tuple[dict[str, Callable[[Any, Any], Any]], ...] = (
    {
        "=": operator.eq,
        "<>": operator.ne,
        "<=": operator.le,
        ">=": operator.ge,
        "<": operator.lt,
        ">": operator.gt,
    },
    {"&": lambda a, b: f"{a}{b}"},
    {"+": operator.add, "-": operator.sub},
    {"*": operator.mul, "/": operator.truediv},
    {"^": operator.pow},
)


def _flat(values: tuple[Any, ...]) -> list[Value]:
    return [item for value in values for item in (value if isinstance(value, list) else [value])]


def _numbers(*values: Any) -> list[float]:
    return [float(v) for v in _flat(values) if isinstance(v, int | float) and not isinstance(v, bool)]


def _product_sum(*columns: list[Any]) -> float:
    """Add up the products of rows; what is no number counts as 0."""
    return math.fsum(math.prod(sum(_numbers(value)) for value in row) for row in zip(*columns, strict=True))


def _subtotal(code: float, *values: Any) -> Any:
    return _FUNCTIONS[{9: "SUM", 3: "COUNTA"}[int(code) % 100]](*values)


def _sum_if(words: list[Value], wanted: Value, values: list[Value]) -> float:
    return math.fsum(_numbers(*(v for w, v in zip(words, values, strict=True) if w == wanted)))


def _exact(found: Any, wanted: str) -> Any:
    """Compare texts to the letter; a column gives a column."""
    return [value == wanted for value in found] if isinstance(found, list) else found == wanted


def _count_if(column: list[Value], wanted: Value) -> int:
    return sum(value == wanted for value in column)


def _round(value: float, digits: float) -> float:
    """Round half away from zero, as spreadsheets do."""
    return math.copysign(math.floor(abs(value) * 10**digits + 0.5) / 10**digits, value)


def _if(test: Any, yes: Any, no: Any = False) -> Any:
    return yes if test else no


_FUNCTIONS: dict[str, Callable[..., Any]] = {
    "SUM": lambda *v: math.fsum(_numbers(*v)),
    "SUBTOTAL": _subtotal,
    "SUMPRODUCT": _product_sum,
    "COUNT": lambda *v: len(_numbers(*v)),
    "COUNTA": lambda *v: sum(x not in (None, "") for x in _flat(v)),
    "COUNTIF": _count_if,
    "COUNTBLANK": lambda *v: sum(x in (None, "") for x in _flat(v)),
    "SUMIF": _sum_if,
    "EXACT": _exact,
    "ROWS": len,
    "MIN": lambda *v: min(_numbers(*v), default=0.0),
    "MAX": lambda *v: max(_numbers(*v), default=0.0),
    "ABS": abs,
    "ROUND": _round,
    "IF": _if,
    "AND": lambda *v: all(_flat(v)),
    "OR": lambda *v: any(_flat(v)),
}


@dataclass
class _Reader:
    """Tokens of one formula, read from left to right, and where the formula stands."""

    workbook: Workbook
    sheet: str
    row: int
    tokens: list[tuple[str, str]] = field(default_factory=list[tuple[str, str]])

    def peek(self) -> str:
        return self.tokens[0][1] if self.tokens else ""

    def take(self) -> tuple[str, str]:
        if not self.tokens:
            raise Unreadable("formula ends early")
        return self.tokens.pop(0)

    def expect(self, sign: str) -> None:
        if self.take()[1] != sign:
            raise Unreadable(f"formula lacks {sign}")


def evaluate(workbook: Workbook, sheet: str, row: int, formula: str) -> Any:
    """Compute a formula of a cell from the shown values of the cells that it names."""
    reader = _Reader(workbook, sheet, row, _tokens(formula.removeprefix("=")))
    found = _binary(reader, 0)
    if reader.tokens:
        raise Unreadable(f"cannot compute {formula}")
    return _scalar(found)


def _tokens(text: str) -> list[tuple[str, str]]:
    found, at = list[tuple[str, str]](), 0
    while at < len(text.rstrip()):
        match = _TOKEN.match(text, at)
        if match is None:
            raise Unreadable(f"cannot read formula {text}")
        found.append((str(match.lastgroup), match[str(match.lastgroup)]))
        at = match.end()
    return found


def _binary(reader: _Reader, level: int) -> Any:
    if level == len(_LEVELS):
        return _unary(reader)
    found = _binary(reader, level + 1)
    while reader.peek() in _LEVELS[level] and reader.tokens[0][0] == "sign":
        apply = _LEVELS[level][reader.take()[1]]
        found = apply(_scalar(found), _scalar(_binary(reader, level + 1)))
    return found


def _scalar(value: Any) -> Any:
    """Give a blank as 0, as spreadsheets do."""
    return 0 if value is None else value


def _unary(reader: _Reader) -> Any:
    if reader.peek() in {"-", "+"}:
        sign = -1 if reader.take()[1] == "-" else 1
        return _signed(sign, _unary(reader))
    return _primary(reader)


def _signed(sign: int, value: Any) -> Any:
    """Turn truths into numbers as `--` does, cell by cell in a column."""
    return [sign * v for v in value] if isinstance(value, list) else sign * _scalar(value)


def _primary(reader: _Reader) -> Any:
    kind, text = reader.take()
    if kind == "number":
        return float(text)
    if kind == "text":
        return text[1:-1].replace('""', '"')
    if kind == "table":
        return _column(reader, text)
    if kind == "cell":
        return _cells(reader.workbook, reader.sheet, text)
    if text == "(":
        found = _binary(reader, 0)
        reader.expect(")")
        return found
    return _named(reader, text)


def _named(reader: _Reader, name: str) -> Any:
    if reader.peek() == "(":
        return _call(reader, name)
    if name in {"TRUE", "FALSE"}:
        return name == "TRUE"
    if name not in reader.workbook.names:
        raise Unreadable(f"formula names {name}, which nobody defined")
    return _cells(reader.workbook, reader.sheet, reader.workbook.names[name])


def _call(reader: _Reader, name: str) -> Any:
    if name not in _FUNCTIONS:
        raise Unreadable(f"formula calls {name}, which the verifier does not know")
    reader.expect("(")
    arguments = list[Any]()
    while reader.peek() != ")":
        arguments.append(_binary(reader, 0))
        if reader.peek() == ",":
            reader.take()
    reader.expect(")")
    return _FUNCTIONS[name](*arguments)


def _column(reader: _Reader, text: str) -> Any:
    """Give a table's column, or its cell in this row for `[@…]` and `[#This Row]`."""
    name, inside = text[:-1].split("[", 1)
    this_row = "@" in inside or "#This Row" in inside
    header = re.sub(r"\[?#This Row\]?,", "", inside).strip("@[]")
    table = reader.workbook.tables[name] if name else _own_table(reader)
    column, cells = table.column + table.headers.index(header), reader.workbook.sheets[table.sheet]
    values = [cells[r, column].value if (r, column) in cells else None for r in range(table.first, table.last + 1)]
    return values[reader.row - table.first] if this_row else values


def _own_table(reader: _Reader) -> Any:
    return next(table for table in reader.workbook.tables.values() if table.sheet == reader.sheet)


def _cells(workbook: Workbook, sheet: str, text: str) -> Any:
    """Give the value of a cell, or the values of a range row by row."""
    where, corners = text.rsplit("!", 1) if "!" in text else (sheet, text)
    cells = workbook.sheets[where.strip("'")]
    ends = [_place(corner) for corner in corners.replace("$", "").split(":")]
    (r0, c0), (r1, c1) = ends[0], ends[-1]
    values = [cells[r, c].value if (r, c) in cells else None for r in range(r0, r1 + 1) for c in range(c0, c1 + 1)]
    return values if len(ends) > 1 else values[0]


def _place(corner: str) -> tuple[int, int]:
    letters = corner.rstrip("0123456789")
    column = 0
    for letter in letters:
        column = 26 * column + ord(letter) - 64
    return int(corner[len(letters) :]), column
