"""V31e of nests that stand alone: no sheet holds parts of two materials, and grains lie along the sheet."""

from collections.abc import Iterator
from itertools import pairwise

from isomould.verify.checks.cutting_plan import is_shown
from isomould.verify.delivery import Delivery
from isomould.verify.read.text import Json
from isomould.verify.rules import Measured, Rule, faults

_THICKNESS = 5e-4
"""Half of the last digit of thicknesses, mm."""

_QUARTER, _HALF = 90, 180


def material_text(sheet: Json) -> str:
    """Give what a sheet is made of, as drawings and plans say it; nothing where it is not said."""
    thickness = f"{sheet['thickness']:.12g} mm" if "thickness" in sheet else ""
    return " ".join(text for text in (sheet.get("material", ""), sheet.get("grade", ""), thickness) if text)


def apart(delivery: Delivery) -> Measured:
    """Hold every placed part to its sheet: material, grade, thickness, and the grain along the sheet's width."""
    raw = delivery.layout.raw
    parts = {str(part["id"]): part for part in raw["parts"]}
    sheets = {str(sheet["id"]): sheet for sheet in raw["sheets"]}
    problems = list[str]()
    for item in delivery.layout.placements:
        part = parts[item.mark]
        faulty = [*_differing(part, sheets[item.sheet]), *_against_grain(part, item.rotation_deg)]
        problems += [f"{item.mark} on {item.sheet}: {fault}" for fault in faulty]
    return faults(len(delivery.layout.placements), problems)


def _differing(part: Json, sheet: Json) -> Iterator[str]:
    for name in ("material", "grade"):
        if name in part and _word(part[name]) != _word(sheet.get(name, "")):
            yield f"{name} {part[name]} on a sheet of {sheet.get(name, 'none')}"
    if "thickness" in part and abs(part["thickness"] - sheet.get("thickness", -1.0)) > _THICKNESS:
        yield f"{part['thickness']} mm thick on a sheet of {sheet.get('thickness', 'none')}"


def _word(text: str) -> str:
    return " ".join(text.casefold().split())


def _against_grain(part: Json, rotation_deg: float) -> Iterator[str]:
    wanted = {"along": 0, "across": _QUARTER}.get(part.get("grain", ""))
    if wanted is not None and rotation_deg % _HALF != wanted:
        yield f"turned by {rotation_deg:g} degrees, its grain lies {part['grain']} the outline's x axis"


def plan_says(delivery: Delivery) -> Measured:
    """List the sheets whose page in the cutting plan does not say what they are made of."""
    pages = {page.name: page.texts for page in delivery.plan.sheets}
    said = {str(sheet["id"]): material_text(sheet) for sheet in delivery.layout.raw["sheets"]}
    problems = [
        f"{name}: material {text} is not on its page"
        for name, text in said.items()
        if text and not _is_said(text, pages.get(name, ()))
    ]
    return faults(len(said), problems)


def _is_said(text: str, page: tuple[str, ...] | list[str]) -> bool:
    return any(label == "Material" and is_shown(text, shown) for label, shown in pairwise(page))


RULES = (Rule("V31e", "no sheet holds two materials, grains lie along it", 0, "faults", apart),)
