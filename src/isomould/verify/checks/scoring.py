"""V33c-V33e: scored sheets (gap = 0) break along their lines into the parts, each line once, in the tree's order."""

import math
from itertools import pairwise

import numpy as np

from isomould.verify.cutting import Line, Loop, chords, reach
from isomould.verify.delivery import Delivery
from isomould.verify.read.dxf import Drawing, outlines_on
from isomould.verify.rules import Floats, Measured, NotApplicable, Rule, Unreadable, faults, worse, worst_of
from isomould.verify.scoring import NEAR, break_sheet, misfit


def broken(delivery: Delivery) -> Measured:
    """Lines of SCORE that break no piece from edge to edge, and scored sheets on which something is cut."""
    problems, count = list[str](), 0
    for name, drawing in _scored(delivery).items():
        lines = _lines(drawing)
        problems += [f"{name}: {text}" for text in break_sheet(_room(delivery, name), lines).problems]
        problems += [f"{name}: a contour on CUT"] * len(outlines_on(drawing, "CUT"))
        count += len(lines)
    return faults(count, problems)


def freed(delivery: Delivery) -> Measured:
    """How far the corners of a part and of the piece broken out for it lie apart."""
    return worse(*(_freed(delivery, name, drawing) for name, drawing in _scored(delivery).items()))


def _freed(delivery: Delivery, name: str, drawing: Drawing) -> Measured:
    pieces = break_sheet(_room(delivery, name), _lines(drawing)).pieces
    placed = delivery.layout.on(name)
    off = [_nearest(_loop(item.points), pieces) for item in placed]
    return worst_of(off, [f"{name} {item.mark} {item.location}" for item in placed])


def _nearest(part: Loop, pieces: tuple[Loop, ...]) -> float:
    """Compare a part with the piece that holds its middle."""
    middle = (math.fsum(x for x, _ in part) / len(part), math.fsum(y for _, y in part) / len(part))
    return next((misfit(part, piece) for piece in pieces if reach([middle], piece) < 0), np.inf)


def ordered(delivery: Delivery) -> Measured:
    """Cuts of the cutting tree that are not scored, or not in its order."""
    drawings, trees = _scored(delivery), delivery.layout.raw.get("cut_tree")
    if not trees:
        raise Unreadable("there is no cutting tree")
    problems, count = list[str](), 0
    for name, drawing in drawings.items():
        asked = list(chords(trees[name], _room(delivery, name)))
        scored = _lines(drawing)
        at = [next((k for k, line in enumerate(scored) if _same(cut, line)), -1) for cut in asked]
        problems += [f"{name}: cut {k} of the tree is not scored" for k, found in enumerate(at, start=1) if found < 0]
        found = [k for k in at if k >= 0]
        problems += [f"{name}: line {b + 1} is scored after line {a + 1}" for a, b in pairwise(found) if b < a]
        count += len(asked)
    return faults(count, problems)


def _same(cut: Line, line: Line) -> bool:
    """Tell whether a cut and a scored line have the same ends."""
    return any(max(map(math.dist, cut, ends)) <= NEAR for ends in (line, line[::-1]))


def _scored(delivery: Delivery) -> dict[str, Drawing]:
    if delivery.nesting["gap_mm"] != 0:
        raise NotApplicable("sheets are cut, with a gap between parts")
    return delivery.sheets


def _lines(drawing: Drawing) -> list[Line]:
    lines = outlines_on(drawing, "SCORE")
    if not all(len(line.points) == 2 and not line.closed for line in lines):
        message = f"{drawing.name}.dxf: a line of SCORE is not straight"
        raise Unreadable(message)
    return [((float(a), float(b)), (float(c), float(d))) for (a, b), (c, d) in (line.points for line in lines)]


def _room(delivery: Delivery, name: str) -> Loop:
    trim, (width, height) = float(delivery.nesting["trim_mm"]), delivery.layout.sheets[name]
    right, top = width - trim, height - trim
    return [(trim, trim), (right, trim), (right, top), (trim, top)]


def _loop(points: Floats) -> Loop:
    return [(float(x), float(y)) for x, y in points]


RULES = (
    Rule("V33c", "every scored line breaks one piece from edge to edge", 0, "faults", broken),
    Rule("V33d", "scored lines free every part along all its sides", NEAR, "mm", freed),
    Rule("V33e", "lines are scored in the order of the cutting tree", 0, "faults", ordered),
)
