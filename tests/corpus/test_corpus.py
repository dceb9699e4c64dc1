"""Files that other programs wrote are read, and none wrongly: lengths, areas and closedness are known by construction.

`make_corpus.sh` makes them anew. Files without a unit are read in millimetres, as a user is told to.
"""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import shapely
from corpus_shapes import INK, SCAD, SHAPES, Drawn

import isomould
from isomould.errors import Refused

FILES = sorted((Path(__file__).parent / "files").iterdir())
PRINTED = {"freecad": 0.2, "inkscape": 0.05, "openscad": 0.02}
"""Lengths (mm) that are lost in the six digits that a program prints, or in circles made of splines."""


def expected(path: Path) -> Drawn:
    program, _, name = path.stem.partition("-")
    name = name.rpartition("-")[2]
    if program in ("openscad", "inkscape"):
        return {"openscad": SCAD, "inkscape": INK}[program][name][1]
    return SHAPES[name]


def net_area(curves) -> float:
    """Area of the largest loop without the others; 32 chords of a circle hold 0.7 % less than it."""
    areas = sorted((shapely.Polygon(curve.points).area for curve in curves), reverse=True)
    return areas[0] - sum(areas[1:])


def read(path: Path):
    try:
        return isomould.inspect(path)
    except Refused as refusal:
        if not refusal.field.endswith("units"):
            raise
        return isomould.inspect(path, units="mm")


def outcome(path: Path) -> str:
    """Say "read", or "refused" with the words, or fail where something is read wrongly."""
    drawn, slack = expected(path), PRINTED.get(path.stem.partition("-")[0], 1e-3)
    try:
        found = read(path)
    except Refused as refusal:
        return f"refused: {refusal}"
    assert sorted(curve.length for curve in found.curves) == pytest.approx(drawn.lengths, abs=slack), path.name
    assert {curve.closed for curve in found.curves} == {drawn.closed}, path.name
    if drawn.area is not None:
        assert net_area(found.curves) == pytest.approx(drawn.area, rel=8e-3), path.name
    return "read"


def test_sound_files_are_read_and_none_wrongly():
    outcomes = {path.name: outcome(path) for path in FILES}
    refused = {name: words for name, words in outcomes.items() if words != "read"}
    assert len(outcomes) >= 60
    assert len(refused) <= len(outcomes) // 20, refused


def test_the_corpus_is_of_many_programs_and_small():
    programs = {path.stem.partition("-")[0] for path in FILES}
    assert {"freecad", "openscad", "inkscape", "makerjs", "tarikjabiri", "rhino"} < programs
    assert sum(path.stat().st_size for path in FILES) < 2_000_000


def test_curves_are_joined_to_one_and_named():
    for path in FILES:
        if path.stem.endswith(("rail", "plate", "lines")) and not path.stem.startswith("openscad"):
            curves = read(path).curves
            assert len(curves) == 1, path.name
            assert len(curves[0].entities) in (1, 3, 4, 8), path.name


def test_boxes_are_those_of_the_shapes():
    low, high = -8000 * np.cos(np.radians(35)) - 3000 * np.sin(np.radians(35)), 8000.0
    for path in FILES:
        if path.stem.endswith("-rail"):
            box = read(path).curves[0].box
            assert (box[0], box[3]) == pytest.approx((low, high), abs=0.1), path.name


def is_part(path: Path) -> bool:
    return path.suffix == ".dxf" and expected(path).area is not None


def test_parts_are_what_nest_reads(tmp_path):
    files = [path for path in FILES if is_part(path)]
    for path in files:
        shutil.copy(path, tmp_path / f"{path.stem}_x1.dxf")
    parts = {part["id"]: part for part in isomould.inspect(tmp_path, units="mm").data["parts"]}
    assert len(files) > 30
    assert set(parts) == {path.stem for path in files}
    for path in files:
        drawn, part = expected(path), parts[path.stem]
        # outlines may lie up to 0.05 mm outside of what is drawn, holes inside; the rest is printing
        beyond = part["area_mm2"] - drawn.area
        assert -0.05 * sum(drawn.lengths) < beyond < 0.06 * sum(drawn.lengths) + 1, path.name
        assert part["holes"] == len(drawn.lengths) - 1, path.name


PROGRAMS = ("openscad", "inkscape", "xvfb-run", "freecadcmd", "node")
"""What `make_corpus.sh` needs; the node packages stand below NODE_FOLDER."""


@pytest.mark.long
def test_a_corpus_made_anew_is_read_like_the_kept_one(tmp_path):
    """The programs of this machine write the shapes again: other versions, the same lengths and areas."""
    missing = [program for program in PROGRAMS if shutil.which(program) is None]
    if missing or "NODE_FOLDER" not in os.environ:
        pytest.skip(f"to make drawings anew, {', '.join([*missing, 'NODE_FOLDER'])} must be there")
    script = Path(__file__).parent / "make_corpus.sh"
    environment = {**os.environ, "PYTHON": sys.executable}
    subprocess.run(["bash", script, tmp_path], check=True, env=environment, timeout=900)
    outcomes = {path.name: outcome(path) for path in sorted(tmp_path.iterdir())}
    refused = {name: words for name, words in outcomes.items() if words != "read"}
    assert len(outcomes) >= 40
    assert len(refused) <= len(outcomes) // 20, refused


UNSOUND = {
    "gap-of-1": "1 mm apart",
    "branch": "3 ends meet",
    "doubled": "lie on each other",
    "inside-another": "turns back|lie on each other",
    "two-apart": "2 curves",
    "only-a-dot": "E-D",
    "uneven": "leaves the height",
    "decimal-commas": "E-DXF",
    "cut-off": "E-DXF",
    "not-a-number": "E-",
    "beyond-the-earth": "E-CURVE-NUMBER|E-DXF",
}


@pytest.mark.parametrize("name", UNSOUND)
def test_unsound_files_are_refused_by_name(name):
    with pytest.raises(Refused, match=UNSOUND[name]):
        isomould.inspect(Path(__file__).parent / "unsound" / f"{name}.dxf", layer="RAIL", units="mm")
