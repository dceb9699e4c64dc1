"""What a project file with faults says well: enough to try its curves before the faults are mended."""

from collections.abc import Callable, Mapping
from typing import Any

from pydantic import ValidationError

from isomould.form.settings import SurfaceSettings
from isomould.project.schema import GeneratrixTable, LimitTable, Project, RailTable, ToleranceTable
from isomould.settings import Settings

_TABLES: Mapping[str, type[Settings]] = {
    "rail": RailTable,
    "generatrix": GeneratrixTable,
    "surface": SurfaceSettings,
    "tolerances": ToleranceTable,
    "limits": LimitTable,
}
"""What the curves and their divisions depend on."""


def salvage(data: Mapping[str, Any]) -> Project | None:
    """Give a project of its tables about curves; None if one of them is missing or has a fault.

    All other tables have their defaults: nothing but curves and divisions may be made of it.
    """
    try:
        tables = {name: model.model_validate(data.get(name, {})) for name, model in _TABLES.items()}
    except ValidationError:
        return None
    make: Callable[..., Project] = Project.model_construct
    project = make(**tables)
    return None if list(project.kind_and_division()) else project
