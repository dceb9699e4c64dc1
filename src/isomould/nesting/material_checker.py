"""Proves that no sheet holds parts of two materials, and that every sheet is of what the stock and its parts say."""

from collections.abc import Iterator, Sequence

from isomould.nesting.layout import Layout, Part
from isomould.nesting.material import NAMES, Material
from isomould.nesting.settings import StockSettings

Fault = tuple[str, str, str, str]
"""Code, place, what was found, limit."""


def material_faults(parts: Sequence[Part], stock: StockSettings, layout: Layout) -> Iterator[Fault]:
    """Hold every part, and the stock, to what its sheet is made of, field by field."""
    made_of, rack = {part.id: part.material for part in parts}, {kind.name: kind.made_of for kind in stock.sheets}
    sheets = {sheet.id: sheet for sheet in layout.sheets}
    for sheet in layout.sheets:
        for name in _differing(rack.get(sheet.stock, Material()), sheet.material):
            yield "N-MATERIAL-01", f"sheet {sheet.id}", str(sheet.material), f"the {name} of {sheet.stock}"
    for item in layout.placements:
        for name in _differing(made_of[item.id], sheets[item.sheet].material):
            where = f"part {item.id} on {item.sheet}"
            yield "N-MATERIAL-02", where, f"a sheet of {sheets[item.sheet].material}", f"{name} of {made_of[item.id]}"


def _differing(said: Material, sheet: Material) -> Iterator[str]:
    """Give the fields that are said and are not those of a sheet."""
    for name, mine, its in zip(NAMES, said.key, sheet.key, strict=True):
        if mine not in ("", None) and mine != its:
            yield name
