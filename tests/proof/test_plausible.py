"""Accepted means built: random plausible projects that `check` accepts are built with a passing certificate.

What it refuses must be few: at least 70 % are accepted. `pytest -m long tests/proof/test_plausible.py --plausible 2000`
runs as many as are asked for and prints the share per kind, which `docs/proof.md` publishes.
"""

from collections import Counter
from pathlib import Path

import pytest

import isomould
from isomould.errors import Refused
from museum import write_project
from plausible import KINDS, plausible

IN_SUITE, IN_CI = 12, 40
LEAST_SHARE = 0.7


def built(number: int, folder: Path) -> bool:
    """Whether a project is accepted; what is accepted must build, its certificate proved."""
    _, tables = plausible(number)
    project = write_project(folder / f"{number}.toml", tables)
    try:
        isomould.check(project)
    except Refused:
        return False
    made = isomould.build(project, folder / str(number), run=isomould.Run(effort="quick", jobs=1))
    assert made.certificate.passed
    return True


@pytest.mark.parametrize("number", range(IN_SUITE))
def test_accepted_means_built(number, tmp_path):
    built(number, tmp_path)


@pytest.mark.slow
def test_forty_are_built_and_most_are_accepted(tmp_path):
    accepted = [built(number, tmp_path) for number in range(IN_SUITE, IN_SUITE + IN_CI)]
    assert sum(accepted) >= LEAST_SHARE * IN_CI


@pytest.mark.long
def test_as_many_as_are_asked_for(tmp_path, request, capsys):
    count = request.config.getoption("--plausible")
    accepted, asked = Counter[str](), Counter[str]()
    for number in range(count):
        kind, _ = plausible(number)
        asked[kind] += 1
        accepted[kind] += built(number, tmp_path)
    with capsys.disabled():
        for kind in KINDS:
            print(f"{kind}: {accepted[kind]} of {asked[kind]}")
    assert accepted.total() >= LEAST_SHARE * count
