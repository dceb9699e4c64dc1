"""One run per folder: a lock file beside it that names the process (failure mode H6)."""

import ctypes
import os
import socket
import sys
from collections.abc import Generator
from contextlib import contextmanager, suppress
from pathlib import Path

from isomould.errors import Refused

_EXCLUSIVE = os.O_CREAT | os.O_EXCL | os.O_WRONLY


@contextmanager
def locked(path: Path) -> Generator[None]:
    """Hold the lock file `path`; the lock of a process of this machine that has died is taken over.

    Raises
    ------
    Refused
        If another process holds the lock; the message names it.
    """
    _acquire(path)
    try:
        yield
    finally:
        with suppress(OSError):  # the next run finds a dead process and takes the lock over
            path.unlink()


def is_alive(pid: int) -> bool:
    """Tell whether a process of this machine runs; when in doubt, it does."""
    if sys.platform == "win32":
        return _is_alive_on_windows(pid)
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except (PermissionError, OverflowError):
        return True
    return True


def _acquire(path: Path) -> None:
    try:
        _create(path)
    except FileExistsError:
        _take_over(path)


def _create(path: Path) -> None:
    descriptor = os.open(path, _EXCLUSIVE)
    try:
        with os.fdopen(descriptor, "w", encoding="utf-8") as file:
            file.write(f"{os.getpid()} {socket.gethostname()}\n")
    except OSError:
        path.unlink(missing_ok=True)  # a lock that names nobody would stay for ever
        raise


def _take_over(path: Path) -> None:
    """Replace a dead lock: move it aside, and look again at what was moved, before making a new one."""
    if _is_held(path):
        raise _held(path)
    aside = path.with_name(f"{path.name}-{os.getpid()}")
    try:
        path.rename(aside)
        _drop_dead(aside, path)
        _create(path)
    except (FileNotFoundError, FileExistsError):
        raise _held(path) from None


def _drop_dead(aside: Path, path: Path) -> None:
    if _is_held(aside):  # another run was faster, and this is its lock
        aside.rename(path)
        raise _held(path)
    aside.unlink()


def _is_held(path: Path) -> bool:
    pid, _, host = _owner(path).partition(" ")
    return not pid.isdecimal() or host != socket.gethostname() or is_alive(int(pid))


def _owner(path: Path) -> str:
    return path.read_text(encoding="utf-8", errors="replace").strip() if path.exists() else ""


def _held(path: Path) -> Refused:
    pid, _, host = _owner(path).partition(" ")
    found = f"process {pid or '?'} on {host or '?'} is writing here"
    return Refused(
        "E-LOCK-01", str(path), found, "one run at a time", "Wait for it, or delete the file if it has ended."
    )


_WAIT, _TIMED_OUT, _NO_SUCH_PROCESS = 0x00100000, 0x102, 87


def _is_alive_on_windows(pid: int) -> bool:
    """Ask for a handle, because `os.kill` would end the process."""
    if sys.platform != "win32":
        return True
    kernel = ctypes.WinDLL("kernel32", use_last_error=True)
    handle = kernel.OpenProcess(_WAIT, False, pid)
    if not handle:
        return ctypes.get_last_error() != _NO_SUCH_PROCESS
    running = kernel.WaitForSingleObject(handle, 0) == _TIMED_OUT
    kernel.CloseHandle(handle)
    return running
