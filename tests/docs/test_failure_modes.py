"""Every row of the failure modes says what answers it; every code named there exists, and is asserted by a test."""

import re
from pathlib import Path

import pytest

from isomould.verify.folder import RULES

ROOT = Path(__file__).parents[2]
ROWS = re.findall(r"^\| ([A-H]\d+) \|.*\| ([^|]+) \|$", (ROOT / "docs" / "failure-modes.md").read_text("utf-8"), re.M)


def sources(folder):
    return "\n".join(path.read_text("utf-8") for path in sorted((ROOT / folder).rglob("*.py")))


SOURCE, TESTS = sources("src"), sources("tests")
CHECKS = {rule.id for rule in RULES} | set(re.findall(r'Rule\(\s*"(V\d+[a-z]?)"', SOURCE))
"""Of deliveries, and of nests that stand alone."""


def is_raised(code):
    """Whether the code stands in the source, whole or made of its prefix and its last word."""
    prefix, _, last = code.rpartition("-")
    return (
        f'"{code}"' in SOURCE
        or re.search(rf"{code}[ :]", SOURCE) is not None
        or (f'"{prefix}-{{what}}"' in SOURCE and f'"{last}"' in SOURCE)
    )


def test_every_row_has_an_answer():
    assert len(ROWS) > 60
    assert len(dict(ROWS)) == len(ROWS)


@pytest.mark.parametrize(("row", "answer"), ROWS)
def test_what_answers_a_row_exists(row, answer):
    codes = re.findall(r"[EW]-[A-Z0-9-]*[A-Z0-9]", answer)
    checks = re.findall(r"\bV\d+[a-z]?\b", answer)
    fields = re.findall(r"`(\w+)`", answer)
    assert codes or checks or fields or answer == "open", row
    assert [field for field in fields if f'"{field}"' not in SOURCE] == []
    assert [code for code in codes if not is_raised(code)] == []
    assert set(checks) <= CHECKS


@pytest.mark.parametrize(("row", "answer"), [(row, answer) for row, answer in ROWS if row[0] in "BCD"])
def test_answers_of_curves_surfaces_and_nodes_are_tested(row, answer):
    named = re.findall(r"[EW]-[A-Z0-9-]*[A-Z0-9]|\bV\d+[a-e]?\b", answer)
    assert named, row
    assert [code for code in named if code not in TESTS] == []
