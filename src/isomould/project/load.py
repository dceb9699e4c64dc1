"""Reading project files: TOML, overrides, and errors that name the field and the nearest key.

The settings of all stages are imported once there are tables to check: a slip of syntax is told at once.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from isomould.errors import Gathering, Note, OutputFault, Refused, RefusedTogether

if TYPE_CHECKING:
    from isomould.documents.info import Logo
    from isomould.project.schema import Project, ShapeTable

_LARGEST_FILE = 1_000_000


@dataclass(frozen=True)
class LoadedProject:
    """A validated project, the folder that its file references start from, and its source text.

    `shapes` are its other shapes by the names of their folders, each a whole project.
    """

    project: Project
    folder: Path
    source: bytes
    shapes: tuple[tuple[str, Project], ...] = ()
    logo: Logo | None = None
    notes: tuple[Note, ...] = ()
    """What should be known about the changes."""


def load_project(path: Path, overrides: Sequence[str] = ()) -> LoadedProject:
    """Read a project file.

    Parameters
    ----------
    path
        A TOML file.
    overrides
        Changes such as `rail.curve.rise="8 m"`, applied in order before validation.

    Raises
    ------
    Refused
        Naming the field, what was found, and the nearest key or the admissible values.
    OutputFault
        If the file cannot be read.
    """
    path = find_project(path)
    source, folder = _read(path), path.resolve().parent
    with Gathering() as faults:
        data = _overridden(_parse(source, path), overrides, faults)
        project = faults.run(validate, data, path.name)
        shapes = faults.run(lambda: _shapes(data, project.value, path.name))
        logo = faults.run(lambda: _logo(folder, project.value))
    return LoadedProject(project.value, folder, source, shapes.value, logo.value, _unit_notes(overrides, data))


def find_project(path: Path) -> Path:
    """Give the file that a user names, with or without its ending.

    >>> find_project(Path("templates/barrel-vault")).name
    'barrel-vault.toml'
    """
    whole = path.with_name(f"{path.name}.toml") if path.name else path
    return whole if not path.is_file() and whole.is_file() else path


def read_tables(path: Path, overrides: Sequence[str] = ()) -> Mapping[str, Any]:
    """Read the tables of a project file, with the overrides in place and nothing checked yet."""
    path = find_project(path)
    with Gathering() as faults:
        return _overridden(_parse(_read(path), path), overrides, faults)


def _overridden(data: Mapping[str, Any], overrides: Sequence[str], faults: Gathering) -> Mapping[str, Any]:
    """Set one value after another; one that cannot be set is left out and told.

    What the file says in another way than a change is replaced by it; two changes in two ways are a conflict.
    """
    for change in overrides:
        data = _without_rivals(data, change.partition("=")[0].strip())
    for change in overrides:
        changed = faults.run(_override, data, change)
        data = changed.result or data
    return data


def _without_rivals(data: Mapping[str, Any], key: str) -> Mapping[str, Any]:
    """Take out the other ways to divide a curve if a change says how to."""
    path = key.split(".")
    if len(path) < 3 or path[1] != "divide":
        return data

    from isomould.form.settings import WAYS

    if path[2] not in WAYS:
        return data
    table = data.get(path[0])
    divide = cast("Mapping[str, Any]", table).get("divide") if isinstance(table, Mapping) else None
    if not isinstance(divide, Mapping):
        return data
    kept = {k: v for k, v in cast("Mapping[str, Any]", divide).items() if k not in WAYS or k == path[2]}
    return with_value(data, f"{path[0]}.divide", kept)


def _unit_notes(overrides: Sequence[str], data: Mapping[str, Any]) -> tuple[Note, ...]:
    """Say what bare numbers were taken for in the place of lengths."""
    if not overrides:
        return ()

    from isomould.project.keys import is_length

    pairs = [(key.strip(), text.strip()) for key, _, text in (change.partition("=") for change in overrides)]
    return tuple(
        Note("W-SET-UNIT", f"--set {key}", f'{text} was taken for {text} mm; other lengths name their unit: "{text} m"')
        for key, text in pairs
        if _BARE.fullmatch(text) and is_length(key.split("."), data)
    )


_BARE = re.compile(r"[+-]?[0-9][0-9_.]*(?:[eE][+-]?[0-9]+)?")
"""A number without a unit."""


def _logo(folder: Path, project: Project) -> Logo | None:
    from isomould.project.logo import read_logo

    return read_logo(folder, project.project.logo)


def _shapes(data: Mapping[str, Any], project: Project, name: str) -> tuple[tuple[str, Project], ...]:
    """Give the other shapes of a project by the names of their folders."""
    with Gathering() as faults:
        shapes = [
            (shape.slug, faults.run(validate, _reshaped(data, shape), f"{name}, {shape.name}"))
            for shape in project.shapes
        ]
    return tuple((slug, shape.value) for slug, shape in shapes)


def _reshaped(data: Mapping[str, Any], shape: ShapeTable) -> dict[str, Any]:
    """Give the tables of a shape: those of the project with what the shape names in place."""
    name = f"{data['project']['name']}, {shape.name}"
    changed = {"project": {"name": name}, "rail": shape.rail, "generatrix": shape.generatrix}
    own = {table: {**data[table], **keys} for table, keys in changed.items()}
    return {key: value for key, value in {**data, **own}.items() if key != "shapes"}


def validate(data: Mapping[str, Any], name: str) -> Project:
    """Check the tables of a project and give the typed value; `name` is the file's, for errors."""
    from pydantic import ValidationError

    from isomould.project.schema import Project

    try:
        return Project.model_validate(data)
    except ValidationError as error:
        from isomould.project.findings import describe

        refusals = [Refused("E-PROJECT", f"{name}: {field}", *words) for field, words in describe(error, data)]
    raise RefusedTogether(refusals) if len(refusals) > 1 else refusals[0]


def _read(path: Path) -> bytes:
    try:
        if path.stat().st_size > _LARGEST_FILE:
            size = path.stat().st_size
            raise Refused(
                "E-PROJECT-SIZE",
                str(path),
                f"{size} bytes",
                f"{_LARGEST_FILE} bytes",
                "Is it a project file?",
            )
        return path.read_bytes()
    except FileNotFoundError:
        raise Refused(
            "E-PROJECT-FILE",
            str(path),
            "no such file",
            "a project file (TOML)",
            "Start one with: isomould new NAME",
        ) from None
    except OSError as error:
        message = f"E-PROJECT-FILE {path}: cannot be read ({error.strerror}). Check the path and its permissions."
        raise OutputFault(message) from error


def _parse(source: bytes, path: Path) -> dict[str, Any]:
    try:
        return tomllib.loads(source.decode("utf-8"))
    except UnicodeDecodeError as error:
        found, way_out = f"byte {error.start} is not UTF-8", "Save the file as UTF-8."
        raise Refused("E-PROJECT-TEXT", str(path), found, "UTF-8 text", way_out) from None
    except (ValueError, RecursionError) as error:  # numbers of thousands of digits and deep nests among them
        raise Refused("E-PROJECT-TOML", str(path), str(error), "valid TOML", "Mend the line.") from None


def _override(data: Mapping[str, Any], change: str) -> Mapping[str, Any]:
    """Set one value by its dotted key; the value is TOML, or text if it is none."""
    key, equals, text = change.partition("=")
    if not equals or not all(key.split(".")):
        raise Refused(
            "E-SET",
            f"--set {change}",
            "no KEY=VALUE",
            "a dotted key and a value",
            'Write --set rail.curve.rise="8 m".',
        )
    try:
        value = tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        value = text
    return with_value(data, key.strip(), value)


def with_value(data: Mapping[str, Any], key: str, value: object) -> dict[str, Any]:
    """Give tables with one value set by its dotted key; tables that are not there yet are made.

    >>> with_value({"rail": {"plane": "xz"}}, "rail.divide.nodes", 5)
    {'rail': {'plane': 'xz', 'divide': {'nodes': 5}}}
    """
    table, dot, rest = key.partition(".")
    if not dot:
        return {**data, table: value}
    inner: object = data.get(table, {})
    if not isinstance(inner, Mapping):
        raise Refused("E-SET", f"--set {key}", f"{table} is a value", "a table", "Check the key.")
    return {**data, table: with_value(cast("Mapping[str, Any]", inner), rest, value)}
