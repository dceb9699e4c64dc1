"""Reading a part list to say what is in it: flat parts or members."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import shapely

from isomould.intake.inspection import ReadList
from isomould.intake.member_list import lists_members, read_member_list
from isomould.intake.read import Asked, read_part_list
from isomould.nesting.layout import Part

_LARGE = 1e6
_ANY_SHEETS = {"sheets": [{"name": "any", "width": _LARGE, "height": _LARGE}], "gap": 0.0, "trim": 0.0}
_ANY_BARS = {"bars": [{"section": "any", "length": _LARGE}]}
"""Readers of lists want stock, because `nest` does; what is read of the parts does not depend on it."""


def inspect_list(path: Path, asked: Asked) -> ReadList:
    """Say what is read of a part list, as `nest` reads it.

    Raises
    ------
    Refused
        Naming file, field, what was found, the limit, and a way out.
    OutputFault
        If a file cannot be read.
    """
    if lists_members(path, asked.reading):
        members, remarks = read_member_list(path, _ANY_BARS, asked.reading)
        return ReadList(str(path), tuple(_member(member) for member in members.members), remarks)
    given = read_part_list(path, replace(asked, stock=_ANY_SHEETS))
    return ReadList(str(path), tuple(_part(part) for part in given.instance.parts), given.notes)


def _part(part: Part) -> dict[str, Any]:
    width, height = np.ptp(part.outline, axis=0).tolist()
    return {
        "id": part.id,
        "quantity": part.quantity,
        "width_mm": round(width, 3),
        "height_mm": round(height, 3),
        "area_mm2": round(float(shapely.Polygon(part.outline, part.holes).area), 1),
        "corners": len(part.outline),
        "holes": len(part.holes),
    }


def _member(member: Any) -> dict[str, Any]:
    return {
        "id": member.id,
        "quantity": member.quantity,
        "section": member.section,
        "length_mm": round(member.length, 3),
    }
