"""Part lists of others: read as the format says, refused otherwise."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from isomould.errors import OutputFault, Refused
from isomould.intake.instance import parse_instance, read_instance
from isomould.nesting.nest import nest_sheets
from isomould.nesting.search import Search

TRAPEZOID: dict[str, Any] = {"id": 0, "row": 0, "a": 900.0, "b": 880, "h": 700, "ol": 10, "orr": 10}
POLYGON: dict[str, Any] = {"id": "X", "points": [[0, 0], [500, 0], [0, 400]], "quantity": 3}
HEAD: dict[str, Any] = {
    "name": "n",
    "sheet": [3000, 2000],
    "gap": 5,
    "trim": 20,
    "parts": [TRAPEZOID, POLYGON],
}


def text(**changes: Any) -> str:
    return json.dumps({**HEAD, **changes})


def with_part(**changes: Any) -> str:
    return text(parts=[{**TRAPEZOID, **changes}])


def test_instance_is_read() -> None:
    instance = parse_instance(text(kerf=3))
    assert [(part.id, part.quantity, part.row) for part in instance.parts] == [(0, 1, 0), ("X", 3, None)]
    assert instance.parts[0].outline.tolist() == [[0, 0], [900, 0], [890, 700], [10, 700]]
    assert (instance.stock.gap, instance.stock.kerf, instance.stock.trim) == (5, 3, 20)


def test_ids_keep_their_type_through_the_nest() -> None:
    instance = parse_instance(text())
    layout = nest_sheets(instance.parts, instance.stock, Search("quick"))
    assert {item.id for item in layout.placements} == {0, "X"}


def test_outlines_are_rounded_to_micrometres() -> None:
    outline = parse_instance(with_part(a=900.0004, b=880.0004)).parts[0].outline
    assert np.array_equal(outline, np.rint(outline * 1000) / 1000)


def test_triangle_as_trapezoid() -> None:
    assert len(parse_instance(with_part(a=900, b=0, ol=400, orr=500)).parts[0].outline) == 3


BAD: dict[str, tuple[str, str]] = {
    "not JSON": ("{", "instance"),
    "not a table": ("[]", "instance"),
    "NaN": (with_part().replace("900.0", "NaN"), "NaN"),
    "infinite": (with_part().replace("900.0", "Infinity"), "Infinity"),
    "overflow": (with_part().replace("900.0", "1e999"), r"parts\[0\].a"),
    "key twice": (with_part().replace('"row"', '"id"'), "'id' is given twice"),
    "no gap": (json.dumps({key: HEAD[key] for key in HEAD if key != "gap"}), "gap: missing"),
    "no id": (text(parts=[{key: TRAPEZOID[key] for key in TRAPEZOID if key != "id"}]), "id: missing"),
    "no height": (text(parts=[{key: TRAPEZOID[key] for key in TRAPEZOID if key != "h"}]), "h: missing"),
    "text for number": (with_part(h="700"), r"parts\[0\].h: '700'"),
    "yes for number": (with_part(h=True), r"parts\[0\].h: True"),
    "null for number": (with_part(a=None), r"parts\[0\].a: None"),
    "id twice": (text(parts=[TRAPEZOID, TRAPEZOID]), r"parts\[1\].id"),
    "id yes": (with_part(id=True), "id"),
    "unknown key": (text(kerff=1), "Did you mean kerf"),
    "unknown part key": (with_part(qantity=1), "Did you mean quantity"),
    "no parts": (text(parts=[]), "parts"),
    "sheet of one number": (text(sheet=[3000]), "sheet"),
    "sheet of nothing": (text(sheet=[0, 2000]), "sheet"),
    "negative gap": (text(gap=-1), "gap"),
    "trim eats the sheet": (text(trim=1000), "trim"),
    "kerf wider than gap": (text(kerf=6), "kerf"),
    "flat": (with_part(h=0), r"parts\[0\]"),
    "bases do not fit": (with_part(b=870), r"parts\[0\].b"),
    "none to cut": (with_part(quantity=0), "quantity"),
    "half a part": (with_part(quantity=1.5), "quantity"),
    "too many": (with_part(quantity=10**9), "pieces"),
    "two points": (text(parts=[{"id": 1, "points": [[0, 0], [1, 1]]}]), "points"),
    "bow-tie": (text(parts=[{"id": 1, "points": [[0, 0], [9, 9], [9, 0], [0, 9]]}]), "simple polygon"),
    "deep": ("[" * 100_000, "instance"),
}


@pytest.mark.parametrize(("bad", "field"), BAD.values(), ids=BAD.keys())
def test_bad_instance_is_refused_with_its_field(bad: str, field: str) -> None:
    with pytest.raises(Refused, match=field):
        parse_instance(bad)


def test_file_is_named(tmp_path: Path) -> None:
    path = tmp_path / "list.json"
    path.write_text(text(gap=None))
    with pytest.raises(Refused, match=r"list\.json: gap: None"):
        read_instance(path)


def test_file_that_is_not_text_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "list.json"
    path.write_bytes(b"\xff\xfe")
    with pytest.raises(Refused, match="UTF-8"):
        read_instance(path)


def test_missing_file_is_a_fault(tmp_path: Path) -> None:
    with pytest.raises(OutputFault, match="nothing"):
        read_instance(tmp_path / "nothing.json")
