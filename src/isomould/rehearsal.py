"""Everything that a build may refuse without a search and without files: what `check` says is what `build` does.

Independent refusals are gathered over all stages and come together, in the order of the data: file, curves,
surface, details, parts, stock. A build rehearses too before it begins to search.
"""

from collections.abc import Callable, Sequence

from isomould.comparison import planar_rail_of
from isomould.cutting import member_parts, panel_parts, refuse_bars, refuse_sheets, refuse_stock
from isomould.design import Design, Sketch, TriedDesign, kit_settings, try_design
from isomould.errors import Attempt, Gathering, Refused
from isomould.family import one_kit, try_shapes
from isomould.nesting.settings import StockSettings
from isomould.parts.building import make_shapes
from isomould.parts.clash import refuse_clashes
from isomould.parts.panel_sizes import measure_panels, refuse_panel_sizes
from isomould.parts.panels import PanelParts
from isomould.parts.plates import Shape
from isomould.parts.strips import unroll_strips
from isomould.project.load import LoadedProject
from isomould.project.schema import MAIN, Project
from isomould.writers.parquet import require_parquet

Refusing = Callable[[Design], None]
"""Holds a design against something, and refuses it or does nothing."""


def refuse_all_clashes(design: Design, bodies: Sequence[Shape]) -> None:
    """Refuse parts that take each other's space, as a build does with solids that are measured too."""
    kit, settings = design.kit, kit_settings(design.project)
    refuse_clashes(kit, settings, make_shapes(kit, settings, bodies))


def rehearse(loaded: LoadedProject, further: Refusing = lambda design: None) -> dict[str, Design]:
    """Compute the shapes of a project, and refuse together what a build would refuse before it searches.

    `further` is asked of every design that can be made.

    Raises
    ------
    Refused
        All of it, the gravest first.
    """
    with Gathering() as faults:
        if loaded.project.deliver.parquet:
            faults.run(require_parquet)
        main = try_design(loaded.project, loaded.folder, faults)
        shapes = try_shapes(loaded, faults)
        if not shapes:
            faults.run(lambda: _refuse_extras(main.sketch.value, loaded.project))
            _try_stock(main, faults)
        designs = faults.run(
            lambda: one_kit({MAIN: main.design, **{name: shape.value for name, shape in shapes.items()}})
        )
        # Of a single shape stock and extras were asked above, even where its parts are not all made.
        asked = [_refuse_own_extras, _refuse_stock, further] if shapes else [further]
        for name in (MAIN, *shapes):
            for refuse in asked:
                faults.run(_ask, name, refuse, designs)
        return designs.value


def _refuse_extras(drawn: Sketch | Design, project: Project) -> None:
    """Refuse what is asked for beside the parts and suits the surface not."""
    with Gathering() as faults:
        if project.deliver.compare:
            faults.run(planar_rail_of, drawn.rail, drawn.form, project)
        for along in project.deliver.strips:
            faults.run(unroll_strips, drawn.mesh, along)


def _try_stock(design: TriedDesign, faults: Gathering) -> None:
    """Hold panels and members against the stock, each as far as they can be made."""
    stock = design.project.stock or StockSettings()
    faults.run(lambda: refuse_sheets(panel_parts(design.parts.value.panels.value, design.parts.value.mesh), stock))
    faults.run(lambda: refuse_bars(member_parts(design.parts.value.members.value), stock))
    faults.run(lambda: _refuse_sizes(design.parts.value.panels.value, design.project))


def _refuse_stock(design: Design) -> None:
    """Hold the parts of a shape against the stock: nodes in common have changed its members."""
    with Gathering() as faults:
        faults.run(refuse_stock, design.kit, design.project.stock or StockSettings())
        faults.run(_refuse_sizes, design.kit.panels, design.project)


def _refuse_sizes(panels: PanelParts, project: Project) -> None:
    """Hold panels against the limits of the project."""
    refuse_panel_sizes(measure_panels(panels, project.panels), project.limits)


def _refuse_own_extras(design: Design) -> None:
    _refuse_extras(design, design.project)


def _ask(shape: str, refuse: Refusing, designs: Attempt[dict[str, Design]]) -> None:
    """Ask something of a shape; refusals of other shapes than the main one say which."""
    design = designs.value[shape]
    try:
        refuse(design)
    except Refused as refused:
        raise (refused if shape == MAIN else refused.within(f"shapes ({shape})")) from None
