"""Parts of one sheet in each other's hollows: what `spyrrow` finds, held against the gap.

The engine knows neither gaps nor sheets: parts grow by half the gap, and a strip as high as a sheet has to end up no
longer than the sheet is. It counts in 32 bits, so parts grow by a little more, and nothing it says is taken on trust.
"""

import json
import subprocess
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np
import shapely

from isomould.arrays import Floats
from isomould.nesting.bound import Room
from isomould.nesting.placing import Placed
from isomould.nesting.shapes import UM, micrometres, rotate

OLDEST = (0, 9)
"""Of spyrrow: before it searches could not be followed, and angles were radians."""

SPARE = 0.005
"""What parts grow by beside half the gap, mm: coordinates of 32 bits are off by less on any sheet."""

WORKERS = 2
"""Threads of one search; the layout depends on their number."""

SEED = 1

LONGEST_SEARCH = 120
"""Seconds after which one sheet is given up; the layout then depends on the machine."""

_MITRE = 2.0
"""Corners of grown parts are cut off at this many times the growth."""

_LOOKS = 0.2
"""Seconds between two questions whether to stop."""

_SHORT = 1e-6
"""mm; by so much may a gap fall short."""


@dataclass(frozen=True, eq=False)
class Lot:
    """What shall lie on one sheet: parts (index, outline (n, 2) mm, pieces), and the rotations that it allows."""

    parts: tuple[tuple[int, Floats, int], ...]
    turns: tuple[int, ...]
    room: Room
    gap: float


@dataclass(frozen=True, eq=False)
class Answer:
    """The pieces of a lot, from the corner of the room, or None; whether it depends on the seed alone."""

    placed: tuple[Placed, ...] | None
    steady: bool


def has_engine() -> bool:
    """Tell whether `spyrrow` is installed, in a version that says how its search goes: the extra `irregular`."""
    try:
        installed = metadata.version("spyrrow")
    except metadata.PackageNotFoundError:
        return False
    return tuple(int(number) for number in installed.split(".")[:2]) >= OLDEST


def interlock(lot: Lot, attempts: int, stops: Callable[[], bool]) -> Answer:
    """Place a lot on its sheet.

    Parameters
    ----------
    attempts
        Failures after which the engine gives up.
    stops
        Asked now and then; True ends the search without an answer.
    """
    told = _ask(json.dumps(_task(lot, attempts)), stops)
    if told is None:
        return Answer(None, steady=False)
    found: dict[str, Any] = json.loads(told) if told else {"ended": "gives up"}
    if found["ended"] != "fits":
        return Answer(None, steady=found["ended"] == "gives up")
    placed = tuple(_placed(lot, *row) for row in found["placed"])
    return Answer(placed if _is_proper(placed, lot) else None, steady=True)


def _task(lot: Lot, attempts: int) -> dict[str, object]:
    more = lot.gap + 2 * SPARE
    items = [
        {"shape": _grown(outline, more / 2).tolist(), "demand": pieces, "turns": lot.turns}
        for _, outline, pieces in lot.parts
    ]
    size = {"height": lot.room.height / UM + more, "width": lot.room.width / UM + more}
    limits = {"attempts": attempts, "seconds": LONGEST_SEARCH, "workers": WORKERS, "seed": SEED}
    return {"items": items, **size, **limits}


def _grown(outline: Floats, by: float) -> Floats:
    """Give an outline (n, 2) mm from the corner of its box, grown; hollows that close are filled."""
    polygon = shapely.Polygon(outline - outline.min(axis=0))
    grown = polygon.buffer(by, join_style="mitre", mitre_limit=_MITRE)
    return shapely.get_coordinates(grown.exterior)[:-1]


def _ask(task: str, stops: Callable[[], bool]) -> str | None:
    """Give what the engine says, nothing where it failed, None where it was stopped."""
    command = [sys.executable, "-P", str(Path(__file__).with_name("strip_engine.py"))]
    quiet = subprocess.DEVNULL
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=quiet, text=True) as engine:
        given: str | None = task
        while True:
            try:
                told, _ = engine.communicate(given, timeout=_LOOKS)
            except subprocess.TimeoutExpired:
                given = None
                if stops():
                    engine.kill()
                    return None
            except BaseException:
                engine.kill()
                raise
            else:
                return told if engine.returncode == 0 else ""


def _placed(lot: Lot, item: int, rotation_deg: float, x: float, y: float) -> Placed:
    index, outline, _ = lot.parts[item]
    turn = round(rotation_deg / 90) * 90 % 360
    points = micrometres(outline)
    turned = rotate(points - points.min(axis=0), turn)
    corner = np.rint((np.array([x, y]) - lot.gap / 2 - SPARE) * UM).astype(np.int64)
    moved = turned + corner
    # What stands out of the room by rounding goes back; the spare between parts is larger than that.
    size = np.array([lot.room.width, lot.room.height])
    inside = np.clip(moved.min(axis=0), 0, size - np.ptp(moved, axis=0)) - moved.min(axis=0)
    return Placed(index, moved + np.where(np.abs(inside) <= SPARE * UM, inside, 0), turn, turned_over=False)


def _is_proper(placed: Sequence[Placed], lot: Lot) -> bool:
    """Tell in 64 bits whether all pieces are there, in the room, and a gap apart."""
    found = sorted(item.part for item in placed)
    wanted = sorted(index for index, _, pieces in lot.parts for _ in range(pieces))
    points = np.concatenate([item.points for item in placed])
    size = np.array([lot.room.width, lot.room.height])
    if found != wanted or points.min() < 0 or (points > size).any():
        return False
    polygons = np.array([shapely.Polygon(item.points / UM) for item in placed], dtype=object)
    near = max(lot.gap - _SHORT, 0.0)
    first, later = shapely.STRtree(polygons).query(polygons, predicate="dwithin", distance=near)
    pairs = first < later
    return bool((shapely.distance(polygons[first[pairs]], polygons[later[pairs]]) >= near).all())
