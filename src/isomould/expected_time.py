"""What the stages of a build are expected to take, by what is to be made, so that the time left can be told."""

from collections.abc import Mapping, Sequence

from isomould.delivery.stages import (
    CERTIFICATE,
    DESIGN,
    DRAWING_FILES,
    DRAWINGS,
    MODELS,
    NESTING,
    PART_FILES,
    SCHEDULES,
    SHEETS,
    SOLIDS,
)
from isomould.design import Design
from isomould.progress import Stage, stage_name
from isomould.project.schema import MAIN

_SECONDS: Mapping[str, tuple[float, float, float, float]] = {
    DESIGN: (0.3, 0.0, 0.0, 0.0002),
    SOLIDS: (0.0, 0.12, 0.0, 0.0),
    NESTING: (0.5, 0.0, 0.0, 0.014),
    PART_FILES: (0.0, 0.0, 0.011, 0.0),
    SHEETS: (0.0, 0.0, 0.0, 0.006),
    MODELS: (0.1, 0.01, 0.0, 0.0002),
    SCHEDULES: (0.3, 0.0, 0.0, 0.0025),
    DRAWINGS: (0.2, 0.01, 0.016, 0.0),
    DRAWING_FILES: (0.3, 0.01, 0.032, 0.0),
    CERTIFICATE: (2.0, 0.0, 0.05, 0.022),
}
"""Seconds of every stage, more for a node class, for a class of members or panels, and for a panel: measured on the
template `barrel-vault` (14 node classes, 221 others, 627 panels). A slower machine changes all of them alike."""


def name_stages(shapes: Sequence[str], names: Sequence[str]) -> tuple[Stage, ...]:
    """Give the stages in their order before anything is known of the shapes."""
    return (Stage(DESIGN), *(Stage(stage_name(_prefix(shape), name)) for shape in shapes for name in names))


def expect_stages(designs: Mapping[str, Design], names: Sequence[str]) -> tuple[Stage, ...]:
    """Give the same stages with the seconds that they are expected to take; the first shape is built last."""
    shapes = [*(shape for shape in designs if shape != MAIN), MAIN]
    own = [
        Stage(stage_name(_prefix(shape), name), _seconds(name, designs[shape])) for shape in shapes for name in names
    ]
    return (Stage(DESIGN, sum(_seconds(DESIGN, design) for design in designs.values())), *own)


def _prefix(shape: str) -> str:
    return "" if shape == MAIN else shape


def _seconds(name: str, design: Design) -> float:
    kit = design.kit
    nodes, classes = len(kit.nodes.marks), len(kit.members.marks) + len(kit.panels.marks)
    fixed, per_node, per_class, per_panel = _SECONDS[name]
    return fixed + per_node * nodes + per_class * classes + per_panel * len(kit.panels.locations)
