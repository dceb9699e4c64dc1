"""Accepted means built: random plausible projects that `check` accepts are built with a passing certificate.

What `check` refuses must be little: at least 70 % are accepted. A release builds as many as are asked for,
`pytest -m long tests/proof/test_plausible.py --plausible 2000`, and prints the share per kind (`docs/proof.md`).
"""

from collections import Counter
from pathlib import Path
from typing import Any

import pytest

import isomould
from isomould.errors import Refused
from museum import changed, write_project
from plausible import KINDS, plausible

IN_SUITE = (0, 1, 2, 3, 4, 5, 6, 15, 16, 21, 22, 23)
"""Every kind on slotted drums, then finned and capped nodes: faceted ones take longest."""

LEAST_SHARE = 0.7


def accepted(tables: dict[str, Any], folder: Path) -> bool:
    """Whether `check` accepts a project; what it accepts must build, its certificate proved."""
    project = write_project(folder / "plausible.toml", tables)
    try:
        isomould.check(project)
    except Refused:
        return False
    run = isomould.Run(effort="quick", jobs=1, overwrite=True)
    assert isomould.build(project, folder / "built", run=run).certificate.passed
    return True


@pytest.mark.slow
@pytest.mark.parametrize("number", IN_SUITE)
def test_accepted_means_built(number, tmp_path):
    _, tables = plausible(number)
    accepted(changed(tables, deliver={"drawings": False, "dxf": ["R2010"], "solids": []}), tmp_path)


@pytest.mark.long
def test_most_are_accepted_and_those_are_built(tmp_path, request, capsys):
    count = request.config.getoption("--plausible")
    taken, asked = Counter[str](), Counter[str]()
    for number in range(count):
        kind, tables = plausible(number)
        asked[kind] += 1
        taken[kind] += accepted(tables, tmp_path)
    with capsys.disabled():
        print(*(f"\n{kind}: {taken[kind]} of {asked[kind]}" for kind in KINDS))
    assert taken.total() >= LEAST_SHARE * count
