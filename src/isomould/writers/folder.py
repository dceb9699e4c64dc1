"""The published folder: written beside the target and published by one rename, or not at all.

A run that is killed leaves the old folder or none, never half (failure modes H1 to H8). The next
run, holding the lock, clears what a dead one left behind.
"""

import os
import re
import shutil
from collections.abc import Generator
from contextlib import contextmanager, suppress
from pathlib import Path

from isomould.errors import Refused
from isomould.writers.disk import fault, put_in_place, sync_tree
from isomould.writers.lock import is_alive, locked
from isomould.writers.manifest import folder_faults

_PARTIAL, _ASIDE, _LOCK = "partial", "replaced", "lock"


@contextmanager
def candidate(target: Path, replace: bool = False) -> Generator[Path]:
    """Give a candidate folder to write into; on a clean exit it becomes `target`.

    Enter it before computing: what forbids publishing is found at once. Write the manifest last.
    Whatever is raised inside, `KeyboardInterrupt` too, removes the candidate.

    Parameters
    ----------
    target : Path
        Folder to publish; its parents are made.
    replace : bool
        Whether an existing delivery of ours, complete and untouched, may be replaced.

    Raises
    ------
    Refused
        If the target exists, is not empty and may not be replaced, or another run writes it.
    OutputFault
        If the system refuses: no space, no permission; nothing is left behind.
    """
    target = _absolute(target)
    if not target.name:
        raise _refused(target, "the root of a disk", "a folder on it", "Choose another with --out.")
    missing = [parent for parent in target.parents if not parent.exists()]
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        with locked(_beside(target, _LOCK)):
            _clear_leftovers(target)
            _check_target(target, replace)
            yield from _written(target, replace)
    except OSError as error:
        raise fault(target, error) from error
    finally:
        _remove_empty(missing)


def _written(target: Path, replace: bool) -> Generator[Path]:
    folder = _beside(target, f"{_PARTIAL}-{os.getpid()}")
    try:
        folder.mkdir()
        yield folder
        _check_complete(folder)
        sync_tree(folder)
        _check_target(target, replace)  # once more: what came there in the meantime is not ours to remove
        put_in_place(folder, target, _beside(target, f"{_ASIDE}-{os.getpid()}"))
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _remove_empty(folders: list[Path]) -> None:
    """Remove the parents that were made for a target that was not published, the innermost first."""
    for folder in folders:
        with suppress(OSError):
            folder.rmdir()


def _absolute(target: Path) -> Path:
    """Make a path absolute without following the target itself, should it be a link."""
    return target.resolve() if target.name in {"", ".."} else target.parent.resolve() / target.name


def _beside(target: Path, suffix: str) -> Path:
    return target.with_name(f"{target.name}.{suffix}")


def _check_target(target: Path, replace: bool) -> None:
    if not os.path.lexists(target) or _is_empty(target):
        return
    if not replace:
        raise _refused(target, "it exists", "a new folder", "Choose another with --out, or give --replace.")
    faults = ["it is no folder"] if target.is_symlink() or not target.is_dir() else folder_faults(target)
    if faults:
        limit = "a complete delivery of isomould without other files"
        raise _refused(target, "; ".join(faults[:3]), limit, "Move these files away, or choose another folder.")


def _is_empty(target: Path) -> bool:
    return target.is_dir() and not target.is_symlink() and not any(target.iterdir())


def _check_complete(folder: Path) -> None:
    faults = folder_faults(folder)
    if faults:
        way_out = "Nothing was published; try again."
        raise _refused(folder, "; ".join(faults[:3]), "a folder as its manifest says", way_out)


def _clear_leftovers(target: Path) -> None:
    """Remove what dead runs left; bring back an old delivery that a dead run left aside."""
    for path in sorted(target.parent.glob(f"{_escaped(target.name)}.*-*")):
        kind = _dead_kind(path, target)
        if kind == _ASIDE and not os.path.lexists(target):
            path.rename(target)
        elif path.is_dir() and kind:
            shutil.rmtree(path)
        elif kind:
            path.unlink()


def _dead_kind(path: Path, target: Path) -> str | None:
    match = re.fullmatch(rf"{re.escape(target.name)}\.({_PARTIAL}|{_ASIDE}|{_LOCK})-(\d+)", path.name)
    return match[1] if match and not _runs(int(match[2])) else None


def _runs(pid: int) -> bool:
    return pid != os.getpid() and is_alive(pid)


def _escaped(name: str) -> str:
    return re.sub(r"([*?[])", r"[\1]", name)


def _refused(folder: Path, found: str, limit: str, way_out: str) -> Refused:
    return Refused("E-OUT-09", f"folder {folder}", found, limit, way_out)
