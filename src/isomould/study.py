"""Form finding: a design whose values are changed, one after another, to see what follows (paper §4.5)."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import reduce
from pathlib import Path
from typing import Any

from isomould.arrays import Floats
from isomould.design import Design, make_design
from isomould.documents.overview import Fact, kit_facts
from isomould.project.load import validate, with_value


@dataclass(frozen=True, eq=False)
class Study:
    """A design and the tables that it was made of; changing a value gives another study and leaves this one.

    Nothing is read again but drawings, nothing is cut to files, and all numbers are those of `check`.
    """

    tables: Mapping[str, Any]
    folder: Path
    design: Design

    @property
    def nodes(self) -> Floats:
        """The surface (parallels, generatrices, 3) in mm, before trimming."""
        return self.design.form.surface.V

    @property
    def facts(self) -> dict[str, float]:
        """Key figures by their names: counts, classes, mismatch in mm, as `check` prints them."""
        figures: tuple[Fact, ...] = kit_facts(self.design.kit)
        return {item: value for item, value, _ in figures}

    def with_changes(self, changes: Mapping[str, object]) -> "Study":
        """Change values by their dotted keys: `{"rail.curve.rise": "8 m"}`.

        Raises
        ------
        Refused
            If the project can no longer be made; this study stays as it is.
        """
        return make_study(
            reduce(lambda tables, item: with_value(tables, *item), changes.items(), self.tables), self.folder
        )


def make_study(tables: Mapping[str, Any], folder: Path) -> Study:
    """Compute the first shape of a project from its tables; `folder` is where its file references start."""
    own = {key: value for key, value in tables.items() if key != "shapes"}
    return Study(own, folder, make_design(validate(own, "project"), folder))
