"""The command line as users meet it: its exit code, its words, and what it leaves on the disk."""

import contextlib
import io
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from pypdf import PdfReader

import isomould
from isomould.cli import main
from isomould.cli.nest_command import Interrupting
from isomould.nesting.nest import nest_sheets
from isomould.nesting.stop import Stop
from museum import SMALL, changed

TRAPEZOIDS = {
    "name": "two",
    "sheet": [3000, 1500],
    "gap": 5,
    "trim": 10,
    "parts": [{"id": k, "row": 0, "a": 900, "b": 700, "h": 600, "ol": 100, "orr": 100} for k in range(5)],
}


def many(count):
    """A part list that a search works on for a while."""
    first = TRAPEZOIDS["parts"][0]
    parts = [{**first, "id": k, "a": 500 + 7 * k % 391, "b": 400, "h": 300 + k % 17} for k in range(count)]
    return {**TRAPEZOIDS, "parts": [{**part, "ol": 20, "orr": part["a"] - part["b"] - 20} for part in parts]}


def process(*arguments, folder):
    command = [sys.executable, "-m", "isomould", *map(str, arguments)]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=240, check=False)


def run(*arguments, folder):
    """The same without a process of its own, which takes seconds to start; handlers of signals are put back."""
    handlers = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    out, err = io.StringIO(), io.StringIO()
    with contextlib.chdir(folder), contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            main([*map(str, arguments)])
        except SystemExit as end:
            code = end.code
        finally:
            for number, handler in handlers.items():
                signal.signal(number, handler)
    return subprocess.CompletedProcess(arguments, code, out.getvalue(), err.getvalue())


def test_new_check_and_list(tmp_path):
    assert run("new", "roof", folder=tmp_path).returncode == 0
    checked = run("check", "roof.toml", "--set", 'rail.curve.rise="8 m"', folder=tmp_path)
    assert checked.returncode == 0
    assert "680" in checked.stdout
    assert "nearest angle" in checked.stdout
    assert "generatrix" in checked.stdout
    assert "barrel-vault" in run("new", "--list", folder=tmp_path).stdout
    assert [path.name for path in tmp_path.iterdir()] == ["roof.toml"]


def test_new_copies_the_drawing_too(tmp_path):
    assert run("new", "canopy", "--template", "canopy-from-dxf", folder=tmp_path).returncode == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["canopy-from-dxf.dxf", "canopy.toml"]
    assert run("check", "canopy.toml", folder=tmp_path).returncode == 0


def test_new_overwrites_nothing(tmp_path):
    (tmp_path / "roof.toml").write_text("mine")
    refused = run("new", "roof", folder=tmp_path)
    assert refused.returncode == 2
    assert "roof.toml" in refused.stderr
    assert (tmp_path / "roof.toml").read_text() == "mine"


@pytest.mark.parametrize("name", ["CON", "nul.toml", "a:b", "x" * 90])
def test_new_refuses_names_that_some_system_cannot_hold(tmp_path, monkeypatch, name):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(isomould.Refused, match="E-NAME-01 NAME"):
        isomould.new(name)
    assert not list(tmp_path.iterdir())


def test_build_and_verify(tmp_path, project_file):
    project_file(SMALL)
    built = process("build", "project.toml", "--effort", "quick", folder=tmp_path)
    assert built.returncode == 0, built.stderr
    assert (tmp_path / "outputs" / "small" / "certificate.json").exists()
    assert "checks passed" in built.stdout
    assert run("verify", "outputs/small", folder=tmp_path).returncode == 0
    again = run("build", "project.toml", "--effort", "quick", folder=tmp_path)
    assert again.returncode == 2
    assert "--replace" in again.stderr
    (tmp_path / "outputs" / "small" / "panels" / "P01.dxf").unlink()
    broken = process("verify", "outputs/small", folder=tmp_path)
    assert broken.returncode == 1
    assert "P01" in broken.stdout


@pytest.mark.parametrize(
    "change",
    [
        {"rail": {"divide": {"nodes": 1}}},
        {"nodes": {"drum_diameter": 30}},
        {"stock": {"sheets": []}, "panels": {"gap": 0}},
    ],
)
def test_refusals_leave_the_disk_as_it_was(tmp_path, project_file, change):
    project_file(changed(SMALL, **change))
    refused = run("build", "project.toml", folder=tmp_path)
    assert refused.returncode == 2
    assert "Traceback" not in refused.stderr
    assert "Limit:" in refused.stderr
    assert not any((tmp_path / "outputs").glob("*")) if (tmp_path / "outputs").exists() else True


def test_panels_too_large_for_the_sheets_are_named(tmp_path, project_file):
    stock = {**SMALL["stock"], "sheets": [{"name": "S", "width": 900, "height": 900}]}
    project_file({**SMALL, "stock": stock})
    refused = run("build", "project.toml", folder=tmp_path)
    assert refused.returncode == 2
    assert "P0" in refused.stderr


def test_unwritable_target_is_an_io_fault(tmp_path, project_file):
    project_file(SMALL)
    (tmp_path / "file").write_text("")
    assert run("build", "project.toml", "--out", "file/inside", folder=tmp_path).returncode == 3


def test_nest(tmp_path):
    (tmp_path / "parts.json").write_text(json.dumps(TRAPEZOIDS))
    nested = run("nest", "parts.json", "--out", "layout.json", folder=tmp_path)
    assert nested.returncode == 0, nested.stderr
    layout = json.loads((tmp_path / "layout.json").read_text())
    assert layout["status"] == "complete"
    assert sorted(placement["id"] for placement in layout["placements"]) == [0, 1, 2, 3, 4]


def test_nest_writes_sheets_and_plan_or_nothing(tmp_path):
    """From a CSV; without room for the sheets, or with a plan that is no PDF, nothing is nested."""
    (tmp_path / "parts.csv").write_text("mark,qty,a,b,h,ol,orr\nP1,6,900,820,700,40,40\n")
    (tmp_path / "stock.toml").write_text('[stock]\nsheets = [{name = "A", width = "3 m", height = "2 m"}]\n')
    command = ("nest", "parts.csv", "--stock", "stock.toml", "--out", "layout.json", "--effort", "quick")
    refused = run(*command, "--plan", "plan.doc", folder=tmp_path)
    assert (refused.returncode, "E-OUT-11" in refused.stderr) == (2, True)
    assert not (tmp_path / "layout.json").exists()
    nested = run(*command, "--sheets", "cut", "--plan", "plan.pdf", folder=tmp_path)
    assert nested.returncode == 0, nested.stderr
    sheets = {sheet["id"] for sheet in json.loads((tmp_path / "layout.json").read_text())["sheets"]}
    assert {path.stem for path in (tmp_path / "cut").iterdir()} == sheets
    text = "\n".join(page.extract_text() for page in PdfReader(tmp_path / "plan.pdf").pages)
    assert all(word in text for word in (*sheets, "P1", "Yield", "Offcut"))
    (tmp_path / "cut" / "notes.txt").write_text("mine")
    for more in ((), ("--replace",)):
        refused = run(*command, "--sheets", "cut", *more, folder=tmp_path)
        assert (refused.returncode, "notes.txt" in refused.stderr) == (2, True)
    assert (tmp_path / "cut" / "notes.txt").read_text() == "mine"


def left_behind(session):
    """Processes that a session still has, entries that nobody has read apart."""
    found = list[str]()
    for path in Path("/proc").glob("[0-9]*/stat"):
        with contextlib.suppress(OSError):  # it has just ended
            state, _, _, of, *_ = path.read_text().rpartition(")")[2].split()
            found += [path.parent.name] if of == str(session) and state != "Z" else []
    return found


def wait_for(left):
    """Give what is left after a while, nothing at best."""
    until = time.monotonic() + 20
    while (found := left()) and time.monotonic() < until:
        time.sleep(0.02)
    return found


@pytest.mark.skipif(sys.platform != "linux", reason="/proc tells who runs")
@pytest.mark.parametrize(("number", "jobs"), [(signal.SIGINT, 1), (signal.SIGTERM, 2)])
def test_an_interrupted_nest_keeps_the_best_layout(tmp_path, number, jobs):
    """Ctrl-C, or the end that a shell sends to all processes: exit 130, a whole layout that says so, its sheets."""
    (tmp_path / "parts.json").write_text(json.dumps(many(250)))
    command = f"nest parts.json --out layout.json --effort best --sheets cut --jobs {jobs}".split()
    process = [sys.executable, "-m", "isomould", *command]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    with subprocess.Popen(process, cwd=tmp_path, start_new_session=True, **pipes) as running:
        assert b"nesting" in running.stderr.readline()
        time.sleep(0.5)
        os.killpg(running.pid, number)
        _, errors = running.communicate(timeout=120)
    assert (running.returncode, b"Traceback" in errors) == (130, False), errors
    assert not wait_for(lambda: left_behind(running.pid))
    layout = json.loads((tmp_path / "layout.json").read_text())
    assert (layout["status"], layout["reproducible"]) == ("interrupted", False)
    assert len(layout["placements"]) == 250
    assert len(list((tmp_path / "cut").iterdir())) == len(layout["sheets"])


def test_the_second_interrupt_ends_a_nest_at_once(monkeypatch):
    """One that comes in the same second is the first again: shells and services send it to the group too."""
    stop, now = Stop(), [100.0]
    interrupting = Interrupting(stop)
    monkeypatch.setattr(time, "monotonic", lambda: now[0])
    interrupting(signal.SIGTERM, None)
    now[0] += 0.5
    interrupting(signal.SIGTERM, None)
    assert stop.interrupted
    now[0] += 0.6
    with pytest.raises(KeyboardInterrupt):
        interrupting(signal.SIGTERM, None)


def test_members_are_nested_on_bars(tmp_path):
    """By options alone, with saw lists; what lists of members and of parts cannot give is refused."""
    (tmp_path / "m.csv").write_text("section;mark;qty;length\nFL200*12;M1;7;1505,5\nRHS 50x3;M2;4;900\n")
    bars = ("--bar", "FL200*12=6 m", "--bar", "RHS 50x3=3000", "--bar-kerf", "2", "--bar-trim", "5mm")
    command = ("nest", "m.csv", "--out", "layout.json", *bars)
    nested = run(*command, "--saw-list", "saw.csv", "--plan", "saw.pdf", folder=tmp_path)
    assert (nested.returncode, "5 bars, lower bound" in nested.stdout) == (0, True), nested.stderr
    layout = json.loads((tmp_path / "layout.json").read_text())
    assert (layout["kind"], layout["status"], len(layout["bars"])) == ("bars", "complete", 5)
    assert (tmp_path / "saw.csv").read_text().count("\n") == 12
    proved = run("verify", "layout.json", "--saw-list", "saw.csv", "--plan", "saw.pdf", folder=tmp_path)
    assert (proved.returncode, "3 checks passed" in proved.stdout) == (0, True)
    for wrong, word in ((("--sheets", "cut"), "--sheets"), (("--saw-list", "saw.pdf"), "--saw-list"),
                        (("--bar", "RHS 50x3=3000"), "M1"),
                        (("--kerf", "3"), "--kerf"), (("--sheet", "3000x2000"), "--sheet"),
                        (("--bar", "6 m"), "--bar")):  # fmt: skip
        refused = run(*(command if "bar" not in wrong[0] else command[:4]), *wrong, folder=tmp_path)
        assert (refused.returncode, word in refused.stderr) == (2, True), refused.stderr


def test_quick_stock_by_options(tmp_path):
    """Options take the place of the stock file's keys; what they cannot be is said."""
    (tmp_path / "parts.csv").write_text("mark,qty,a,b,h,ol,orr\nP1,6,900,820,700,40,40\n")
    (tmp_path / "stock.toml").write_text('[stock]\ntrim = 20\nsheets = [{name = "A", width = 900, height = 900}]\n')
    command = ("nest", "parts.csv", "--out", "layout.json", "--effort", "quick", "--quiet", "--stock", "stock.toml")
    asked = ("--sheet", "3000x2000", "--sheet", "2.4 m x 1.2 m", "--gap", "1/4in", "--kerf", "2", "--turning", "half")
    nested = run(*command, *asked, folder=tmp_path)
    assert (nested.returncode, nested.stderr) == (0, "")
    layout = json.loads((tmp_path / "layout.json").read_text())
    assert {sheet["stock"] for sheet in layout["sheets"]} <= {"3000 x 2000", "2400 x 1200"}
    assert (layout["nesting"]["gap_mm"], layout["nesting"]["kerf_mm"], layout["nesting"]["trim_mm"]) == (6.35, 2, 20)
    wrongs = (("--sheet", "3000"), ("--sheet", "3x2x1"), ("--gap", "5 miles"), ("--gap", "nan"), ("--gap", "-1"),
              ("--bar-kerf", "3"), ("--bar", "A=6 m"))  # fmt: skip
    for wrong in wrongs:
        refused = run(*command, *wrong, folder=tmp_path)
        assert (refused.returncode, "Traceback" in refused.stderr) == (2, False)


def test_a_time_limit_of_bars_is_marked_too(tmp_path):
    """Many lengths on one section: a search that is stopped at once still gives bars that are proved."""
    lengths = np.random.default_rng(5).uniform(1200, 3600, 120)
    rows = "".join(f"FL200*12;M{k};1;{x:.2f}\n" for k, x in enumerate(lengths))
    (tmp_path / "m.csv").write_text(f"section;mark;qty;length\n{rows}")
    command = ("nest", "m.csv", "--out", "layout.json", "--bar", "FL200*12=6 m")
    assert run(*command, "--time-limit", "0", folder=tmp_path).returncode == 0
    layout = json.loads((tmp_path / "layout.json").read_text())
    assert (layout["status"], layout["reproducible"]) == ("complete", False)
    assert layout["bound"] <= len(layout["bars"])


def test_a_time_limit_is_marked(tmp_path):
    (tmp_path / "parts.json").write_text(json.dumps(many(150)))
    assert run("nest", "parts.json", "--out", "layout.json", "--time-limit", "0", folder=tmp_path).returncode == 0
    assert json.loads((tmp_path / "layout.json").read_text())["reproducible"] is False


@pytest.mark.parametrize(
    "wrong",
    [
        ("--out", "m.csv"),
        ("--out", "./stock.toml"),
        ("--out", "layout.json", "--saw-list", "m.csv"),
        ("--out", "both.csv", "--saw-list", "both.csv"),
    ],
)
def test_nest_never_writes_over_what_it_reads(tmp_path, wrong):
    """Nor two things into one file: the list of a user is all there is of it."""
    (tmp_path / "m.csv").write_text("section;mark;qty;length\nFL200*12;M1;7;1505,5\n")
    (tmp_path / "stock.toml").write_text('[stock]\nbars = [{section = "FL200*12", length = "6 m"}]\n')
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    refused = run("nest", "m.csv", "--stock", "stock.toml", *wrong, folder=tmp_path)
    assert (refused.returncode, "E-OUT-13" in refused.stderr, Path(wrong[-1]).name in refused.stderr) == (2, True, True)
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_a_search_that_had_ended_keeps_its_status(tmp_path, monkeypatch):
    """An interrupt while sheets are drawn and proved: the layout is what it would be without."""
    (tmp_path / "parts.json").write_text(json.dumps(many(12)))
    stop = Stop()
    search = "isomould.nesting.irregular.nest_sheets"
    monkeypatch.setattr(search, lambda *given: [nest_sheets(*given), stop.interrupt()][0])
    layout = isomould.nest(tmp_path / "parts.json", tmp_path / "layout.json", "quick", stop)
    assert (stop.interrupted, layout.status, layout.reproducible) == (True, "complete", True)


def test_nest_refuses_what_fits_no_sheet(tmp_path):
    parts = [{**TRAPEZOIDS["parts"][0], "id": "big", "a": 9000, "b": 8800}]
    (tmp_path / "parts.json").write_text(json.dumps({**TRAPEZOIDS, "parts": parts}))
    refused = run("nest", "parts.json", "--out", "layout.json", folder=tmp_path)
    assert refused.returncode == 2
    assert "big" in refused.stderr
    assert not (tmp_path / "layout.json").exists()


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupted_build_leaves_nothing(tmp_path, number):
    run("new", "vault", folder=tmp_path)
    command = [sys.executable, "-m", "isomould", "build", "vault.toml", "--jobs", "2"]
    with subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.PIPE, text=True) as running:
        for line in running.stderr:
            if ": nesting" in line:
                break
        running.send_signal(number)
        errors = running.communicate(timeout=60)[1]
    assert running.returncode == 130
    assert "Traceback" not in errors
    assert [path.name for path in tmp_path.iterdir()] == ["vault.toml"]


@pytest.mark.skipif(sys.platform == "win32", reason="/dev/full and pipes as on Linux")
class TestOutputThatNobodyTakes:
    """Printing fails; the work, the exit code and the words do not (failure mode H10)."""

    def shell(self, line, folder):
        command = ["bash", "-o", "pipefail", "-c", line.replace("isomould", f"{sys.executable} -m isomould")]
        return subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=240, check=False)

    def test_a_reader_that_goes_away(self, tmp_path, project_file):
        project_file(SMALL)
        for line in ("isomould new --list | true", "isomould check project.toml | true"):
            result = self.shell(f"({line.split('|')[0]}) | (exec <&-; sleep 3)", tmp_path)
            assert (result.returncode, "Traceback" in result.stderr) == (0, False)

    @pytest.mark.skipif(not Path("/dev/full").exists(), reason="a device that is always full")
    def test_a_full_disk_behind_the_output(self, tmp_path, project_file):
        project_file(SMALL)
        result = self.shell("isomould check project.toml > /dev/full", tmp_path)
        assert result.returncode == 3
        assert "E-PRINT" in result.stderr
        assert "Traceback" not in result.stderr

    @pytest.mark.skipif(not Path("/dev/full").exists(), reason="a device that is always full")
    def test_a_full_log_does_not_stop_a_build(self, tmp_path, project_file):
        project_file(SMALL)
        assert self.shell("isomould build project.toml --out built 2> /dev/full", tmp_path).returncode == 0
        assert (tmp_path / "built" / "manifest.json").is_file()


@pytest.mark.parametrize("arguments", [("new", "/"), ("new", ""), ("build", "project.toml", "--out", "/")])
def test_names_that_are_no_names(tmp_path, project_file, arguments):
    project_file(SMALL)
    result = run(*arguments, folder=tmp_path)
    assert (result.returncode, "Traceback" in result.stderr) == (2, False)


@pytest.mark.parametrize("arguments", [(), ("build",), ("nest", "x.json"), ("check", "x.toml", "--sett", "a=1")])
def test_usage_errors_exit_2_without_a_traceback(tmp_path, arguments):
    result = run(*arguments, folder=tmp_path)
    assert result.returncode in ({0, 2} if not arguments else {2})
    assert "Traceback" not in result.stderr


def test_compare_prints_and_writes_the_families(tmp_path, project_file):
    project_file(SMALL)
    compared = run("compare", "project.toml", "--out", "families.csv", folder=tmp_path)
    assert compared.returncode == 0, compared.stderr
    assert "edge-offset" in compared.stdout
    assert (tmp_path / "families.csv").read_text().count("\n") == 6


def test_draw_writes_a_picture_and_refuses_other_formats(tmp_path, project_file):
    project_file(SMALL)
    assert run("draw", "project.toml", "--out", "roof.svg", "--view", "curvature", folder=tmp_path).returncode == 0
    assert (tmp_path / "roof.svg").read_text().startswith("<svg")
    refused = run("draw", "project.toml", "--out", "roof.jpg", folder=tmp_path)
    assert refused.returncode == 2
    assert "E-DRAW-FILE" in refused.stderr
