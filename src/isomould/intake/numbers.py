"""Cells of part lists as numbers: which signs divide decimals and thousands is found out for the whole list.

A cell alone cannot tell: 1.900 is 1.9 in one country and 1900 in another. The list can, as soon as one of its
numbers can be written in one way only.
"""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import NoReturn

from isomould.intake.part_rows import LONGEST, refuse, show
from isomould.units import LengthUnit, in_mm, read_length

_TOKEN = re.compile(r"\d[\d.,]*|[.,]\d+")
_GROUPED = re.compile(r"(?<![\d.,])\d{1,3}(?:['’ \u00a0\u2009\u202f]\d{3})+(?!\d)(?!\s*/)")
_MARKS = re.compile("['’ \u00a0\u2009\u202f]")
_PIECES = re.compile(r"(?:x\s*)?([\d.]+)\s*(?:x|pcs?|stk|st|stück|pieces?|pz|uds?|no|off|ea)?\.?", re.IGNORECASE)

_MOST_DIGITS = 9
_THOUSAND = 1000


@dataclass(frozen=True)
class Signs:
    """The sign before the decimals of a list, and the one between thousands."""

    decimal: str

    @property
    def thousands(self) -> str:
        """The other one."""
        return "," if self.decimal == "." else "."

    def plain(self, text: str) -> str:
        """Write the numbers of a cell with a decimal point and nothing between thousands; no others."""
        return _TOKEN.sub(lambda token: self._plain_token(token[0]), _ungrouped(text))

    def _plain_token(self, token: str) -> str:
        whole, sign, decimals = token.partition(self.decimal)
        groups = whole.split(self.thousands)
        if len(groups) > 1 and not _are_groups(groups):
            # No number in this list's way of writing; the mark keeps it from being read in another.
            return f"?{token}"
        return "".join(groups) + ("." if sign else "") + decimals


def find_signs(cells: Iterable[str], others: Iterable[str], separator: str, unit: LengthUnit, file: str) -> Signs:
    """Find out how a list writes its numbers.

    Parameters
    ----------
    cells
        The numbers that are read.
    others
        Numbers of other columns, which are asked where those say nothing.
    separator
        Between cells: where it is a comma, a point before three digits is a decimal point.
    unit
        The smallest unit of the columns: in metres nothing is 1900 long.

    Raises
    ------
    Refused
        E-NEST-11: two decimal signs, or numbers that all may mean either.
    """
    tokens = _tokens(cells)
    sure = {sign for token in tokens for sign in _decimal_signs(token)}
    if len(sure) > 1:
        one, other = (next(t for t in tokens if sign in _decimal_signs(t)) for sign in sorted(sure))
        refuse(file, f"{one!r} and {other!r}", "one decimal sign in all numbers", "Write decimal points.")
    if sure:
        return Signs(sure.pop())
    open_ones = [token for token in tokens if "." in token or "," in token]
    asked = {sign for token in _tokens(others) for sign in _decimal_signs(token)} if open_ones else set[str]()
    if len(asked) == 1:
        return Signs(asked.pop())
    return Signs(_likely_sign(open_ones, separator, unit, file))


def _likely_sign(tokens: Sequence[str], separator: str, unit: LengthUnit, file: str) -> str:
    """Decide about numbers that all have three digits behind one sign."""
    signs = {sign for token in tokens for sign in ".," if sign in token}
    if not signs or (separator == "," and signs == {"."}):
        return "."
    small = all(token.startswith("0") for token in tokens)
    too_long = in_mm(Fraction(_THOUSAND), unit) >= LONGEST
    if len(signs) > 1 or not (small or too_long):
        _refuse_open(tokens, file)
    return signs.pop()


def _refuse_open(tokens: Sequence[str], file: str) -> NoReturn:
    sample = next((token for token in tokens if not token.startswith("0")), tokens[0])
    digits = re.sub(r"\D", "", sample)
    found = f"{sample!r} may be {int(digits)} or {int(digits) / _THOUSAND:g}: every number has three digits behind it"
    way_out = f"Write {int(digits)}, or {int(digits) / _THOUSAND:.1f} with one decimal, in one row at least."
    refuse(file, found, "numbers that can be read in one way only", way_out)


def _tokens(cells: Iterable[str]) -> list[str]:
    return [token for cell in cells for token in _TOKEN.findall(_ungrouped(cell))]


def _ungrouped(text: str) -> str:
    """Take blanks and apostrophes from between thousands: 1 840 and 1'840, but not the foot of 12'-3 or of 1'240"."""
    if '"' in text or "″" in text or "”" in text:
        return text
    return _GROUPED.sub(lambda found: _MARKS.sub("", found[0]), text)


def _decimal_signs(token: str) -> set[str]:
    """Give the sign that can only stand before the decimals of a number; nothing if it may divide thousands."""
    used = [sign for sign in ".," if sign in token]
    if len(used) == 2:
        return {max(used, key=token.rindex)}
    if not used:
        return set()
    sign, groups = used[0], token.split(used[0])
    if len(groups) > 2:
        return {"." if sign == "," else ","}
    return set() if _are_groups(groups) else {sign}


def _are_groups(groups: Sequence[str]) -> bool:
    """Tell whether digits are divided as thousands are: one to three, then three each."""
    first, *others = groups
    return 1 <= len(first) <= 3 and all(len(group) == 3 for group in others)


def to_length(text: str, signs: Signs, unit: LengthUnit, field: str) -> float:
    """Give a cell as a length, mm; one that has a unit of its own is read in that."""
    number, own = _written(text, signs, field)
    return float(in_mm(number, own or unit))


def unit_in(text: str, signs: Signs) -> LengthUnit | None:
    """Give the unit that a cell has itself."""
    found = read_length(signs.plain(text).lstrip("~ "))
    return found[1] if found else None


def _written(text: str, signs: Signs, field: str) -> tuple[Fraction, LengthUnit | None]:
    found = read_length(signs.plain(text).lstrip("~ "))
    if found is None:
        sign = "comma" if signs.decimal == "," else "point"
        limit = f"a number with a decimal {sign}, alone or with a unit: 650 mm, 27 7/8 in, 12 ft 3 in"
        refuse(field, show(text) if text else "blank", limit)
    return found


def to_angle(text: str, signs: Signs, field: str) -> float:
    """Give a cell as an angle in degrees."""
    number, unit = _written(text.rstrip("° "), signs, field)
    if unit is not None:
        refuse(field, show(text), "an angle in degrees")
    return float(number)


def to_count(text: str, field: str, signs: Signs | None = None) -> int:
    """Give a cell as a number of pieces, 0 too: 4, 4.0, 4 pcs, x4."""
    found = _PIECES.fullmatch((signs or Signs(".")).plain(text).strip())
    whole = found is not None and re.fullmatch(r"\d+(?:\.0*)?", found[1]) is not None
    if found is None or not whole or len(found[1].split(".")[0]) > _MOST_DIGITS:
        refuse(field, show(text) if text else "blank", "a whole number of pieces")
    return int(found[1].split(".")[0])
