"""What headings and words of part lists mean, in the languages of the trade (en, de, fr, es, it): `vocabulary.csv`.

A word may mean several things ("No." is a mark or a number of pieces); the smaller the rank, the surer the meaning.
"""

import csv
import re
import unicodedata
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from isomould.units import UNIT_WORDS, LengthUnit

_FILE = Path(__file__).with_name("vocabulary.csv")

_BRACKETS = re.compile(r"[(\[{]([^)\]}]*)[)\]}]")
_TRAILING = re.compile(r"(?P<name>.+?)(?:\s+in\s+|\s*[,/:-]\s*|[\s_]+)(?P<unit>[a-z\"']+)\.?")


@dataclass(frozen=True)
class Heading:
    """A heading as the file has it, what it is called without its unit, and its unit if it has one."""

    text: str
    name: str
    unit: LengthUnit | None


def plain(text: str) -> str:
    """Give a word without case, accents and punctuation.

    >>> plain("  Stück-Nr.: "), plain("Länge"), plain("PART_NO")
    ('stuck nr', 'lange', 'part no')
    """
    letters = unicodedata.normalize("NFKD", text.casefold())
    bare = "".join(letter for letter in letters if not unicodedata.combining(letter))
    return " ".join(re.sub(r"[^\w#]|_", " ", bare).split())


def read_heading(text: str) -> Heading:
    """Take the unit off a heading: in brackets, or behind a blank, a comma, an underscore or "in".

    >>> read_heading("Länge [mm]"), read_heading("cut_length_mm").unit, read_heading("Width in cm").name
    (Heading(text='Länge [mm]', name='lange', unit='mm'), 'mm', 'width')
    """
    bare, unit = _BRACKETS.sub(" ", text), None
    for inside in _BRACKETS.findall(text):
        unit = unit or UNIT_WORDS.get(inside.strip().casefold().rstrip("."))
    trailing = _TRAILING.fullmatch(bare.strip().casefold())
    if unit is None and trailing is not None and trailing["unit"] in UNIT_WORDS:
        return Heading(text, plain(trailing["name"]), UNIT_WORDS[trailing["unit"]])
    return Heading(text, plain(bare), unit)


@cache
def meanings() -> Mapping[str, Mapping[str, int]]:
    """Give what every word may mean, and how sure that is: {"no": {"id": 3, "quantity": 2}, ...}."""
    found: dict[str, dict[str, int]] = {}
    with _FILE.open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            for word in row["words"].split("|"):
                found.setdefault(word, {}).setdefault(row["meaning"], int(row["rank"]))
    return found


def means(text: str) -> Mapping[str, int]:
    """Give what a heading may mean; nothing if it is not known."""
    return {meaning: rank for meaning, rank in meanings().get(text, {}).items() if not meaning.startswith("value ")}


@cache
def all_meanings() -> frozenset[str]:
    """Give everything that a column may mean."""
    return frozenset(meaning for word in meanings() for meaning in means(word))


def says(text: str, value: str) -> bool:
    """Tell whether a cell says `yes`, `no`, `length`, `width`, `height`, `none` or `total`.

    >>> says("Nein", "no"), says("längs", "length"), says("Summe:", "total")
    (True, True, True)
    """
    return f"value {value}" in meanings().get(plain(text), {})
