"""What is told of a run: stages known in advance, counts, the time left; in a terminal, a pipe and a notebook."""

import contextlib
import io
import os
import re
import subprocess
import sys

import pytest

import isomould
from isomould.delivery.stages import BUILDING, DESIGN, SCHEDULING
from isomould.progress import Course, Stage, Step, counted
from isomould.showing import Forecast, Progress
from isomould.workers import workers
from museum import SMALL


class Clock:
    """A clock that stands still until it is told to go."""

    now = 0.0

    def __call__(self):
        return self.now


def shown(steps, *, quiet=False, patience=0.0):
    """What steps, each at its second, look like on stderr."""
    clock, err = Clock(), io.StringIO()
    with contextlib.redirect_stderr(err), Progress(quiet, patience, by_itself=False, clock=clock) as progress:
        for second, step in steps:
            clock.now = second
            progress(step)
    return err.getvalue()


COUNTED = [(second, Step("node solids", 2, 9, second, 20, 0.1 + 0.04 * second)) for second in range(21)]


@pytest.fixture
def notebook(monkeypatch):
    """Let rich take this process for the kernel of a notebook."""
    monkeypatch.setattr("rich.console._is_jupyter", lambda: True)
    monkeypatch.setattr("rich.console.Console._environ", {**os.environ, "JUPYTER_COLUMNS": "100"})


def test_a_pipe_gets_a_line_for_a_stage_and_one_every_few_seconds():
    lines = shown([(0, Step("curves", 1, 9)), *COUNTED]).splitlines()
    assert lines[:2] == ["1 of 9: curves", "2 of 9: node solids, 0 of 20"]
    assert lines[2:] == [
        "2 of 9: node solids, 5 of 20, about 15 s left",
        "2 of 9: node solids, 10 of 20, about 10 s left",
        "2 of 9: node solids, 15 of 20, about 7 s left",
        "2 of 9: node solids, 20 of 20, about 3 s left",
    ]


def test_a_terminal_gets_a_line_that_changes(monkeypatch):
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("TERM", "xterm")
    text = shown([(0, Step("curves", 1, 9)), *COUNTED])
    assert "\x1b[" in text
    assert "1 of 9: curves" in text
    assert "2 of 9: node solids, 20 of 20, about 3 s left" in text


def test_a_terminal_shows_names_as_they_are(monkeypatch):
    """What looks like markup is a name."""
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("TERM", "xterm")
    assert "[red]: nesting" in shown([(0, Step("[red]: nesting"))])


def test_a_notebook_gets_plain_text_that_is_written_over(notebook):
    text = shown([(0, Step("curves, surface, parts", 1, 9)), *COUNTED])
    assert text.endswith("\n")
    assert "\x1b" not in text
    *_, last = text.removesuffix("\n").split("\r")
    assert last.rstrip() == "2 of 9: node solids, 20 of 20, about 3 s left"
    first, second = text.split("\r")[1:3]
    assert len(second) >= len(first.rstrip()), "what stood there is written over"


def test_quiet_and_patient_runs_show_nothing():
    assert shown(COUNTED, quiet=True) == ""
    assert shown(COUNTED, patience=30.0) == ""


@pytest.mark.parametrize(
    ("share", "told", "now", "left"),
    [
        (None, 20.0, 20.0, None),  # nobody knows how much work there is
        (0.25, 2.0, 2.0, None),  # it has just begun
        (0.01, 20.0, 20.0, None),  # hardly anything is done
        (0.25, 20.0, 20.0, 60.0),
        (0.25, 20.0, 50.0, 30.0),  # no step came, but time went by
        (0.25, 20.0, 90.0, None),  # all should be done, and is not
        (1.0, 20.0, 20.0, None),
    ],
)
def test_the_time_left_is_told_where_it_is_known(share, told, now, left):
    assert Forecast(Step("nesting", share=share), 0.0, told).left(now) == left


def test_the_share_follows_the_seconds_of_the_stages():
    steps = []
    course = Course((Stage("a", 1.0), Stage("b", 3.0)), steps.append)
    told = course.begin("b")
    told(2, 3)
    assert [(step.number, step.stages, step.share) for step in steps] == [(2, 2, 0.25), (2, 2, 0.75)]


@pytest.mark.parametrize("jobs", [1, 2])
def test_work_side_by_side_is_counted_as_it_is_done(jobs):
    counts = []
    with workers(jobs) as spread:
        assert spread(abs, [-1, -2, -3], lambda *count: counts.append(count)) == [1, 2, 3]
    assert counts == [(1, 3), (2, 3), (3, 3)]


def test_nothing_is_told_done_before_it_is():
    counts = []
    for _ in counted("ab", lambda *count: counts.append(count)):
        before = list(counts)
    assert (before, counts) == ([(1, 2)], [(1, 2), (2, 2)])


@pytest.mark.parametrize(("verb", "names"), [(isomould.build, BUILDING), (isomould.schedule, SCHEDULING)])
def test_stages_are_those_that_were_said_in_advance(project_file, tmp_path, verb, names):
    steps, texts = [], []
    run = isomould.Run(effort="quick", jobs=1, report=texts.append, progress=steps.append)
    verb(project_file(SMALL), tmp_path / "out", run=run)
    assert texts == [DESIGN, *names], "a callback for texts gets one a stage"
    assert [step.number for step in steps if not step.total] == list(range(1, len(names) + 2))
    assert {step.stages for step in steps} == {len(names) + 1}
    shares = [step.share for step in steps if step.share is not None]
    assert shares == sorted(shares)
    assert 0 < shares[0] < shares[-1] <= 1
    last = [step for step in steps if step.stage == "certificate"][-1]
    assert last.done == last.total > 10


def test_a_nest_tells_how_much_of_the_search_is_done(tmp_path):
    pty = pytest.importorskip("pty", reason="a terminal as on Linux")
    (tmp_path / "parts.csv").write_text("id,width,height,quantity\na,900,400,7\nb,500,300,9\n")
    command = [sys.executable, "-m", "isomould", "nest", "parts.csv", "--out", "a.json", "--sheet", "2000x1000"]
    main, other = pty.openpty()
    run = subprocess.run(command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=other, timeout=240, check=True)
    os.close(other)
    seen = os.read(main, 100_000).decode()
    os.close(main)
    assert b"sheets" in run.stdout
    assert "sheets, at least" in seen
    assert re.search(r"above that, \d+ of \d+", seen)
