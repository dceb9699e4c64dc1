"""Faults of the system at the n-th call, limits on files, kills at random times, two runs at once (SQLite's way)."""

import errno
import os
import random
import signal
import socket
import subprocess
import sys
import time
from collections import Counter
from pathlib import Path

import pytest
from test_folder import dead_pid, deliver

from isomould.errors import OutputFault
from isomould.verify import verify_folder
from isomould.writers.manifest import folder_faults
from museum import SMALL, write_project

WATCHED = [(Path, name) for name in ("write_bytes", "mkdir", "rename", "unlink", "read_bytes")]
WATCHED += [(os, name) for name in ("open", "fsync", "close")]


class Fault:
    """System calls of which the n-th fails, once or from then on."""

    def __init__(self, number, error, *, lasting):
        self.left, self.error, self.lasting, self.struck = number, error, lasting, False

    def watch(self, real):
        def call(*args, **options):
            self.left -= 1
            if self.left == 0 or (self.lasting and self.left < 0):
                self.struck = True
                raise OSError(self.error, os.strerror(self.error), str(args[0]) if args else "")
            return real(*args, **options)

        return call


def attempt(target, text):
    """Deliver; give the words of a fault of the system, nothing if there was none."""
    try:
        deliver(target, text, replace=True)
    except OutputFault as caught:
        return str(caught)
    return ""


@pytest.mark.parametrize("lasting", [False, True], ids=["once", "for good"])
@pytest.mark.parametrize("error", [errno.ENOSPC, errno.EIO, errno.EACCES, errno.EMFILE], ids=errno.errorcode.get)
def test_a_fault_at_any_call_leaves_the_old_folder_or_the_new_one(error, lasting, tmp_path, monkeypatch):
    deliver(tmp_path / "vault", "old")
    seen, dead = Counter(), dead_pid()
    for number in range(1, 200):
        fault = Fault(number, error, lasting=lasting)
        with monkeypatch.context() as patch:
            for owner, name in WATCHED:
                patch.setattr(owner, name, fault.watch(getattr(owner, name)))
            said = attempt(tmp_path / "vault", f"new {number}")
        outcome = "refused" if said else "done"
        assert not said or os.strerror(error) in said
        seen[outcome, fault.struck] += 1
        standing = (tmp_path / "vault" / "panels" / "P01.dxf").read_text() if (tmp_path / "vault").exists() else None
        assert not (tmp_path / "vault").exists() or folder_faults(tmp_path / "vault") == []
        if not lasting:
            assert standing is not None
        assert outcome == "refused" or standing == f"new {number}"
        if not fault.struck:
            break
        if (tmp_path / "vault.lock").exists():  # it could not be removed; the next run is another process
            (tmp_path / "vault.lock").write_text(f"{dead} {socket.gethostname()}\n")
        deliver(tmp_path / "vault", "old", replace=True)
        assert [path.name for path in tmp_path.iterdir()] == ["vault"]
    assert seen["refused", True] > 10
    assert seen["done", False] == 1


LIMITED = """
import resource, sys
sys.path[:0] = sys.argv[1:]
from pathlib import Path
from test_faults import attempt
for limit in (0, 100, 4000):
    resource.setrlimit(resource.RLIMIT_FSIZE, (limit, resource.RLIM_INFINITY))
    print(attempt(Path("vault"), "x" * 5000), flush=True)
"""


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs limits of POSIX")
def test_files_that_may_not_grow_leave_nothing_behind(tmp_path):
    """The lock, the manifest or a part file is cut short by the system, as a full disk does."""
    deliver(tmp_path / "vault", "old")
    command = [sys.executable, "-c", LIMITED, str(Path(__file__).parent), str(Path(__file__).parents[1])]
    run = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=120, check=True)
    assert [line.startswith("E-DISK-01") for line in run.stdout.splitlines()] == [True, True, True]
    assert run.stdout.count(os.strerror(errno.EFBIG)) == 3
    assert [path.name for path in tmp_path.iterdir()] == ["vault"]
    assert (tmp_path / "vault" / "panels" / "P01.dxf").read_text() == "old"


def build(folder, *options):
    """Start a real build of the small project in a process group of its own."""
    command = [
        sys.executable,
        "-m",
        "isomould",
        "build",
        "project.toml",
        "--out",
        "out",
        "--effort",
        "quick",
        "--quiet",
    ]
    return subprocess.Popen(
        [*command, *options],
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )


def finish(run):
    run.communicate(timeout=600)
    return run.returncode


@pytest.mark.long
def test_kills_at_random_times_leave_the_old_folder_or_the_new_one(tmp_path):
    write_project(tmp_path / "project.toml", SMALL)
    begun = time.monotonic()
    assert finish(build(tmp_path)) == 0
    usual, chance = time.monotonic() - begun, random.Random(4)
    for _ in range(20):
        run = build(tmp_path, "--replace")
        time.sleep(chance.uniform(0.1, 1.1) * usual)
        os.killpg(run.pid, signal.SIGKILL)
        run.communicate()
        assert folder_faults(tmp_path / "out") == []
    assert finish(build(tmp_path, "--replace")) == 0
    assert verify_folder(tmp_path / "out").passed
    assert sorted(path.name for path in tmp_path.iterdir()) == ["out", "project.toml"]


@pytest.mark.long
def test_of_two_runs_at_once_one_is_refused_and_one_delivers(tmp_path):
    write_project(tmp_path / "project.toml", SMALL)
    runs = [build(tmp_path), build(tmp_path)]
    said = [run.communicate(timeout=600)[1] for run in runs]
    assert sorted(run.returncode for run in runs) == [0, 2]
    assert any("is writing here" in text or "it exists" in text for text in said)
    assert verify_folder(tmp_path / "out").passed
