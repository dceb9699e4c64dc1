"""Parts as NC1 (DSTV, 7th edition): one part per file, mm, kg, m² and degrees, two decimals."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from isomould.arrays import Floats
from isomould.documents.ascii import plain_text
from isomould.documents.drawing import Polyline, bulges
from isomould.documents.engraving import Stamp
from isomould.documents.nc_parts import NcHole, NcPart
from isomould.documents.stroke_font import ARROW
from isomould.writers.disk import write_bytes

_DECIMALS = 2
_NOTES = 4
_LONGEST_TEXT = 80


@dataclass(frozen=True)
class NcOrder:
    """Lines 1 to 3 of every header: order, drawing and phase of the project."""

    order: str = ""
    drawing: str = ""
    phase: str = ""


def write_nc1(path: Path, part: NcPart, order: NcOrder) -> None:
    """Write one part.

    Raises
    ------
    OutputFault
        If the file cannot be written.
    """
    write_bytes(path, nc1_text(part, order).encode("ascii"))


def nc1_text(part: NcPart, order: NcOrder) -> str:
    """Give the text of one file, CRLF at the ends of its lines."""
    lines = ["ST", *_header(part, order), *_holes(part), *_contour(part), *_stamp(part.stamp), "EN"]
    return "".join(f"{line}\r\n" for line in lines)


def _header(part: NcPart, order: NcOrder) -> Iterator[str]:
    """Give the 20 lines that the format counts, and four of text."""
    profile = part.profile
    texts = (order.order, order.drawing, order.phase, part.mark, part.grade, str(part.quantity), profile.name)
    yield from map(_text, (*texts, profile.code))
    yield f"  {part.length:10.2f},{part.saw_length:10.2f}"
    sizes = (profile.height, profile.width, profile.flange, profile.web, profile.radius, profile.mass, profile.paint)
    yield from (f"  {value:10.2f}" for value in sizes)
    yield from [f"  {0:10.2f}"] * 4  # contours and square cuts only: no angles of saw cuts
    yield from map(_text, (*part.notes, *[""] * _NOTES)[:_NOTES])


def _text(text: str) -> str:
    """Write a line of text; a minus stands for none."""
    return f"  {plain_text(text)[:_LONGEST_TEXT].strip() or '-'}"


def _holes(part: NcPart) -> Iterator[str]:
    if part.holes:
        yield "BO"
        yield from map(_hole, part.holes)


def _hole(hole: NcHole) -> str:
    """Write a hole, right through; a slot adds `l`, the distance of its ends, its breadth and its angle."""
    line = _point(hole.view, hole.x, hole.y, hole.diameter, 0.0)
    return line if hole.lengthening == 0 else f"{line}l{hole.lengthening:8.2f}{0:10.2f}{0:10.2f}"


def _contour(part: NcPart) -> Iterator[str]:
    """Write the outer contour; the first point closes it, a radius belongs to the segment that starts there."""
    if part.contour is not None:
        yield "AK"
        yield from (_point("v", x, y, radius) for x, y, radius in _corners(part.contour, part.bulges))


def _corners(contour: Floats, bulged: Floats | None) -> list[list[float]]:
    """Give x, y and radius (k, 3) of the contour's points, none of them twice after rounding, the first once more."""
    line = Polyline("CUT", contour, True, bulged)
    rows = np.round(np.column_stack((contour, _radii(line))), _DECIMALS) + 0.0
    distinct = np.any(rows[:, :2] != np.roll(rows[:, :2], -1, axis=0), axis=1)
    return [*rows[distinct].tolist(), rows[distinct][0].tolist()]


def _radii(line: Polyline) -> Floats:
    """Radii (n,) mm of the arcs that follow the points, 0 where it is straight; positive counter-clockwise."""
    chord, sine = np.linalg.norm(np.roll(line.points, -1, axis=0) - line.points, axis=1), _half_sine(bulges(line))
    return np.divide(chord, 2 * sine, out=np.zeros_like(chord), where=sine != 0)


def _half_sine(bulge: Floats) -> Floats:
    """Sine of half the angle of an arc: `2 b / (1 + b²)`."""
    return 2 * bulge / (1 + bulge**2)


def _stamp(stamp: Stamp | None) -> Iterator[str]:
    """Write the mark, whose lines begin at its lower left corner; it is read from the start of the part to its end."""
    if stamp is not None:
        x, y = stamp.corner
        angle = 90.0 if stamp.turned else 0.0
        yield "SI"
        yield f"{_point('v', x, y, angle)}{stamp.height:6.1f}r{plain_text(stamp.text.removesuffix(ARROW))}"


def _point(view: str, x: float, y: float, *values: float) -> str:
    return f"  {view} {x:10.2f}u" + "".join(f"{value:10.2f}" for value in (y, *values))
