"""NC1 files (DSTV), read strictly: what a machine would be told, block by block."""

import math
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from isomould.verify.read.text import refusing
from isomould.verify.rules import Floats, Unreadable

_TEXTS = ("order", "drawing", "phase", "mark", "grade")
_SIZES = ("height", "width", "flange", "web", "radius", "mass", "paint")
_HEADER = 24
_NUMBER = re.compile(r"-?\d+\.\d+")
_HOLE = re.compile(r"([vouh])\s+(\S+?)([uos]?)\s+(\S+)\s+(\S+)\s+(\d+\.\d+)(?:l\s*(\S+)\s+(\S+)\s+(\S+))?")
_CORNER = re.compile(r"([vouh])\s+(\S+?)([uos]?)\s+(\S+)\s+(\S+)")
_STAMP = re.compile(r"([vouh])\s+(\S+?)([uos]?)\s+(\S+)\s+(\S+)\s+(\d+\.\d+)r(\S.*)")


@dataclass(frozen=True)
class NcHole:
    """A hole: view, centre (of a slot's first end), diameter, and where a slot's other end lies from there, mm."""

    view: str
    x: float
    y: float
    diameter: float
    slot: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True)
class NcStamp:
    """A stamped text: view, lower left corner, angle in degrees, height mm."""

    view: str
    x: float
    y: float
    angle_deg: float
    height: float
    text: str


@dataclass(frozen=True, eq=False)
class NcFile:
    """One part: the header by name, contours (n, 3) of x, y, radius with the first point once, holes, stamps."""

    texts: dict[str, str]
    quantity: int
    profile: str
    code: str
    length: float
    saw_length: float
    sizes: dict[str, float]
    notes: tuple[str, ...]
    outer: tuple[Floats, ...]
    inner: tuple[Floats, ...]
    holes: tuple[NcHole, ...]
    stamps: tuple[NcStamp, ...]


@refusing
def read_nc1(path: Path) -> NcFile:
    """Read one part; anything that is not as the format says makes it unreadable."""
    text = path.read_bytes().decode("ascii")
    lines = [line for line in text.splitlines() if not line.startswith("**")]
    _require(text.endswith("\n") and lines[:1] == ["ST"] and lines[-1] == "EN", "does not run from ST to EN")
    header, blocks = lines[1 : 1 + _HEADER], _blocks(lines[1 + _HEADER : -1])
    _require(all(line.startswith("  ") and line.strip() for line in header), "a line of the header is missing")
    return _file([line.strip() for line in header], blocks)


def _file(header: list[str], blocks: list[tuple[str, list[str]]]) -> NcFile:
    lengths = [_number(word.strip()) for word in header[8].split(",")]
    _require(len(lengths) in (1, 2), "line 9 is no length and saw length")
    _require(header[5].isdecimal(), "line 6 is no quantity")
    _require(all(_number(word) == 0 for word in header[16:20]), "a saw cut has an angle beside the contour")
    return NcFile(
        texts=dict(zip(_TEXTS, header, strict=False)),
        quantity=int(header[5]),
        profile=header[6],
        code=header[7],
        length=lengths[0],
        saw_length=lengths[-1],
        sizes=dict(zip(_SIZES, map(_number, header[9:16]), strict=True)),
        notes=tuple(header[20:24]),
        outer=tuple(_contour(lines) for word, lines in blocks if word == "AK"),
        inner=tuple(_contour(lines) for word, lines in blocks if word == "IK"),
        holes=tuple(_hole(line) for word, lines in blocks if word == "BO" for line in lines),
        stamps=tuple(_stamp(line) for word, lines in blocks if word == "SI" for line in lines),
    )


def _blocks(lines: list[str]) -> list[tuple[str, list[str]]]:
    """Split the lines after the header at their keywords."""
    found = list[tuple[str, list[str]]]()
    for line in lines:
        if line.startswith("  "):
            _require(bool(found), f"data before the first block: {line!r}")
            found[-1][1].append(line.strip())
        else:
            _require(line in {"AK", "IK", "BO", "SI"}, f"unknown block {line!r}")
            found.append((line, []))
    _require(all(rows for _, rows in found), "a block without data")
    return found


def _contour(lines: list[str]) -> Floats:
    rows = [_matched(_CORNER, line) for line in lines]
    _require(all(row[0] == "v" for row in rows), "a contour beside the front view")
    points = np.array([[_number(row[k]) for k in (1, 3, 4)] for row in rows])
    _require(len(points) > 3 and bool((points[0, :2] == points[-1, :2]).all()), "a contour that is not closed")
    return points[:-1]


def _hole(line: str) -> NcHole:
    view, x, _, y, diameter, depth, *slot = _matched(_HOLE, line)
    _require(_number(depth) == 0, "a hole that is not through")
    dx, dy, angle = (_number(word) if word else 0.0 for word in slot)
    _require(angle == 0, "a turned slot")
    return NcHole(view, _number(x), _number(y), _number(diameter), (dx, dy))


def _stamp(line: str) -> NcStamp:
    view, x, _, y, angle, height, text = _matched(_STAMP, line)
    return NcStamp(view, _number(x), _number(y), _number(angle), _number(height), text)


def _matched(pattern: re.Pattern[str], line: str) -> list[str]:
    match = pattern.fullmatch(line)
    _require(match is not None, f"{line!r} is not as its block asks")
    return [word or "" for word in match.groups()] if match else []


def _number(word: str) -> float:
    _require(_NUMBER.fullmatch(word) is not None and math.isfinite(float(word)), f"{word!r} is not a number")
    return float(word)


def _require(holds: bool, message: str) -> None:
    if not holds:
        raise Unreadable(message)
