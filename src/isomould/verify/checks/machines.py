"""V42: the NC1 files of the members say what drawings and schedule say, to the two decimals of the format."""

import re
import unicodedata
from collections.abc import Iterator
from typing import Any

import numpy as np

from isomould.verify.delivery import Delivery
from isomould.verify.read.dxf import Drawing, Entity, Outline, area, one_outline, outlines_on
from isomould.verify.read.nc1 import NcFile
from isomould.verify.read.tables import Table, half_unit, number, pairs, texts
from isomould.verify.rules import Floats, Measured, Rule, Unreadable, faults, worst_of

FORMAT = 0.01
"""Half of the last digit in x and in y, and a little for drawings rounded to 0.001, mm."""
_LENGTHS = re.compile(r"TOP (\d+\.\d+) BOTTOM (\d+\.\d+)")


def contours(delivery: Delivery) -> Measured:
    """Contours and holes of the front against the part drawings, the largest distance of any point, mm."""
    files = _files(delivery)
    off = [_contour_off(part, _drawing(delivery, mark)) for mark, part in files.items()]
    return worst_of(off, list(files))


def _files(delivery: Delivery) -> dict[str, NcFile]:
    if not delivery.nc1:
        message = "members/*.nc1 are missing"
        raise Unreadable(message)
    return delivery.nc1


def _drawing(delivery: Delivery, mark: str) -> Drawing:
    if mark not in delivery.members:
        message = f"members/{mark}.dxf is missing"
        raise Unreadable(message)
    return delivery.members[mark]


def _contour_off(part: NcFile, drawing: Drawing) -> float:
    """Compare a part as drawn, moved to the lower left corner, with its file; a tube is cut square, without contour."""
    drawn = one_outline(drawing)
    corner = drawn.points.min(axis=0)
    if part.code == "M":
        return np.inf if part.outer or part.inner else holes_off(part, drawing, corner)
    if len(part.outer) != 1 or part.inner or part.outer[0][:, 2].any() or drawn.bulges.any():
        return np.inf
    return max(_loops_off(part.outer[0][:, :2], drawn.points - corner), holes_off(part, drawing, corner))


def _loops_off(found: Floats, drawn: Floats) -> float:
    """Give the largest distance of the corners of two loops that run the same way round (none left out)."""
    apart = np.linalg.norm(drawn[:, None] - found[None, :], axis=2)
    nearest = apart.argmin(axis=1)
    steps = (np.roll(nearest, -1) - nearest) % len(found)
    once_round = bool((steps <= 1).all()) and int(steps.sum()) == len(found)
    return float(apart.min(axis=1).max()) if once_round else np.inf


def holes_off(part: NcFile, drawing: Drawing, corner: Floats) -> float:
    """Compare holes (x, y, diameter, distance of a slot's ends) in the order of their places."""
    told = [(h.x + h.slot[0] / 2, h.y + h.slot[1] / 2, h.diameter, h.slot[0]) for h in part.holes if h.view == "v"]
    drawn = [(*circle.points[0][:2] - corner, 2 * circle.radius, 0.0) for circle in _drilled(drawing)]
    drawn += [_slot(outline, corner) for outline in outlines_on(drawing, "CUT_INNER")]
    if len(told) != len(drawn):
        return np.inf
    return float(np.max(np.abs(_sorted(told) - _sorted(drawn)), initial=0.0))


def _drilled(drawing: Drawing) -> Iterator[Entity]:
    return (entity for entity in drawing.entities if entity.kind == "CIRCLE" and entity.layer == "DRILL")


def _slot(outline: Outline, corner: Floats) -> tuple[float, ...]:
    """Centre, breadth and distance of the ends of a slot drawn as two straights and two half circles."""
    (length, breadth), centre = np.ptp(outline.points, axis=0), outline.points.mean(axis=0) - corner
    return (*centre, float(breadth), float(length)) if len(outline.points) == 4 else (np.inf,) * 4


def _sorted(rows: list[tuple[float, ...]]) -> Floats:
    return np.array(sorted(tuple(map(float, row)) for row in rows)).reshape(-1, 4)


def headers(delivery: Delivery) -> Measured:
    """Marks, quantities, profiles, grades and orders of the files against schedule and project."""
    table, files = delivery.table("members"), _files(delivery)
    rows = {row["mark"]: row for row in _rows(table)}
    problems = [f"{mark} in the schedule or the folder only" for mark in sorted(rows.keys() ^ files.keys())]
    for mark in sorted(rows.keys() & files.keys()):
        problems += [
            f"{mark}: {fault}" for fault in _header_faults(files[mark], rows[mark], delivery.design.raw["nc1"])
        ]
    return faults(len(rows), problems)


def _rows(table: Table) -> list[dict[str, str]]:
    names = list(table.columns)
    return [dict(zip(names, cells, strict=True)) for cells in zip(*table.columns.values(), strict=True)]


_NAMED_LETTERS = {"SHARP S": "SS", "THORN": "TH", "ETH": "D", "ENG": "N", "EZH": "Z", "ESH": "S", "SCHWA": "E"}


def _header_faults(part: NcFile, row: dict[str, str], order: dict[str, str]) -> list[str]:
    """List what a file says otherwise than the schedule's row and the project's order."""
    wanted = {key: in_plain_letters(order[key]) for key in ("order", "drawing", "phase")} | {"mark": row["mark"]}
    wanted |= {
        "grade": in_plain_letters(row["grade"]),
        "quantity": row["quantity"],
        "profile": in_plain_letters(row["section"]),
    }
    told = {**part.texts, "quantity": str(part.quantity), "profile": part.profile}
    found = [f"{key} {told[key]!r}, not {value!r}" for key, value in wanted.items() if told[key] != value]
    found += [f"stamped {stamp.text}" for stamp in part.stamps if stamp.text != row["mark"]]
    return found if f"members/{row['mark']}.nc1" in row["files"].split(";") else [*found, "no NC1 file in its row"]


def in_plain_letters(text: str) -> str:
    """Give text as the files can hold it: plain letters, a question mark for what has none."""
    bare = [letter for letter in unicodedata.normalize("NFKD", text) if not unicodedata.combining(letter)]
    return "".join(letter if letter.isascii() else _bare(letter) for letter in bare)[:80].strip() or "-"


def _bare(letter: str) -> str:
    """Give the plain letters that the name of a Latin one says: LATIN SMALL LETTER L WITH STROKE is an l."""
    words = unicodedata.name(letter, "").partition(" WITH ")[0].split()
    if words[:1] != ["LATIN"] or words[2:3] not in (["LETTER"], ["LIGATURE"]):
        return "-" if unicodedata.category(letter) == "Pd" else "?"
    told = " ".join(word for word in words[3:] if word not in {"DOTLESS", "OPEN"})
    plain = _NAMED_LETTERS.get(told, told if len(told) < 3 else "?")
    return plain if words[1] == "CAPITAL" else plain.lower()


def sizes(delivery: Delivery) -> Measured:
    """Lengths over all, along top and bottom against the schedule, sizes of the section against the design, mm."""
    table, files, sections = delivery.table("members"), _files(delivery), _sections(delivery)
    columns = ("cut_length_mm", "cut_length_mm", "top_length_mm", "bottom_length_mm")
    claimed = zip(texts(table, "mark"), *(texts(table, column) for column in columns), strict=True)
    off = {mark: _size_off(files[mark], [*map(number, row)], sections[mark]) for mark, *row in claimed if mark in files}
    return worst_of(list(off.values()), list(off))


def _sections(delivery: Delivery) -> dict[str, dict[str, Any]]:
    """Map the marks of the members on what the design says of their sections."""
    known, named = delivery.design.raw["member"]["sections"], pairs(delivery.table("members"), "mark", "section")
    return {mark: known[name] for mark, name in named.items()}


def _size_off(part: NcFile, lengths: list[float], section: dict[str, Any]) -> float:
    """Compare lengths and the sizes of the section."""
    match = _LENGTHS.fullmatch(part.notes[0])
    told = [part.length, part.saw_length, *(number(word) for word in (match.groups() if match else ("", "")))]
    code, wanted = _header_sizes(section)
    if part.code != code:
        return np.inf
    off = [part.sizes[key] - value for key, value in wanted.items()]
    return float(max(np.abs(np.subtract(told, lengths)).max(), np.abs(off).max()))


def _header_sizes(section: dict[str, Any]) -> tuple[str, dict[str, Any]]:
    """Code and sizes that a header gives of a section: a plate's thickness three times, a tube's wall twice."""
    if section["kind"] == "plate":
        return "B", {"height": section["depth"], **dict.fromkeys(("width", "flange", "web"), section["thickness"])}
    wall = dict.fromkeys(("flange", "web"), section["wall"])
    return "M", {"height": section["depth"], "width": section["width"], "radius": section["outer_radius"], **wall}


def masses(delivery: Delivery) -> Measured:
    """Net mass of the contours less their holes against the schedule, in half digits of both roundings."""
    table, files, sections = delivery.table("members"), _files(delivery), _sections(delivery)
    density = float(delivery.design.raw["member"]["density_kg_m3"]) * 1e-9
    rows = zip(texts(table, "mark"), map(number, texts(table, "mass_kg")), strict=True)
    plates = {mark: mass for mark, mass in rows if mark in files and files[mark].code == "B"}
    off = [_mass_off(files[mark], mass, sections[mark]["thickness"] * density) for mark, mass in plates.items()]
    return worst_of(off, list(plates), none="no member is cut from a plate")


def _mass_off(part: NcFile, mass: float, per_area: float) -> float:
    net, girth = _net(part)
    return abs(net * per_area - mass) / (half_unit("mass_kg") + girth * per_area * FORMAT / 2)


def _net(part: NcFile) -> tuple[float, float]:
    """Area of a contour less its holes, mm², and how long its edges are, mm."""
    points = part.outer[0]
    outline = Outline("CUT", points[:, :2], np.zeros(len(points)), closed=True)
    holes = [np.pi * hole.diameter**2 / 4 + hole.slot[0] * hole.diameter for hole in part.holes]
    girth = np.linalg.norm(np.roll(points, -1, axis=0)[:, :2] - points[:, :2], axis=1).sum()
    return area(outline) - float(sum(holes)), float(girth)


def metre_masses(delivery: Delivery) -> Measured:
    """Line 15 of the headers against section and density, kg per m, or per m² of plates."""
    files, sections = _files(delivery), _sections(delivery)
    density, unit = float(delivery.design.raw["member"]["density_kg_m3"]), delivery.design.raw["nc1"]["mass"]
    known = {mark: part for mark, part in files.items() if mark in sections}
    off = [abs(part.sizes["mass"] - _mass(sections[mark], unit) * density) for mark, part in known.items()]
    return worst_of(off, list(known))


def _mass(section: dict[str, Any], unit: str) -> float:
    """Volume of a metre of a section, or of a square metre of plate, m³."""
    if section["kind"] == "plate":
        return section["thickness"] / 1e3 * (1.0 if unit == "kg/m2" else section["depth"] / 1e3)
    twice = 2 * section["wall"]
    outside = _rounded(section["depth"], section["width"], section["outer_radius"])
    return (outside - _rounded(section["depth"] - twice, section["width"] - twice, section["inner_radius"])) / 1e6


def _rounded(depth: float, width: float, radius: float) -> float:
    return depth * width - (4 - np.pi) * radius**2


RULES = (
    Rule("V42", "contours and holes of NC1 files = drawings", FORMAT, "mm", contours),
    Rule("V42b", "marks, quantities, profiles and orders of NC1 files = schedule", 0, "faults", headers),
    Rule("V42c", "lengths and sections of NC1 files = schedule", FORMAT, "mm", sizes),
    Rule("V42d", "masses of NC1 contours = schedule", 1.0, "half digits", masses),
    Rule("V42e", "masses per metre in NC1 headers = section", 0.0051, "kg", metre_masses),
)
