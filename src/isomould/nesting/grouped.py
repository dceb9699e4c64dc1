"""Parts of several materials: every material is nested on sheets of its own, and the layouts make one."""

from collections.abc import Sequence
from dataclasses import replace

from isomould.nesting.assembly import yield_percent
from isomould.nesting.irregular import Nest, nest_parts
from isomould.nesting.layout import BoundKind, CutTree, Layout, Part, Placement, Sheet
from isomould.nesting.material import Material, group, share_out
from isomould.nesting.nest import prove
from isomould.nesting.placing import map_tree
from isomould.nesting.search import Search
from isomould.nesting.settings import SheetStock, StockSettings


def nest_materials(parts: Sequence[Part], stock: StockSettings, task: Search | None = None) -> Nest:
    """Nest parts on the stock sheets of their materials.

    Returns
    -------
    Nest
        Its layout is proved by `check_layout`; bounds are sums of those of the materials: no sheet may hold two. Where
        parts of one material lie in the hollows of others, no straight cuts are given for any sheet.

    Raises
    ------
    Refused
        E-NEST-13 if it is not known which sheet is for which material, and as `nest_parts`.
    """
    groups = group(parts, _material_of_part)
    wanted = [(material, sum(part.quantity for part in some)) for material, some in groups]
    shares = share_out(wanted, stock.sheets, _material_of_sheet, "sheet")
    nests = [
        nest_parts(some, stock.model_copy(update={"sheets": tuple(share)}), task or Search())
        for (_, some), share in zip(groups, shares, strict=True)
    ]
    uncut = any(nest.layout.no_cuts for nest in nests)
    used = stock if not uncut else stock.model_copy(update={"guillotine": False})
    layout = _joined([nest.layout for nest in nests])
    return Nest(prove(parts, used, layout), used, tuple(note for nest in nests for note in nest.notes))


def _material_of_part(part: Part) -> Material:
    return part.material


def _material_of_sheet(sheet: SheetStock) -> Material:
    return sheet.made_of


def _joined(layouts: Sequence[Layout]) -> Layout:
    """Make one layout of several, sheets numbered through."""
    if len(layouts) == 1:
        return layouts[0]
    digits = max(3, len(str(sum(len(layout.sheets) for layout in layouts))))
    sheets, placements, trees = list[Sheet](), list[Placement](), dict[str, CutTree]()
    for layout in layouts:
        names = {sheet.id: f"S{len(sheets) + k:0{digits}}" for k, sheet in enumerate(layout.sheets, start=1)}
        sheets += [replace(sheet, id=names[sheet.id]) for sheet in layout.sheets]
        trees |= {names[old]: map_tree(tree, _same, len(placements)) for old, tree in layout.cut_trees.items()}
        placements += [replace(item, sheet=names[item.sheet]) for item in layout.placements]
    uncut = [layout.no_cuts for layout in layouts if layout.no_cuts]
    unplaced = tuple(item for layout in layouts for item in layout.unplaced)
    return Layout(
        sheets=tuple(sheets),
        placements=tuple(placements),
        unplaced=unplaced,
        bound=sum(layout.bound for layout in layouts),
        bound_kind=_kind(layouts),
        price=sum(layout.price for layout in layouts),
        price_bound=sum(layout.price_bound for layout in layouts),
        yield_percent=yield_percent(sheets, placements),
        cut_trees={} if uncut else trees,
        no_cuts=next(iter(uncut), None),
        status="incomplete" if unplaced else "complete",
        reproducible=all(layout.reproducible for layout in layouts),
    )


def _kind(layouts: Sequence[Layout]) -> BoundKind:
    return "lp" if any(layout.bound_kind == "lp" for layout in layouts) else "area"


def _same(line: list[list[float]]) -> list[list[float]]:
    return line
