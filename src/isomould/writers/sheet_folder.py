"""A folder of cut sheets, published whole by one rename, or not at all."""

import os
import re
import shutil
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path

from isomould.errors import Refused
from isomould.writers.disk import fault, put_in_place

_SHEET = re.compile(r"S\d+\.dxf")


@contextmanager
def sheet_folder(target: Path, *, replace: bool) -> Generator[Path]:
    """Give a folder beside the target to write sheets into; on a clean exit it becomes the target.

    Parameters
    ----------
    target
        A new or empty folder.
    replace
        Whether a folder that holds nothing but cut sheets may be replaced.

    Raises
    ------
    Refused
        E-OUT-10, if something else is there.
    OutputFault
        If the system refuses; nothing is left behind.
    """
    refuse_taken(target, replace)
    partial, aside = (target.with_name(f"{target.name}.{kind}-{os.getpid()}") for kind in ("partial", "replaced"))
    try:
        partial.mkdir(parents=True)
        yield partial
        refuse_taken(target, replace)  # once more: what came there in the meantime is not ours to remove
        put_in_place(partial, target, aside)
    except OSError as error:
        raise fault(target, error) from error
    finally:
        shutil.rmtree(partial, ignore_errors=True)


def refuse_taken(target: Path, replace: bool) -> None:
    """Refuse a folder that holds anything but cut sheets, or cut sheets that may not be replaced (E-OUT-10)."""
    if not os.path.lexists(target):
        return
    found = sorted(path.name for path in target.iterdir()) if target.is_dir() and not target.is_symlink() else None
    strange = "it is no folder" if found is None else next((name for name in found if not _SHEET.fullmatch(name)), None)
    if strange:
        _refuse(target, f"it holds {strange}" if found else strange, "a folder of cut sheets alone", "Choose another.")
    if found and not replace:
        _refuse(target, f"it holds {len(found)} sheets", "a new folder", "Choose another, or give --replace.")


def _refuse(target: Path, found: str, limit: str, way_out: str) -> None:
    raise Refused("E-OUT-10", f"folder {target}", found, limit, way_out)
