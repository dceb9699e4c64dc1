import errno
import json
import os
import socket
import subprocess
import sys
from pathlib import Path

import pytest

from isomould.errors import OutputFault, Refused
from isomould.writers import disk, folder, lock
from isomould.writers.disk import write_bytes
from isomould.writers.folder import candidate
from isomould.writers.manifest import folder_faults, write_manifest
from isomould.writers.names import check_names, safe_name

VERSIONS = {"isomould": "0.1.0", "numpy": "2.0", "ezdxf": "1.4"}


def deliver(target, text="one", **options):
    with candidate(target, **options) as inside:
        write_bytes(inside / "panels" / "P01.dxf", text.encode())
        write_manifest(inside, {"vault.toml": b"schema = 1"}, VERSIONS)


def names(root):
    return sorted(path.name for path in root.iterdir())


def dead_pid():
    process = subprocess.Popen([sys.executable, "-c", ""])
    process.wait()
    return process.pid


def test_folder_is_published_whole_and_alone(tmp_path):
    deliver(tmp_path / "deep" / "vault")
    assert names(tmp_path / "deep") == ["vault"]
    assert folder_faults(tmp_path / "deep" / "vault") == []


def test_an_empty_folder_may_be_filled(tmp_path):
    (tmp_path / "vault").mkdir()
    deliver(tmp_path / "vault")
    assert folder_faults(tmp_path / "vault") == []
    assert names(tmp_path) == ["vault"]


def test_what_comes_into_an_empty_folder_meanwhile_stays(tmp_path):
    (tmp_path / "vault").mkdir()

    def deliver_while_another_writes():
        with candidate(tmp_path / "vault") as inside:
            write_manifest(inside, {}, VERSIONS)
            (tmp_path / "vault" / "mine.txt").write_text("mine")

    with pytest.raises(Refused, match="it exists"):
        deliver_while_another_writes()
    assert (tmp_path / "vault" / "mine.txt").read_text() == "mine"
    assert names(tmp_path) == ["vault"]


def test_manifest_lists_every_file_with_its_hash(tmp_path):
    deliver(tmp_path / "vault")
    manifest = json.loads((tmp_path / "vault" / "manifest.json").read_text(encoding="utf-8"))
    assert manifest["schema"] == 1
    assert manifest["tool"] == {"name": "isomould", "version": "0.1.0"}
    assert list(manifest["libraries"]) == ["ezdxf", "numpy"]
    assert manifest["inputs"] == [{"name": "vault.toml", "sha256": disk.sha256_of(b"schema = 1"), "size": 10}]
    assert manifest["files"] == [{"path": "panels/P01.dxf", "sha256": disk.sha256_of(b"one"), "size": 3}]


def test_nothing_appears_before_the_end(tmp_path):
    with candidate(tmp_path / "vault") as inside:
        assert not (tmp_path / "vault").exists()
        assert inside.parent == tmp_path
        write_manifest(inside, {}, VERSIONS)
    assert (tmp_path / "vault").is_dir()


@pytest.mark.parametrize("raised", [ValueError, KeyboardInterrupt, SystemExit, MemoryError])
def test_whatever_is_raised_inside_leaves_nothing(raised, tmp_path):
    with pytest.raises(raised), candidate(tmp_path / "vault") as inside:
        stop_half_way(inside, raised)
    assert names(tmp_path) == []


def stop_half_way(inside, raised):
    write_bytes(inside / "half.dxf", b"0")
    raise raised


def test_existing_target_is_refused_and_kept(tmp_path):
    deliver(tmp_path / "vault")
    with pytest.raises(Refused, match="--replace"):
        deliver(tmp_path / "vault", "two")
    assert (tmp_path / "vault" / "panels" / "P01.dxf").read_text() == "one"


def test_our_own_delivery_is_replaced_on_request(tmp_path):
    deliver(tmp_path / "vault")
    deliver(tmp_path / "vault", "two", replace=True)
    assert (tmp_path / "vault" / "panels" / "P01.dxf").read_text() == "two"
    assert names(tmp_path) == ["vault"]


def spoil_foreign(path):
    (path / "notes.txt").write_text("mine")


def spoil_foreign_folder(path):
    (path / "mine").mkdir()


def spoil_changed(path):
    (path / "panels" / "P01.dxf").write_text("two")


def spoil_missing(path):
    (path / "panels" / "P01.dxf").unlink()


def spoil_manifest(path):
    (path / "manifest.json").write_text('{"files": []}')


def spoil_other_tool(path):
    manifest = (path / "manifest.json").read_text(encoding="utf-8")
    (path / "manifest.json").write_text(manifest.replace('"name": "isomould"', '"name": "other"'))


SPOILS = [spoil_foreign, spoil_foreign_folder, spoil_changed, spoil_missing, spoil_manifest, spoil_other_tool]


@pytest.mark.parametrize("spoil", SPOILS)
def test_what_is_not_ours_or_was_touched_is_never_replaced(spoil, tmp_path):
    deliver(tmp_path / "vault")
    spoil(tmp_path / "vault")
    before = sorted(tmp_path.rglob("*"))
    with pytest.raises(Refused, match="complete delivery"):
        deliver(tmp_path / "vault", "two", replace=True)
    assert sorted(tmp_path.rglob("*")) == before


def test_a_link_in_place_of_the_target_is_not_followed(tmp_path):
    deliver(tmp_path / "real")
    (tmp_path / "vault").symlink_to(tmp_path / "real", target_is_directory=True)
    with pytest.raises(Refused, match="no folder"):
        deliver(tmp_path / "vault", "two", replace=True)
    assert (tmp_path / "real" / "panels" / "P01.dxf").read_text() == "one"


def test_a_candidate_without_a_true_manifest_is_not_published(tmp_path):
    with pytest.raises(Refused, match="manifest"), candidate(tmp_path / "vault") as inside:
        write_bytes(inside / "P01.dxf", b"0")
    with pytest.raises(Refused, match=r"late\.dxf"), candidate(tmp_path / "vault") as inside:
        add_after_the_manifest(inside)
    assert names(tmp_path) == []


def add_after_the_manifest(inside):
    write_manifest(inside, {}, VERSIONS)
    write_bytes(inside / "late.dxf", b"0")


def failing(error, after=0):
    """Stand in for a system call that works `after` times and then fails for good."""
    calls = []

    def call(*args, real, **options):
        calls.append(args)
        if len(calls) > after:
            raise OSError(error, os.strerror(error))
        return real(*args, **options)

    return call


def inject(monkeypatch, owner, name, error, after=0):
    real, call = getattr(owner, name), failing(error, after)
    monkeypatch.setattr(owner, name, lambda *args, **options: call(*args, real=real, **options))


CALLS = [(Path, "write_bytes"), (Path, "mkdir"), (os, "fsync"), (Path, "rename"), (os, "open")]


@pytest.mark.parametrize("error", [errno.ENOSPC, errno.EACCES, errno.EIO, errno.EROFS])
@pytest.mark.parametrize("call", CALLS, ids=lambda call: call[1])
@pytest.mark.parametrize("replace", [False, True])
def test_a_system_that_refuses_leaves_the_old_folder_or_none(call, error, replace, tmp_path, monkeypatch):
    if replace:
        deliver(tmp_path / "vault")
    with monkeypatch.context() as patch:
        inject(patch, *call, error)
        with pytest.raises(OutputFault, match=os.strerror(error)) as caught:
            deliver(tmp_path / "vault", "two", replace=replace)
    assert caught.value.exit_code == 3
    assert str(tmp_path) in str(caught.value)
    assert names(tmp_path) == (["vault"] if replace else [])
    assert not replace or (tmp_path / "vault" / "panels" / "P01.dxf").read_text() == "one"
    deliver(tmp_path / "vault", "two", replace=replace)


def test_the_old_folder_comes_back_when_the_last_rename_fails(tmp_path, monkeypatch):
    deliver(tmp_path / "vault")
    real = Path.rename

    def rename(self, to):
        if ".partial-" in self.name:
            raise OSError(errno.EIO, "Input/output error", str(self))
        return real(self, to)

    monkeypatch.setattr(Path, "rename", rename)
    with pytest.raises(OutputFault, match="Input/output error"):
        deliver(tmp_path / "vault", "two", replace=True)
    assert names(tmp_path) == ["vault"]
    assert folder_faults(tmp_path / "vault") == []


def test_a_second_run_is_refused_and_told_who_runs(tmp_path):
    with candidate(tmp_path / "vault") as inside:
        with pytest.raises(Refused, match=f"process {os.getpid()} on {socket.gethostname()}"):
            deliver(tmp_path / "vault")
        write_manifest(inside, {}, VERSIONS)
    assert names(tmp_path) == ["vault"]


def test_the_lock_of_a_dead_process_is_taken_over_and_its_rest_removed(tmp_path):
    pid = dead_pid()
    (tmp_path / "vault.lock").write_text(f"{pid} {socket.gethostname()}\n")
    write_bytes(tmp_path / f"vault.partial-{pid}" / "half.dxf", b"0")
    deliver(tmp_path / "vault")
    assert names(tmp_path) == ["vault"]


def test_an_old_delivery_that_a_dead_run_left_aside_comes_back(tmp_path):
    deliver(tmp_path / "vault")
    (tmp_path / "vault").rename(tmp_path / f"vault.replaced-{dead_pid()}")
    with pytest.raises(Refused, match="it exists"):
        deliver(tmp_path / "vault", "two")
    assert names(tmp_path) == ["vault"]
    assert (tmp_path / "vault" / "panels" / "P01.dxf").read_text() == "one"


@pytest.mark.parametrize("owner", ["", "rubbish", "1 another-machine"])
def test_a_lock_in_doubt_is_respected(owner, tmp_path):
    (tmp_path / "vault.lock").write_text(owner)
    with pytest.raises(Refused, match="E-LOCK-01"):
        deliver(tmp_path / "vault")
    assert names(tmp_path) == ["vault.lock"]


def test_a_lock_that_another_run_takes_over_meanwhile_is_given_back(tmp_path, monkeypatch):
    path = tmp_path / "vault.lock"
    path.write_text(f"{dead_pid()} {socket.gethostname()}\n")
    real = lock._is_held

    def late(asked):
        held = real(asked)
        if asked == path:
            path.write_text(f"{os.getppid()} {socket.gethostname()}\n")
        return held

    monkeypatch.setattr(lock, "_is_held", late)
    with pytest.raises(Refused, match=f"process {os.getppid()}"):
        deliver(tmp_path / "vault")
    assert names(tmp_path) == ["vault.lock"]


def test_partials_of_living_processes_and_names_alike_stay(tmp_path):
    alive = tmp_path / f"vault.partial-{os.getppid()}"
    for path in (alive, tmp_path / "vault.partial-x", tmp_path / f"vault2.partial-{dead_pid()}"):
        path.mkdir()
    deliver(tmp_path / "vault")
    assert len(names(tmp_path)) == 4


def test_a_process_that_runs_is_alive():
    assert lock.is_alive(os.getpid())
    assert not lock.is_alive(dead_pid())


KILLED = """
import os, signal, sys
from pathlib import Path
sys.path.insert(0, sys.argv[2])
from test_folder import deliver
from isomould.writers.manifest import folder_faults
target = Path(sys.argv[1]) / "vault"
watched = [(Path, name) for name in ("rename", "mkdir", "write_bytes", "unlink")]
watched += [(os, "fsync"), (os, "open")]

def dying(real):
    def call(*args, **options):
        global left
        left -= 1
        if left < 0:
            os.kill(os.getpid(), signal.SIGKILL)
        return real(*args, **options)
    return call

for step in range(60):
    if os.fork() == 0:
        left = step
        for owner, name in watched:
            setattr(owner, name, dying(getattr(owner, name)))
        try:
            deliver(target, "two", replace=True)
        except BaseException as error:
            print(repr(error), flush=True)
            os._exit(1)
        os._exit(0)
    status = os.wait()[1]
    print(status, "none" if not target.exists() else "torn" if folder_faults(target) else "whole")
    if status == 0:
        break
"""


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork and SIGKILL")
def test_a_kill_at_any_step_leaves_the_old_folder_or_the_new_one_or_none(tmp_path):
    deliver(tmp_path / "vault")
    command = [sys.executable, "-c", KILLED, str(tmp_path), str(Path(__file__).parent)]
    lines = subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()
    assert len(lines) > 15
    assert {line.partition(" ")[0] for line in lines[:-1]} == {"9"}
    assert not [line for line in lines if "torn" in line]
    assert lines[-1] == "0 whole"
    deliver(tmp_path / "vault", "three", replace=True)
    assert names(tmp_path) == ["vault"]


@pytest.mark.parametrize("name", ["", "...", "CON", "com1", "a\0b", "——", "x" * 81, "a\nb", "\ud800"])
def test_names_that_some_system_cannot_hold_are_refused(name):
    with pytest.raises(Refused, match=r"project\.name"):
        safe_name(name)


def test_names_cannot_leave_the_folder():
    assert safe_name("../../etc/passwd") == "etc-passwd"
    assert safe_name("Größe 2") == "grosse-2"


@pytest.mark.parametrize("path", ["nul.dxf", "a/CON/b", "a/b.", "a/b ", "a?b", "a//b", "../b", "x" * 161, "P1.dxf"])
def test_file_names_are_checked_for_all_systems(path):
    with pytest.raises(Refused, match="E-NAME-01"):
        check_names(["p1.dxf", path])


def test_windows_asks_the_kernel_not_kill(monkeypatch):
    monkeypatch.setattr(lock.sys, "platform", "win32")
    monkeypatch.setattr(lock, "_is_alive_on_windows", lambda pid: pid == 7)
    monkeypatch.setattr(os, "kill", lambda *_: pytest.fail("os.kill ends processes on Windows"))
    assert lock.is_alive(7)
    assert not lock.is_alive(8)
    assert folder.is_alive is lock.is_alive
