"""Sheets that are cut alike: what holds for the first of them holds for all.

The checker takes nobody's word for it: two sheets are twins if every number on them is the same, and every part has
the same outline.
"""

from collections.abc import Hashable, Mapping
from dataclasses import replace
from typing import Any

from isomould.nesting.layout import CutTree, Id, Layout, Placement

Forms = Mapping[Id, Hashable]
"""What tells parts apart, by their names."""


def first_twins(layout: Layout, forms: Forms) -> dict[str, str]:
    """Give for every sheet the first that is like it, which may be itself.

    Parameters
    ----------
    forms
        Equal for parts that may stand for each other.
    """
    numbers = _numbers(layout)
    firsts = dict[Hashable, str]()
    found = dict[str, str]()
    for sheet in layout.sheets:
        own = numbers.get(sheet.id, [])
        ranks = {number: rank for rank, number in enumerate(own)}
        pieces = tuple(_piece(layout.placements[number], forms) for number in own)
        tree = _told(layout.cut_trees.get(sheet.id), ranks)
        found[sheet.id] = firsts.setdefault((sheet.stock, sheet.width, sheet.height, pieces, tree), sheet.id)
    return found


def _numbers(layout: Layout) -> dict[str, list[int]]:
    """Give the indices of the placements on every sheet."""
    numbers = dict[str, list[int]]()
    for number, item in enumerate(layout.placements):
        numbers.setdefault(item.sheet, []).append(number)
    return numbers


def _piece(item: Placement, forms: Forms) -> Hashable:
    points = item.points
    return forms.get(item.id), item.rotation_deg, item.turned_over, points.dtype.str, points.shape, points.tobytes()


def _told(tree: Any, ranks: Mapping[int, int]) -> Hashable:
    """Give a cut tree as a value, its placements counted from the first on their sheet."""
    if isinstance(tree, dict):
        table: CutTree = tree
        return tuple(
            (key, _rank(value, ranks) if key == "placement" else _told(value, ranks)) for key, value in table.items()
        )
    if isinstance(tree, list):
        return tuple([_told(value, ranks) for value in tree])
    return tree


def _rank(number: Any, ranks: Mapping[int, int]) -> Hashable:
    return ranks.get(number, ("on another sheet", number))


def without_twins(layout: Layout, firsts: Mapping[str, str]) -> Layout:
    """Give the layout with the first of every kind of sheet alone; its trees count the placements that are left."""
    kept = [number for number, item in enumerate(layout.placements) if firsts.get(item.sheet) == item.sheet]
    places = {number: place for place, number in enumerate(kept)}
    trees = layout.cut_trees.items()
    return replace(
        layout,
        sheets=tuple(sheet for sheet in layout.sheets if firsts[sheet.id] == sheet.id),
        placements=tuple(layout.placements[number] for number in kept),
        cut_trees={key: _renumbered(tree, places) for key, tree in trees if firsts.get(key, key) == key},
    )


def _renumbered(tree: CutTree, places: Mapping[int, int]) -> CutTree:
    """Number the placements anew; one that is not on a sheet that is left gets the number -1, which none has."""
    renumbered = dict(tree)
    if "placement" in tree:
        renumbered["placement"] = places.get(tree["placement"], -1)
    if isinstance(tree.get("pieces"), list):
        renumbered["pieces"] = [_renumbered(piece, places) for piece in tree["pieces"]]
    return renumbered
