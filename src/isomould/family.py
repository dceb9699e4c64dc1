"""The shapes of one project: parallel meshes that are made of one kit of nodes (paper §3.5, Fig. 11)."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from isomould.arrays import Floats
from isomould.design import Design, kit_settings, make_design
from isomould.documents.table import Table, make_table
from isomould.errors import Attempt, Gathering, Note, Refused
from isomould.form.mesh import NodeKind
from isomould.form.survey import node_angles
from isomould.parts.details import share_sizes
from isomould.parts.kit import make_kit, standing
from isomould.parts.sharing import share_nodes
from isomould.project.load import LoadedProject
from isomould.project.schema import MAIN, Project

Designs = Mapping[str, Design]
"""Designs by the names of their shapes, "main" first."""

_TURN = 2 * np.pi


def make_designs(loaded: LoadedProject) -> dict[str, Design]:
    """Compute the shapes of a project: one design, or several that share their node classes and marks.

    Raises
    ------
    Refused
        If a shape cannot be made, or its angles or slopes are not those of the first one.
    """
    with Gathering() as faults:
        main = faults.run(make_design, loaded.project, loaded.folder)
        shapes = try_shapes(loaded, faults)
        return one_kit({MAIN: main.value, **{name: shape.value for name, shape in shapes.items()}})


def try_shapes(loaded: LoadedProject, faults: Gathering) -> dict[str, Attempt[Design]]:
    """Compute the other shapes of a project, each by itself; `faults` gathers what ends them, with their names."""
    return {name: faults.run(_make_shape, name, project, loaded.folder) for name, project in loaded.shapes}


def one_kit(designs: Designs) -> dict[str, Design]:
    """Give shapes node classes and marks in common; a single one keeps its own.

    Raises
    ------
    Refused
        If the angles or slopes of a shape are not those of the first one.
    """
    if len(designs) == 1:
        return dict(designs)
    with Gathering() as faults:
        for name in designs:
            faults.run(_refuse_other_angles, designs, name)
            faults.run(_refuse_other_slopes, designs, name)
    return _with_one_kit(designs)


def _make_shape(name: str, project: Project, folder: Path) -> Design:
    try:
        return make_design(project, folder)
    except Refused as refused:
        raise refused.within(f"shapes ({name})") from None


def _refuse_other_angles(designs: Designs, name: str) -> None:
    """Hold all rails to the turning angles of the first one, flat nodes apart."""
    wanted, found = (_turning(designs[each]) for each in (MAIN, name))
    tolerance = designs[MAIN].project.tolerances.angle_deg
    if len(wanted) == len(found) and np.allclose(wanted, found, rtol=0.0, atol=tolerance):
        return
    raise Refused(
        "E-SHAPE-ANGLE",
        f"shapes ({name}): rail.divide",
        f"the rail turns by {_listed(found)} at its nodes",
        f"the turning angles of the first shape, {_listed(wanted)}, within tolerances.angle_deg = {tolerance:g}°",
        f"Give all rails one angle: rail.divide = {{angle_deg = {wanted[0]:g}}}.",
    )


def _turning(design: Design) -> Floats:
    """Give the angles (k,) in degrees by which a rail turns, ascending."""
    angles = np.degrees(np.sort(node_angles(design.form.rail)[0]))
    return angles[angles > 0]


def _listed(angles: Floats) -> str:
    return ", ".join(f"{angle:.4f}°" for angle in angles[:3]) + (" …" if len(angles) > 3 else "")


def _refuse_other_slopes(designs: Designs, name: str) -> None:
    """Hold the edges of all profiles to the directions of the first one, wherever both have some."""
    first, other = (designs[each].form.generatrix.edges.direction for each in (MAIN, name))
    tolerance = designs[MAIN].project.tolerances.angle_deg
    found, nearest = max(_odd_slope(first, other), _odd_slope(other, first), key=lambda pair: abs(pair[0] - pair[1]))
    if abs(found - nearest) <= tolerance:
        return
    raise Refused(
        "E-SHAPE-PHASE",
        f"shapes ({name}): generatrix.divide",
        f"an edge of one profile runs at {found:.4f}°, and the nearest edge of the other at {nearest:.4f}°",
        f"the same directions in both, within tolerances.angle_deg = {tolerance:g}°",
        "Divide all generatrices by one angle_deg and first_deg, or by one phase.",
    )


def _odd_slope(own: Floats, other: Floats) -> tuple[float, float]:
    """Give the direction (degrees) that is farthest from all of another profile's, among those that it spans; both."""
    turned = own + _TURN * np.array([-1, 0, 1])[:, None]
    spanned = turned[(turned >= other.min()) & (turned <= other.max())]
    if len(spanned) == 0:
        return 0.0, 0.0
    distance = abs(spanned[:, None] - other)
    odd = int(distance.min(axis=1).argmax())
    return float(np.degrees(spanned[odd])), float(np.degrees(other[distance[odd].argmin()]))


def _with_one_kit(designs: Designs) -> dict[str, Design]:
    """Make the parts of all shapes anew, their nodes sorted together, with drums that suit all of them."""
    meshes = [design.kit.mesh for design in designs.values()]
    settings = kit_settings(designs[MAIN].project)
    sizes = share_sizes([design.kit.nodes for design in designs.values()], settings.members, settings.nodes)
    settings = replace(settings, nodes=sizes)
    up = [standing(design.kit.mesh, kit_settings(design.project)) for design in designs.values()]
    shared = share_nodes(meshes, settings.tolerance, up)
    kits = [make_kit(mesh, settings, nodes) for mesh, nodes in zip(meshes, shared, strict=True)]
    made = {name: replace(design, kit=kit) for (name, design), kit in zip(designs.items(), kits, strict=True)}
    note = _own_classes(kit_table(made))
    return {name: replace(design, notes=(*design.notes, *note)) for name, design in made.items()}


def kit_table(designs: Designs) -> Table:
    """Give the nodes of all shapes: one row per class, its quantity in every shape, and whether all have it."""
    rows = {mark: k for design in designs.values() for mark, k in zip(*_marked(design), strict=True)}
    counts = {name: _quantities(design) for name, design in designs.items()}
    marks = sorted(rows)
    each = {f"quantity_{name.replace('-', '_')}": [of.get(mark, 0) for mark in marks] for name, of in counts.items()}
    return make_table(
        "kit",
        {
            "mark": marks,
            "kind": [rows[mark] for mark in marks],
            "quantity": [sum(numbers) for numbers in zip(*each.values(), strict=True)],
            **each,
            "shared": [all(numbers) for numbers in zip(*each.values(), strict=True)],
        },
    )


def _marked(design: Design) -> tuple[tuple[str, ...], list[str]]:
    nodes = design.kit.nodes
    return nodes.marks, [NodeKind(kind).word for kind in nodes.kind]


def _quantities(design: Design) -> dict[str, int]:
    nodes = design.kit.nodes
    return dict(zip(nodes.marks, nodes.classes.quantity.tolist(), strict=True))


def _own_classes(table: Table) -> tuple[Note, ...]:
    """Say which classes not all shapes have; refuse a family that has no regular node in common."""
    inner = table.frame["kind"] == NodeKind.INTERIOR.word
    if not (inner & table.frame["shared"]).any():
        limit = "at least one class of regular inner nodes that all shapes use"
        way_out = "Draw the curves so that they turn the same way, or build the shapes as projects of their own."
        raise Refused("E-SHAPE-KIT", "shapes", f"none of {inner.sum()} classes is in all shapes", limit, way_out)
    own = table.frame[~table.frame["shared"].astype(bool)]
    named = ", ".join(f"{mark} ({kind})" for mark, kind in zip(own["mark"], own["kind"], strict=True))
    text = f"{len(own)} of {len(table.frame)} node classes are not in every shape: {named}"
    return (Note("W-SHAPE-OWN", "shapes", text),) if len(own) else ()
