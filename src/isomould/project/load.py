"""Reading project files: TOML, overrides, and errors that name the field and the nearest key."""

import difflib
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast, get_args

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from isomould.documents.info import Logo
from isomould.errors import Gathering, OutputFault, Refused, RefusedTogether
from isomould.project.logo import read_logo
from isomould.project.schema import Project, ShapeTable
from isomould.project.wording import Words, word
from isomould.settings import Settings

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
    source, folder = _read(path), path.resolve().parent
    with Gathering() as faults:
        data = _overridden(_parse(source, path), overrides, faults)
        project = faults.run(validate, data, path.name)
        shapes = faults.run(lambda: _shapes(data, project.value, path.name))
        logo = faults.run(lambda: read_logo(folder, project.value.project.logo))
    return LoadedProject(project.value, folder, source, shapes.value, logo.value)


def read_tables(path: Path, overrides: Sequence[str] = ()) -> Mapping[str, Any]:
    """Read the tables of a project file, with the overrides in place and nothing checked yet."""
    with Gathering() as faults:
        return _overridden(_parse(_read(path), path), overrides, faults)


def _overridden(data: Mapping[str, Any], overrides: Sequence[str], faults: Gathering) -> Mapping[str, Any]:
    """Set one value after another; one that cannot be set is left out and told."""
    for change in overrides:
        changed = faults.run(_override, data, change)
        data = changed.result or data
    return data


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
    try:
        return Project.model_validate(data)
    except ValidationError as error:
        found = [(each, words) for each in error.errors() for words in _describe(each, data)]
        refusals = [Refused("E-PROJECT", f"{name}: {_field(each, data)}", *words) for each, words in found]
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


def _field(detail: ErrorDetails, data: Mapping[str, Any]) -> str:
    """Name the field that one of pydantic's findings is about."""
    path, _ = _locate(detail["loc"], data, lost=detail["type"] == "missing")
    return ".".join(path) or "project file"


def _describe(detail: ErrorDetails, data: Mapping[str, Any]) -> list[Words]:
    """Say value found, limit and way out of one of pydantic's findings, which may be several in one."""
    path, siblings = _locate(detail["loc"], data, lost=detail["type"] == "missing")
    if detail["type"] == "extra_forbidden":
        known = _known_keys(path[:-1])
        near = difflib.get_close_matches(path[-1], known, 1, 0.5)
        if path[-1] in known:
            return [Words("a key of another kind of this table", "the keys of its own", "See docs/project-file.md.")]
        hint = f"Did you mean {near[0]!r}?" if near else "Remove it or see docs/project-file.md for the keys."
        return [Words("unknown key", f"one of {', '.join(known)}", hint)]
    if detail["type"] == "missing":
        given = ", ".join(siblings) or "empty"
        return [Words("missing", "required", f"Add it to {'.'.join(path[:-1]) or 'the file'} ({given} given).")]
    return word(detail)


def _locate(location: Sequence[str | int], data: Mapping[str, Any], lost: bool) -> tuple[list[str], list[str]]:
    """Path of a finding, a lost key among them, without pydantic's names for members of unions; keys beside it."""
    path: list[str] = []
    place: Any = data
    siblings: list[str] = []
    for depth, part in enumerate(location):
        last = depth == len(location) - 1
        here = isinstance(place, dict) and (part in place or (last and lost))
        if here or (isinstance(part, int) and isinstance(place, list)):
            siblings = [str(key) for key in place] if isinstance(place, dict) else []
            path.append(str(part))
            place = place.get(part) if isinstance(place, dict) else _item(place, int(part))
    return path, siblings


def _item(values: list[Any], number: int) -> Any:
    """Item of a list, None beyond its end: a list that is too short is itself the finding."""
    return values[number] if number < len(values) else None


def _known_keys(tables: Sequence[str]) -> list[str]:
    """Keys that the table at a path may have, in all its variants."""
    models: set[type[Settings]] = {Project}
    for table in tables:
        fields = [f for m in models for name, f in m.model_fields.items() if (f.alias or name) == table]
        models = {model for field in fields for model in _settings_in(field.annotation)} or models
    return sorted({field.alias or name for model in models for name, field in model.model_fields.items()})


def _settings_in(annotation: object) -> set[type[Settings]]:
    """All settings types inside an annotation."""
    if isinstance(annotation, type) and issubclass(annotation, Settings):
        return {annotation}
    return {model for part in get_args(annotation) for model in _settings_in(part)}
