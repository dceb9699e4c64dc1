"""What `check` does: a file is read, rehearsed as a build would, and what it comes to is said.

Each room is imported when it is reached: a file that cannot be read is refused before any numerics are loaded.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from isomould.errors import Attempt, Gathering, Refused
from isomould.progress import Course, Stage, Tell, tell_nobody
from isomould.project.load import LoadedProject, load_project, read_tables
from isomould.running import Checked
from isomould.writers.names import safe_name

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from isomould.design import Design
    from isomould.parts.plates import Shape

_DESIGN, _SOLIDS = "curves, surface, parts", "node solids and clashes"
_STAGES = (Stage(_DESIGN), Stage(_SOLIDS))


def check_file(path: Path, changes: Sequence[str], progress: Tell = tell_nobody) -> Checked:
    """Read a project, compute its shapes as a build does up to the search, and say what they come to.

    Of a file with faults the curves are tried all the same if it describes them well.

    Raises
    ------
    Refused
        All that a build would refuse, together.
    """
    with Gathering() as faults:
        loaded = faults.run(load_project, path, changes)
        if loaded.refused:
            faults.run(_try_salvaged, path, changes, faults)
        faults.run(lambda: safe_name(loaded.value.project.project.name))
        bodies: dict[str, tuple[Shape, ...]] = {}
        designs = faults.run(lambda: _rehearsed(loaded, bodies, Course(_STAGES, progress)))
        return _checked(loaded.value, designs.value, bodies)


def _try_salvaged(path: Path, changes: Sequence[str], faults: Gathering) -> None:
    """Draw and divide the curves of a file that has faults elsewhere; what cannot be read was told already."""
    try:
        tables = read_tables(path, changes)
    except Refused:
        return

    from isomould.project.salvage import salvage

    project = salvage(tables)
    if project is not None:
        from isomould.design import try_curves

        try_curves(project, path.resolve().parent, faults)


def _rehearsed(
    loaded: Attempt[LoadedProject], bodies: dict[str, tuple[Shape, ...]], course: Course
) -> dict[str, Design]:
    """Rehearse a build; the surfaces of nodes, which clashes are measured on, are kept by the design's name."""
    project = loaded.value  # ends here if there is none

    from isomould.parts.solid import make_bodies
    from isomould.rehearsal import refuse_all_clashes, rehearse

    def further(design: Design) -> None:
        told = course.begin(_SOLIDS)
        made = bodies[design.name] = make_bodies(design.kit.nodes, design.kit.joints, told)
        refuse_all_clashes(design, made)

    course.begin(_DESIGN)
    return rehearse(project, further)


def _checked(loaded: LoadedProject, designs: dict[str, Design], bodies: dict[str, tuple[Shape, ...]]) -> Checked:
    """Say what the shapes of a project come to; facts and figures are those of the first."""
    from isomould.design import requests_of
    from isomould.documents.overview import kit_facts
    from isomould.family import kit_table
    from isomould.form.survey import survey
    from isomould.project.schema import MAIN
    from isomould.sizing import size_design

    design = designs[MAIN]
    sized = size_design(design, bodies[design.name])
    curves, polygons = (design.rail.curve, design.generatrix), (design.form.rail, design.form.generatrix)
    return Checked(
        design=design,
        facts=kit_facts(design.kit),
        divisions=tuple(map(survey, curves, polygons, requests_of(loaded.project))),
        notes=(*loaded.notes, *design.notes, *sized.notes),
        kit=kit_table(designs) if loaded.shapes else None,
        figures=sized.figures,
    )
