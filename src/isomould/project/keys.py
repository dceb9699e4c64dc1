"""The keys that tables of the project file may have, and what their values are."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, cast, get_args

from pydantic import BeforeValidator
from pydantic.fields import FieldInfo

from isomould.project.schema import Project
from isomould.settings import Settings
from isomould.units import parse_length

_DISCRIMINATORS = ("kind", "detail")
"""Keys that say which of several tables one is."""


def known_keys(tables: Sequence[str], data: Mapping[str, Any] | None = None) -> list[str]:
    """Give the keys that the table at a path may have: in all its variants, or in the one that the data names."""
    models, place = _models_at(tables, data)
    own = [model for model in models if _suits(model, place)] or models
    return sorted({field.alias or name for model in own for name, field in model.model_fields.items()})


def is_length(path: Sequence[str], data: Mapping[str, Any]) -> bool:
    """Tell whether the value at a path is a length."""
    models, place = _models_at(path[:-1], data)
    own = [model for model in models if _suits(model, place)]
    fields = [model.model_fields[path[-1]] for model in own if path[-1] in model.model_fields]
    return any(_parses_lengths(field) for field in fields)


def _models_at(tables: Sequence[str], data: Mapping[str, Any] | None) -> tuple[list[type[Settings]], object]:
    """Give the types that the table at a path may have, and what the data have there."""
    models: list[type[Settings]] = [Project]
    place: object = data
    for table in tables:
        fields = [f for m in models for name, f in m.model_fields.items() if (f.alias or name) == table]
        found = {model: None for field in fields for model in _settings_in(field.annotation)}
        models = [*found] or models
        place = cast("Mapping[str, object]", place).get(table) if isinstance(place, Mapping) else None
    return models, place


def _suits(model: type[Settings], place: object) -> bool:
    """Tell whether a table is of the kind that it names; one that names none may be of any."""
    if not isinstance(place, Mapping):
        return True
    said = cast("Mapping[str, object]", place)
    return all(
        said[name] in get_args(model.model_fields[name].annotation)
        for name in _DISCRIMINATORS
        if name in said and name in model.model_fields
    )


def _settings_in(annotation: object) -> Iterator[type[Settings]]:
    """Give all settings types inside an annotation."""
    if isinstance(annotation, type) and issubclass(annotation, Settings):
        yield annotation
    for part in get_args(annotation):
        yield from _settings_in(part)


def _parses_lengths(field: FieldInfo) -> bool:
    """Tell whether a field reads a length, alone or as one of several things."""
    return any(map(_reads_a_length, (*field.metadata, *_parts(field.annotation))))


def _parts(annotation: object) -> Iterator[object]:
    """Give what an annotation is made of; lists of lengths are no length."""
    if getattr(annotation, "__origin__", None) is not tuple:
        for part in (*get_args(annotation), *getattr(annotation, "__metadata__", ())):
            yield part
            yield from _parts(part)


def _reads_a_length(part: object) -> bool:
    return isinstance(part, BeforeValidator) and part.func is parse_length
