"""V45f: the cutting plan says what schedule and layout say, and numbers parts in the order in which they fall."""

from collections.abc import Iterator
from itertools import pairwise
from typing import Any

from isomould.verify.delivery import Delivery
from isomould.verify.read.tables import Table, texts
from isomould.verify.rules import Measured, NotApplicable, Rule, faults

_LABELS = {
    "parts": "Parts",
    "yield_percent": "Yield (%)",
    "cut_length_mm": "Cut length (mm)",
    "cuts": "Cuts",
    "offcut_width_mm": "Offcut width (mm)",
    "offcut_height_mm": "Offcut height (mm)",
}
"""What the plan prints of the schedule of sheets, in the order of its list."""


def planned(delivery: Delivery) -> Measured:
    """Every sheet is listed and has a page with its row of the schedule and its parts, numbered."""
    if not delivery.design.raw.get("drawings", False):
        raise NotApplicable("the project asks for no drawings")
    sheets = delivery.table("sheets")
    pages = {page.name: page.texts for page in delivery.plan.sheets}
    listed = [text for name, found in pages.items() if name not in delivery.layout.sheets for text in found]
    problems = list[str]()
    for number, sheet in enumerate(texts(sheets, "sheet")):
        own = [text for name, found in pages.items() if name.partition(" (")[0] == sheet for text in found]
        problems += _row_faults(sheets, number, own, listed)
        problems += [f"{sheet}: {' '.join(row)} is not on its page" for row in _missing_parts(delivery, sheet, own)]
    return faults(sheets.rows + len(delivery.layout.placements), problems)


def _row_faults(sheets: Table, number: int, own: list[str], listed: list[str]) -> Iterator[str]:
    row = {name: texts(sheets, name)[number] for name in ("sheet", "stock", *_LABELS)}
    shown = set(pairwise(own))
    yield from (
        f"{row['sheet']}: {label} {row[name]} is not on its page"
        for name, label in _LABELS.items()
        if (label, row[name]) not in shown
    )
    wanted = [row[name] for name in _LABELS]
    starts = [k for k, text in enumerate(listed) if text == row["sheet"]]
    if not any(listed[k + 2 : k + 2 + len(wanted)] == wanted for k in starts):
        yield f"{row['sheet']}: not listed as scheduled"


def _missing_parts(delivery: Delivery, sheet: str, own: list[str]) -> Iterator[tuple[str, str, str]]:
    placed = delivery.layout.placements
    tree = (delivery.layout.raw.get("cut_tree") or {}).get(sheet)
    lying = [k for k, item in enumerate(placed) if item.sheet == sheet]
    shown = set(zip(own, own[1:], own[2:], strict=False))
    for number, k in enumerate(_falling(tree) if tree else lying, start=1):
        row = (str(number), placed[k].mark, placed[k].location)
        if row not in shown:
            yield row


def _falling(tree: dict[str, Any]) -> list[int]:
    """Give the placements of a cutting tree in the order in which its pieces fall."""
    if not tree.get("pieces"):
        return [tree["placement"]] if "placement" in tree else []
    return [index for piece in tree["pieces"] for index in _falling(piece)]


RULES = (Rule("V45f", "the cutting plan shows every sheet as scheduled", 0, "faults", planned),)
