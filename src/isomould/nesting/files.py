"""Layouts as JSON: `nesting.json` of a delivered folder, and what `isomould nest` writes."""

import json
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

import numpy as np

from isomould.arrays import read_only
from isomould.errors import Refused
from isomould.nesting.layout import BarLayout, Layout, Offcut, Placement, Sheet, Unplaced
from isomould.nesting.material import NAMES, Material

SCHEMA = 1
NOTHING_MORE: Mapping[str, Any] = MappingProxyType({})

_PLAIN = (
    "bound",
    "bound_kind",
    "pattern_bound",
    "price",
    "price_bound",
    "yield_percent",
    "yield_with_offcut_percent",
    "cuts",
    "status",
    "reproducible",
)
"""Fields that are the same in the file."""


def layout_to_json(layout: Layout, more: Mapping[str, Any] = NOTHING_MORE) -> str:
    """Write a layout, and more fields behind its own; numbers as short as they read back exactly."""
    table = {
        "schema": SCHEMA,
        "status": layout.status,
        "reproducible": layout.reproducible,
        "sheets": [_sheet(sheet) for sheet in layout.sheets],
        "bound": layout.bound,
        "bound_kind": layout.bound_kind,
        "gap_to_bound": layout.gap_to_bound,
        "pattern_bound": layout.pattern_bound,
        "price": layout.price,
        "price_bound": layout.price_bound,
        "yield_percent": layout.yield_percent,
        "yield_with_offcut_percent": layout.yield_with_offcut_percent,
        "offcut": vars(layout.offcut) if layout.offcut else None,
        "cuts": layout.cuts,
        "cut_length_mm": layout.cut_length,
        "placements": [_placement(item) for item in layout.placements],
        "unplaced": [_unplaced(item) for item in layout.unplaced],
        "cut_tree": layout.cut_trees or None,
        "cut_tree_reason": layout.no_cuts,
        **more,
    }
    return json.dumps(table, ensure_ascii=False, allow_nan=False) + "\n"


def bars_to_json(layout: BarLayout, more: Mapping[str, Any] = NOTHING_MORE) -> str:
    """Write a layout of bars, and more fields behind its own."""
    table = {
        "schema": SCHEMA,
        "kind": "bars",
        "status": layout.status,
        "reproducible": layout.reproducible,
        "bars": [{**vars(bar), "cuts": [vars(cut) for cut in bar.cuts]} for bar in layout.bars],
        "bound": layout.bound,
        "bounds": layout.bounds,
        "bound_kind": layout.bound_kind,
        "gap_to_bound": layout.gap_to_bound,
        "price": layout.price,
        "price_bound": layout.price_bound,
        "unplaced": [_unplaced(item) for item in layout.unplaced],
        **more,
    }
    return json.dumps(table, ensure_ascii=False, allow_nan=False) + "\n"


def _sheet(sheet: Sheet) -> dict[str, Any]:
    return {"id": sheet.id, "stock": sheet.stock, "width": sheet.width, "height": sheet.height, **said(sheet.material)}


def said(material: Material) -> dict[str, Any]:
    """Give what is said of a material, nothing of what is not."""
    return {name: value for name in NAMES if (value := getattr(material, name)) not in ("", None)}


def _placement(item: Placement) -> dict[str, Any]:
    return {**vars(item), "points": item.points.tolist()}


def _unplaced(item: Unplaced) -> dict[str, Any]:
    return {**vars(item), "needs": list(item.needs)}


def layout_from_json(text: str) -> Layout:
    """Read a layout back.

    Raises
    ------
    Refused
        If the text is not a layout of this schema.
    """
    try:
        return _layout(json.loads(text))
    except (ValueError, KeyError, TypeError, AttributeError) as fault:
        found = f"{type(fault).__name__}: {fault}"
        raise Refused("E-NEST-12", "layout", found, "a layout of schema 1", "Nest the parts again.") from fault


def _layout(table: dict[str, Any]) -> Layout:
    if table["schema"] != SCHEMA:
        message = f"schema {table['schema']!r}"
        raise ValueError(message)
    return Layout(
        sheets=tuple(_read_sheet(sheet) for sheet in table["sheets"]),
        placements=tuple(_read_placement(item) for item in table["placements"]),
        unplaced=tuple(_read_unplaced(item) for item in table["unplaced"]),
        cut_trees=table["cut_tree"] or {},
        no_cuts=table.get("cut_tree_reason"),
        cut_length=table["cut_length_mm"],
        offcut=Offcut(**table["offcut"]) if table["offcut"] else None,
        **{key: table[key] for key in _PLAIN},
    )


def _read_sheet(table: dict[str, Any]) -> Sheet:
    material = Material(**{name: table[name] for name in NAMES if name in table})
    return Sheet(table["id"], table["stock"], table["width"], table["height"], material)


def _read_placement(item: dict[str, Any]) -> Placement:
    points = np.array(item["points"], dtype=np.float64).reshape(-1, 2)
    values: dict[str, Any] = {**item, "points": read_only(points)}
    return Placement(**values)


def _read_unplaced(item: dict[str, Any]) -> Unplaced:
    width, height = item["needs"]
    values: dict[str, Any] = {**item, "needs": (width, height)}
    return Unplaced(**values)
