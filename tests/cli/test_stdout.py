"""Stdout carries results alone, in every verb, whatever libraries print there by themselves."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from isomould.cli.program import _COMMANDS
from isomould.nesting.solver import quiet_solver
from museum import BARE, SMALL, changed, write_project

MEMBERS = [{"id": f"M{k}", "section": "FL80*8", "length": 700 + 137 * k, "quantity": 3 + k % 4} for k in range(12)]

LOUD = """
import json, os, sys
import highspy
from isomould.cli import main

class Loud(highspy.Highs):
    def __init__(self):
        os.write(1, b"Running HiGHS\\n")
        os.write(2, b"asked HiGHS\\n")
        super().__init__()

highspy.Highs = Loud
for verb in json.loads(sys.argv[1]):
    try:
        main(verb)
    except SystemExit as end:
        code = end.code
    os.write(1, b"a library speaks\\n")
    sys.stdout.write(f"\\x1e{code}\\x1e")
    sys.stdout.flush()
"""
"""Runs verbs where every solver greets on descriptor 1, as newer ones do, and another library speaks afterwards."""


def run(verbs, folder):
    """Run verbs in one process; give exit code and stdout of each, and stderr of all."""
    command = [sys.executable, "-c", LOUD, json.dumps([[*map(str, verb)] for verb in verbs])]
    made = subprocess.run(command, cwd=folder, capture_output=True, timeout=300, check=False)
    parts = made.stdout.decode("utf-8").split("\x1e")
    return list(zip(map(int, parts[1::2]), parts[0::2], strict=False)), made.stderr.decode("utf-8")


@pytest.fixture
def inputs(tmp_path):
    write_project(tmp_path / "small.toml", changed(SMALL, deliver=BARE))
    (tmp_path / "members.json").write_text(json.dumps({"name": "bars", "members": MEMBERS}), encoding="utf-8")
    (tmp_path / "parts.csv").write_text("mark,width,height,quantity\nA,900,700,9\nB,640,410,7\nC,1210,300,5\n", "utf-8")
    return tmp_path


VERBS = {
    "new": (["new", "--list"], r"(barrel-vault|[\w-]+\n)[\s\S]*"),
    "check": (["check", "small.toml"], r"[\s\S]*Parallels[\s\S]*"),
    "build": (
        ["build", "small.toml", "--out", "out", "--effort", "quick", "--jobs", "1", "--quiet"],
        r"built out \(.*\)\n",
    ),
    "verify": (["verify", "out"], r"out: \d+ checks passed, 0 failed\n[\s\S]*"),
    "schedule": (["schedule", "small.toml", "--out", "tables", "--quiet", "--jobs", "1"], r"[^\n]*tables[^\n]*\n"),
    "compare": (["compare", "small.toml"], r"[\s\S]*isogonal[\s\S]*"),
    "nest": (["nest", "members.json", "--out", "bars.json", "--bar", "FL80*8=6 m", "--quiet"], r"\d+ bars, [^\n]*\n"),
    "inspect": (["inspect", "parts.csv"], r"parts.csv: 3 kinds, 21 pieces\n(  [^\n]*\n){3}"),
    "draw": (["draw", "small.toml", "--out", "plan.svg", "--view", "plan"], r"wrote plan.svg\n"),
}


@pytest.mark.slow
def test_every_verb_prints_its_results_alone(inputs):
    assert set(VERBS) == set(_COMMANDS)
    sheets = (["nest", "parts.csv", "--out", "sheets.json", "--sheet", "3000x1500", "--quiet"], r"\d+ sheets, [^\n]*\n")
    asked = [*VERBS.values(), sheets]
    found, err = run([arguments for arguments, _ in asked], inputs)
    for (arguments, pattern), (code, out) in zip(asked, found, strict=True):
        assert code == 0, (arguments, err)
        assert re.fullmatch(pattern, out), (arguments, out)
        assert "HiGHS" not in out
        assert "a library speaks" not in out
    assert "asked HiGHS" in err
    assert "Running HiGHS" not in err
    assert err.count("a library speaks\n") == len(asked)


def test_a_solver_is_made_without_a_word(capfd):
    os.write(1, b"before\n")
    solver = quiet_solver()
    solver.run()
    os.write(1, b"after\n")
    assert capfd.readouterr().out == "before\nafter\n"


def test_a_solver_is_made_where_there_is_no_stdout():
    script = (
        "import os; from isomould.nesting.solver import quiet_solver as q; os.close(1); q().run(); os.write(2, b'made')"
    )
    ran = subprocess.run([sys.executable, "-c", script], capture_output=True, check=False, cwd=Path(__file__).parent)
    assert ran.stderr == b"made"
