"""The manifest: every file of a delivered folder with its hash, written last."""

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Literal

from pydantic import TypeAdapter, ValidationError

from isomould.writers.disk import sha256, sha256_of, write_bytes
from isomould.writers.names import check_names

MANIFEST = "manifest.json"
TOOL = "isomould"


@dataclass(frozen=True)
class FileEntry:
    """A file of the folder: path with /, hash and size in bytes."""

    path: str
    sha256: str
    size: int


@dataclass(frozen=True)
class InputEntry:
    """A file that was read: its name, hash and size in bytes."""

    name: str
    sha256: str
    size: int


Scope = Literal["delivery", "schedules"]
"""What a folder holds: everything, or what `isomould schedule` writes."""


@dataclass(frozen=True)
class Manifest:
    """The schema of `manifest.json`."""

    schema: int
    tool: dict[str, str]
    scope: Scope
    inputs: list[InputEntry]
    libraries: dict[str, str]
    files: list[FileEntry]


_SCHEMA = TypeAdapter(Manifest)


def write_manifest(
    folder: Path, inputs: Mapping[str, bytes], versions: Mapping[str, str], scope: Scope = "delivery"
) -> None:
    """Write `manifest.json` over all files of a folder.

    Parameters
    ----------
    folder : Path
    inputs : mapping of name to content
        The project file and the files it names, as they were read.
    versions : mapping of package name to version
        "isomould" is the tool, the others are libraries.
    scope : "delivery" or "schedules"

    Raises
    ------
    Refused
        If a file name would not survive on another system.
    """
    libraries = {name: versions[name] for name in sorted(versions) if name != TOOL}
    manifest = Manifest(
        schema=1,
        tool={"name": TOOL, "version": versions[TOOL]},
        scope=scope,
        inputs=[_input_entry(name, inputs[name]) for name in sorted(inputs)],
        libraries=libraries,
        files=_entries(folder),
    )
    text = json.dumps(asdict(manifest), indent=1, ensure_ascii=False)
    write_bytes(folder / MANIFEST, f"{text}\n".encode())


def listed_files(folder: Path) -> list[FileEntry]:
    """Give the files that the manifest of a folder of ours lists."""
    return _SCHEMA.validate_json((folder / MANIFEST).read_bytes()).files


def folder_faults(folder: Path) -> list[str]:
    """Say what in a folder is not as its manifest says: nothing, if it is ours and untouched.

    >>> folder_faults(Path("no-such-folder"))
    ['manifest.json is missing or not ours']
    """
    listed = _listed(folder)
    if listed is None:
        return [f"{MANIFEST} is missing or not ours"]
    found = {path: folder / path for path in files_of(folder) if path != MANIFEST}
    foreign = [f"{path} is not in the manifest" for path in found if path not in listed]
    lost = [f"{path} is missing" for path in listed if path not in found]
    return foreign + lost + [f"{p} was changed" for p in found if p in listed and sha256(found[p]) != listed[p]]


def files_of(folder: Path) -> list[str]:
    """List everything below a folder but plain folders that hold something, as sorted paths with /."""
    below = (path for path in folder.rglob("*") if path.is_symlink() or not path.is_dir() or not any(path.iterdir()))
    return sorted(path.relative_to(folder).as_posix() for path in below)


def _listed(folder: Path) -> dict[str, str] | None:
    try:
        manifest = _SCHEMA.validate_json((folder / MANIFEST).read_bytes())
    except (FileNotFoundError, NotADirectoryError, ValidationError):  # other faults are the system's, and told as such
        return None
    ours = manifest.schema == 1 and manifest.tool.get("name") == TOOL
    return {entry.path: entry.sha256 for entry in manifest.files} if ours else None


def _entries(folder: Path) -> list[FileEntry]:
    paths = [path for path in files_of(folder) if path != MANIFEST]
    check_names(paths)
    return [_entry(folder, path) for path in paths]


def _entry(folder: Path, path: str) -> FileEntry:
    return FileEntry(path, sha256(folder / path), (folder / path).stat().st_size)


def _input_entry(name: str, content: bytes) -> InputEntry:
    return InputEntry(name, sha256_of(content), len(content))
