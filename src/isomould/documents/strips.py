"""Unrolled strips as drawings and as a table (paper §3.1)."""

from collections.abc import Sequence

import numpy as np

from isomould.documents.cut_sheets import part_drawing
from isomould.documents.drawing import CutDrawing, Polyline
from isomould.documents.table import Table, make_table
from isomould.parts.outline import area, round_outline
from isomould.parts.strips import Strip


def strip_drawing(strip: Strip) -> CutDrawing:
    """Draw the outline to cut and the fold lines to engrave."""
    drawing = part_drawing(strip.name, round_outline(strip.outline))
    folds = [Polyline("ENGRAVE", np.round(fold, 3) + 0.0, closed=False) for fold in strip.folds]
    return CutDrawing((*drawing.entities, *folds))


def strip_table(strips: Sequence[Strip]) -> Table:
    """Give one row per strip: its length and width as it lies flat, and how much it bends."""
    outlines = [round_outline(strip.outline) for strip in strips]
    middles = [(strip.left + strip.right) / 2 for strip in strips]
    widths = [np.linalg.norm(strip.left - strip.right, axis=1).max() for strip in strips]
    data = {
        "strip": [strip.name for strip in strips],
        "along": [strip.along for strip in strips],
        "pieces": [len(strip.left) - 1 for strip in strips],
        "length_mm": [float(np.linalg.norm(np.diff(middle, axis=0), axis=1).sum()) for middle in middles],
        "width_mm": [float(width) for width in widths],
        "sagitta_mm": [strip.sagitta for strip in strips],
        "area_m2": [area(outline) / 1e6 for outline in outlines],
        "file": [f"strips/{strip.name}.dxf" for strip in strips],
    }
    return make_table("strips", data)
