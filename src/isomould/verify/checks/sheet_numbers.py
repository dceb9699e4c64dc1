"""V45c, V45e: numbers on shop drawings are scheduled or measured in the part files, and none is left out."""

import re
from collections.abc import Iterable, Iterator
from itertools import count, takewhile
from typing import Any

import numpy as np

from isomould.verify.checks.sheets import KINDS, NUMBER, books_of, class_sheets
from isomould.verify.delivery import Delivery
from isomould.verify.read.dxf import Drawing, Entity, one_outline, outlines_on
from isomould.verify.read.pdf import Sheet
from isomould.verify.read.tables import texts
from isomould.verify.rules import Floats, Measured, NotApplicable, Rule, faults

_ALONE = re.compile(r"Ø?(-?\d+(?:\.\d+)?)°?")
"""A text that is a number and no more: a dimension, or a value of a table."""
_SCALE = re.compile(r"[\d.]+:[\d.]+(?: \([\d.]+:[\d.]+\))?")
_DECIMALS = 3
_PRINTED = 0.6e-3
"""How far a printed number may lie from what is measured: half a unit of its last digit, mm or degrees."""


def explained(delivery: Delivery) -> Measured:
    """Every dimension, and every number with decimals, is scheduled, asked for, or measured in a part file."""
    problems, total = list[str](), 0
    for kind in KINDS:
        asked = _numbers([*_asked(delivery), *_on_all_sheets(delivery, kind)]) | _set_backs(delivery, kind)
        for sheet, row in class_sheets(delivery, kind):
            shown = _shown(sheet)
            known = asked | _numbers([*row.values(), _outline_text(delivery, kind, sheet.name)]) | _counted(sheet)
            strange = shown - known and shown - known - _measured(_part_files(delivery, kind, sheet.name))
            problems += [f"{sheet.name}: {text} is in no schedule" for text in sorted(strange)]
            total += len(shown)
    return faults(total, problems)


def _shown(sheet: Sheet) -> set[str]:
    own = _own_texts(sheet)
    return {number for number in _numbers(own) if "." in number} | {m[1] for m in map(_ALONE.fullmatch, own) if m}


def _own_texts(sheet: Sheet) -> list[str]:
    return [text for text in sheet.texts if not _SCALE.fullmatch(text)]


def _numbers(found: Iterable[str]) -> set[str]:
    return {number for text in found for number in NUMBER.findall(text)}


def _counted(sheet: Sheet) -> set[str]:
    """Numbers of arms, holes and corners, which a table lists from 1 on without a gap."""
    lists, known = {"Arm", "Hole", "Corner"} & set(sheet.texts), set(sheet.texts)
    return set(takewhile(known.__contains__, map(str, count(1)))) if lists else set()


def _asked(delivery: Delivery) -> Iterator[str]:
    """Print what the project asked for of its parts, and what follows from that in slots and grooves."""
    raw = delivery.design.raw
    yield from (text for part in ("member", "panel", "node") for text in _values(raw[part]))
    node, sections = raw["node"], raw["member"]["sections"].values()
    yield from (_text(s["thickness"] + node.get("slot_clearance_mm", 0)) for s in sections if s["kind"] == "plate")
    if cap := node.get("cap"):
        inner, outer = cap["lip_inner"] - cap["clearance"], cap["lip_outer"] + cap["clearance"]
        yield from map(_text, (2 * inner, 2 * outer, cap["lip_height"] + cap["clearance"]))


def _values(value: Any) -> Iterator[str]:
    """Give the numbers and texts of nested tables and lists."""
    if isinstance(value, dict):
        yield from (text for key, inner in value.items() for text in (str(key), *_values(inner)))
    elif isinstance(value, list):
        yield from (text for inner in value for text in _values(inner))
    elif value is not None:
        yield _text(value) if isinstance(value, float | int) else str(value)


def _set_backs(delivery: Delivery, kind: str) -> set[str]:
    """Set-backs of all members, which stand in the tables of arms."""
    columns = ("set_back_start_mm", "set_back_end_mm") if kind == "nodes" else ()
    return {text for column in columns for text in texts(delivery.table("members"), column)}


def _on_all_sheets(delivery: Delivery, kind: str) -> set[str]:
    """Give the texts of the title block and of notes: those that all sheets of a book share, if it has several."""
    books = books_of(delivery)
    own = [set(sheet.texts) for sheet in books[kind].sheets]
    every = [set(sheet.texts) for name in KINDS for sheet in books[name].sheets]
    return set.intersection(*every) | (set.intersection(*own) if len(own) > 1 else set())


def _outline_text(delivery: Delivery, kind: str, mark: str) -> str:
    """Give the corners of a trimmed panel as the schedule prints them."""
    table = delivery.table(kind)
    return texts(table, "outline")[texts(table, "mark").index(mark)] if "outline" in table.columns else ""


def _part_files(delivery: Delivery, kind: str, mark: str) -> list[Drawing]:
    """Give the drawings of a part: one of members and panels; plan, base plate and stem of nodes."""
    if kind == "nodes":
        names = (mark, f"{mark}-drum", f"{mark}-stem")
        return [delivery.node_drawings[name] for name in names if name in delivery.node_drawings]
    found = {"members": delivery.members, "panels": delivery.panels}[kind]
    return [found[mark]] if mark in found else []


def _measured(drawings: Iterable[Drawing]) -> set[str]:
    return {_text(value) for drawing in drawings for value in _measures(drawing)}


def _measures(drawing: Drawing) -> Floats:
    """Measure a part: coordinates, distances along both axes and between points, angles, holes."""
    outline = np.vstack([found.points for found in outlines_on(drawing, "CUT")])
    slots = [hole.points for hole in outlines_on(drawing, "CUT_INNER")]
    points = np.vstack([outline, *_middles(drawing)])
    between = points[:, None] - points[None]
    sizes = [size for slot in slots for size in (*np.ptp(slot, axis=0), abs(np.diff(np.ptp(slot, axis=0)))[0])]
    lengths = [points, between, np.hypot(between[..., 0], between[..., 1]), _diameters(drawing), sizes]
    return np.concatenate([np.ravel(values) for values in (*lengths, _angles(outline))])


def _middles(drawing: Drawing) -> list[Floats]:
    """Give the middles of slots and drilled holes."""
    slots = [hole.points for hole in outlines_on(drawing, "CUT_INNER")]
    return [(slot.min(axis=0) + slot.max(axis=0)) / 2 for slot in slots] + [
        np.array(circle.points[0][:2]) for circle in _drilled(drawing)
    ]


def _drilled(drawing: Drawing) -> list[Entity]:
    return [entity for entity in drawing.entities if entity.layer == "DRILL"]


def _diameters(drawing: Drawing) -> list[float]:
    return [2 * circle.radius for circle in _drilled(drawing)]


def _angles(points: Floats) -> Floats:
    ahead, behind = np.roll(points, -1, axis=0) - points, np.roll(points, 1, axis=0) - points
    size = np.linalg.norm(ahead, axis=1) * np.linalg.norm(behind, axis=1)
    cosine = (ahead * behind).sum(axis=1) / np.maximum(size, 1e-12)
    return np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)))


def _text(value: float) -> str:
    """Print a number as the schedules do: three decimals, no trailing zeros; snapped first, as they are (E5)."""
    return f"{round(round(float(value), 6), _DECIMALS) + 0.0:.{_DECIMALS}f}".rstrip("0").rstrip(".")


def complete(delivery: Delivery) -> Measured:
    """Sides, diagonals and angles of trimmed panels, and places and diameters of holes, stand on their sheets."""
    problems, total = list[str](), 0
    for kind, needs in (("members", _holes), ("panels", _corners)):
        for sheet, row in class_sheets(delivery, kind):
            printed = np.array([float(m[1]) for m in map(_ALONE.fullmatch, _own_texts(sheet)) if m])
            for drawing in _part_files(delivery, kind, sheet.name):
                wanted = needs(drawing, row)
                absent = [value for value in wanted if abs(printed - value).min() > _PRINTED]
                problems += [f"{sheet.name}: {_text(value)} is not on its sheet" for value in absent]
                total += len(wanted)
    if not total:
        raise NotApplicable("no part has holes or an outline of its own")
    return faults(total, problems)


def _holes(drawing: Drawing, _: dict[str, str]) -> list[float]:
    """Places of the holes along the part from its start, and diameters of those that are drilled."""
    start = min(float(outline.points[:, 0].min()) for outline in outlines_on(drawing, "CUT"))
    return [*(float(middle[0]) - start for middle in _middles(drawing)), *_diameters(drawing)]


def _corners(drawing: Drawing, row: dict[str, str]) -> list[float]:
    """Measures of a panel whose sides are not scheduled."""
    if "side_a_mm" in row:
        return []
    outline = one_outline(drawing).points
    sides = np.linalg.norm(np.roll(outline, -1, axis=0) - outline, axis=1)
    diagonals = np.linalg.norm(outline[2:] - outline[:2], axis=1) if len(outline) == 4 else np.empty(0)
    return [*sides.tolist(), *diagonals.tolist(), *_angles(outline).tolist()]


RULES = (
    Rule("V45c", "numbers on drawings are scheduled or measured in the part files", 0, "faults", explained),
    Rule("V45e", "drawings show every hole, and every side and angle of trimmed panels", 0, "faults", complete),
)
