"""The one place where bytes reach the disk; every writer makes its bytes in memory first.

So a full disk or a missing permission meets one function, and no library leaves half a file behind.
"""

import errno
import hashlib
import io
import os
import shutil
import zipfile
from collections.abc import Generator, Mapping
from contextlib import contextmanager
from pathlib import Path

from isomould.errors import OutputFault

_ZIP_DATE = (1980, 1, 1, 0, 0, 0)
_UNIX = 3
_FULL, _CLOSED = "Free some space, or choose another disk.", "Choose a folder that you may write to."
_WAYS_OUT = {
    errno.ENOSPC: _FULL,
    errno.EDQUOT: _FULL,
    errno.EACCES: _CLOSED,
    errno.EPERM: _CLOSED,
    errno.EROFS: _CLOSED,
}


def write_bytes(path: Path, data: bytes) -> None:
    """Write a file, making its folder.

    Raises
    ------
    OutputFault
        If the system refuses; the message names the path and the cause.
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
    except OSError as error:
        raise fault(path, error) from error


def replace_file(path: Path, data: bytes) -> None:
    """Write a file beside its place and rename it there: the old one stays whole until the new one is.

    Raises
    ------
    OutputFault
        If the system refuses; nothing is left behind.
    """
    with replacing(path) as partial:
        write_bytes(partial, data)


@contextmanager
def replacing(path: Path) -> Generator[Path]:
    """Give a place beside a file to write it to; on a clean exit it is renamed, else nothing is left behind."""
    partial = path.with_name(f"{path.stem}.partial-{os.getpid()}{path.suffix}")
    try:
        yield partial
        partial.replace(path)
    except OSError as error:
        raise fault(path, error) from error
    finally:
        partial.unlink(missing_ok=True)


def put_in_place(folder: Path, target: Path, aside: Path) -> None:
    """Rename a folder to its target; what was there steps aside, is removed, and comes back if that fails."""
    replaced = os.path.lexists(target)
    if replaced:
        target.rename(aside)
    try:
        folder.rename(target)
    except BaseException:
        if replaced:
            aside.rename(target)
        raise
    shutil.rmtree(aside, ignore_errors=True)


def fault(path: Path, error: OSError) -> OutputFault:
    """Word what the system said about a path."""
    named = error.filename or path
    way_out = _WAYS_OUT.get(error.errno or 0, "Check the path and the disk.")
    return OutputFault(f"E-DISK-01 {named}: {error.strerror or error}. {way_out}")


def sha256(path: Path) -> str:
    """Give the SHA-256 of a file in hexadecimal."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def sha256_of(data: bytes) -> str:
    """Give the SHA-256 of bytes in hexadecimal."""
    return hashlib.sha256(data).hexdigest()


def sync_tree(folder: Path) -> None:
    """Ask the system to bring every file below a folder, and the folders, to the disk."""
    for path in sorted(folder.rglob("*")):
        _sync(path)
    _sync(folder)


def zip_bytes(entries: Mapping[str, bytes]) -> bytes:
    """Pack entries into a ZIP archive that depends on nothing but the entries, in their order."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for name, data in entries.items():
            archive.writestr(_entry(name), data, zipfile.ZIP_DEFLATED)
    return buffer.getvalue()


def _entry(name: str) -> zipfile.ZipInfo:
    info = zipfile.ZipInfo(name, _ZIP_DATE)
    info.create_system = _UNIX
    return info


def _sync(path: Path) -> None:
    if path.is_dir() and os.name == "nt":
        return  # Windows neither opens nor needs it
    descriptor = os.open(path, os.O_RDONLY if path.is_dir() else os.O_RDWR)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
