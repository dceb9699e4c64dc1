"""V42: the NC1 files of the members say what drawings and schedule say, to the two decimals of the format."""

import re
import unicodedata
from collections.abc import Iterator

import numpy as np

from isomould.verify.delivery import Delivery
from isomould.verify.read.dxf import Drawing, Entity, Outline, area, one_outline, outlines_on
from isomould.verify.read.nc1 import NcFile
from isomould.verify.read.tables import Table, half_unit, number, texts
from isomould.verify.rules import Floats, Measured, Rule, Unreadable, faults, worst_of

FORMAT = 0.01
"""Half of the last digit in x and in y, and a little for drawings rounded to 0.001, mm."""
_LENGTHS = re.compile(r"TOP (\d+\.\d+) BOTTOM (\d+\.\d+)")


def contours(delivery: Delivery) -> Measured:
    """Contours and holes of the front against the part drawings, the largest distance of any point, mm."""
    files = {mark: part for mark, part in _files(delivery).items() if part.code == "B"}
    off = [_contour_off(part, _drawing(delivery, mark)) for mark, part in files.items()]
    return worst_of(off, list(files), none="no member is cut from a plate")


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
    """Compare a part as drawn, moved to the lower left corner, with its file."""
    drawn = one_outline(drawing)
    corner = drawn.points.min(axis=0)
    if len(part.outer) != 1 or part.inner or part.outer[0][:, 2].any() or drawn.bulges.any():
        return np.inf
    return max(_loops_off(part.outer[0][:, :2], drawn.points - corner), _holes_off(part, drawing, corner))


def _loops_off(found: Floats, drawn: Floats) -> float:
    """Give the largest distance of the corners of two loops that run the same way round (none left out)."""
    apart = np.linalg.norm(drawn[:, None] - found[None, :], axis=2)
    nearest = apart.argmin(axis=1)
    steps = (np.roll(nearest, -1) - nearest) % len(found)
    once_round = bool((steps <= 1).all()) and int(steps.sum()) == len(found)
    return float(apart.min(axis=1).max()) if once_round else np.inf


def _holes_off(part: NcFile, drawing: Drawing, corner: Floats) -> float:
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


def _header_faults(part: NcFile, row: dict[str, str], order: dict[str, str]) -> list[str]:
    """List what a file says otherwise than the schedule's row and the project's order."""
    wanted = {key: _plain(order[key]) for key in ("order", "drawing", "phase")} | {"mark": row["mark"]}
    wanted |= {"grade": _plain(row["grade"]), "quantity": row["quantity"], "profile": _plain(row["section"])}
    told = {**part.texts, "quantity": str(part.quantity), "profile": part.profile}
    found = [f"{key} {told[key]!r}, not {value!r}" for key, value in wanted.items() if told[key] != value]
    found += [f"stamped {stamp.text}" for stamp in part.stamps if stamp.text != row["mark"]]
    return found if f"members/{row['mark']}.nc1" in row["files"].split(";") else [*found, "no NC1 file in its row"]


def _plain(text: str) -> str:
    """Give text as the files can hold it: without accents, a question mark for what has no plain letter."""
    bare = [letter for letter in unicodedata.normalize("NFKD", text) if not unicodedata.combining(letter)]
    return "".join(letter if letter.isascii() else "?" for letter in bare)[:80].strip() or "-"


def sizes(delivery: Delivery) -> Measured:
    """Lengths over all, along top and bottom against the schedule, depth and thickness against the design, mm."""
    table, member, files = delivery.table("members"), delivery.design.raw["member"], _files(delivery)
    columns = ("cut_length_mm", "cut_length_mm", "top_length_mm", "bottom_length_mm")
    claimed = zip(texts(table, "mark"), *(texts(table, column) for column in columns), strict=True)
    section = [float(member[key]) for key in ("depth", "thickness", "thickness", "thickness")]
    off = {mark: _size_off(files[mark], [*map(number, row)], section) for mark, *row in claimed if mark in files}
    return worst_of(list(off.values()), list(off))


def _size_off(part: NcFile, lengths: list[float], section: list[float]) -> float:
    """Compare lengths, and of plates the section."""
    match = _LENGTHS.fullmatch(part.notes[0])
    told = [part.length, part.saw_length, *(number(word) for word in (match.groups() if match else ("", "")))]
    plate = [part.sizes[key] for key in ("height", "width", "flange", "web")]
    off = np.abs(np.subtract(told, lengths)).max()
    return float(max(off, np.abs(np.subtract(plate, section)).max()) if part.code == "B" else off)


def masses(delivery: Delivery) -> Measured:
    """Net mass of the contours less their holes against the schedule, in half digits of both roundings."""
    table, member, files = delivery.table("members"), delivery.design.raw["member"], _files(delivery)
    per_area = float(member["thickness"]) * float(member["density_kg_m3"]) * 1e-9
    rows = zip(texts(table, "mark"), map(number, texts(table, "mass_kg")), strict=True)
    plates = {mark: mass for mark, mass in rows if mark in files and files[mark].code == "B"}
    off = [_mass_off(files[mark], mass, per_area) for mark, mass in plates.items()]
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
    """Line 15 of the headers against section and density, kg per m or per m²."""
    member, files = delivery.design.raw["member"], _files(delivery)
    sheet = float(member["thickness"]) / 1e3 * float(member["density_kg_m3"])
    expected = sheet if delivery.design.raw["nc1"]["mass"] == "kg/m2" else sheet * float(member["depth"]) / 1e3
    plates = {mark: part for mark, part in files.items() if part.code == "B"}
    off = [abs(part.sizes["mass"] - expected) for part in plates.values()]
    return worst_of(off, list(plates), none="no member is cut from a plate")


RULES = (
    Rule("V42", "contours and holes of NC1 files = drawings", FORMAT, "mm", contours),
    Rule("V42b", "marks, quantities, profiles and orders of NC1 files = schedule", 0, "faults", headers),
    Rule("V42c", "lengths and sections of NC1 files = schedule", FORMAT, "mm", sizes),
    Rule("V42d", "masses of NC1 contours = schedule", 1.0, "half digits", masses),
    Rule("V42e", "masses per metre in NC1 headers = section", 0.0051, "kg", metre_masses),
)
