"""V31-V35 on one sheet with four trapezoids, and on one bar."""

from dataclasses import replace

import numpy as np
import pytest
from verify_museum import holding, status, table, vault, with_raw

from isomould.verify.checks import bars, nesting
from isomould.verify.read.dxf import Drawing, Outline
from isomould.verify.read.layout import Layout, Placement

RULES = (*nesting.RULES, *bars.RULES)
PART = np.array([[0, 0], [1000, 0], [900, 500], [200, 500.0]])
AREA = 425000.0


def placements():
    """Head to tail: upright, then turned by 180°; the second row in the other order."""
    turned = PART.max(axis=0) - PART
    found = []
    for k, (points, at) in enumerate(
        [(PART, (20, 20)), (turned, (1150, 20)), (turned, (20, 525)), (PART, (1250, 525))]
    ):
        placed = points - points.min(axis=0) + at
        found.append(Placement("P01", f"P-00-{k:02d}", "S001", placed, 180.0 if points is turned else 0.0, False))
    return found


def row(y, first):
    """Two panels apart along their legs, then what is right of them off; the line leans as the legs do."""
    foot, head = (1097.5, 997.5) if first == 0 else (1122.5, 1222.5)
    return {
        "lines": [[[foot, y], [head, y + 500]], [[2600.0, y], [2600.0, y + 1]]],
        "pieces": [{"placement": first}, {"placement": first + 1}, {}],
    }


TREE = {
    "lines": [[[1.0, 522.5], [0.0, 522.5]], [[1.0, 1027.5], [0.0, 1027.5]]],
    "pieces": [row(20, 0), row(525, 2), {}],
}
SLANT = float(np.hypot(100, 500) / 500)
# Two strips cut off, of which the kerf of 3 mm leaves 501 and 502 mm; in each one cut along the legs and one upright.
CUTTING = {"cuts": 6, "cut_length_mm": 2 * 2960 + (501 + 502) * (1 + SLANT)}


def outline(points, layer="CUT"):
    return Outline(layer, points, np.zeros(len(points)), True)


def drawing(placed, width=3000.0, height=1200.0):
    sheet = np.array([[0, 0], [width, 0], [width, height], [0, height]])
    cuts = [outline(p) for p in placed]
    return Drawing("S001", 4, (), (outline(sheet, "SHEET"), *cuts), ())


def delivery(
    *, placed=None, drawn=None, part=PART, unplaced=(), quantity=4, sheet="S001", tree=TREE, cutting=CUTTING, **columns
):
    placed = placements() if placed is None else placed
    share = 4 * AREA / (3000 * 1200)
    raw = {"yield_percent": 100 * share, "bound": 1, "unplaced": list(unplaced), "cut_tree": {"S001": tree}, **cutting}
    rows = {
        "sheet": ["S001"],
        "parts": [4],
        "part_area_m2": [4 * AREA / 1e6],
        "yield_percent": [round(100 * share, 3)],
    }
    tables = {
        "panels": table("panels", mark=["P01"], quantity=[quantity]),
        "panel_instances": table(
            "panel_instances", location=[f"P-00-{k:02d}" for k in range(4)], mark=["P01"] * 4, sheet=[sheet] * 4
        ),
        "sheets": table("sheets", **{**rows, **columns}),
    }
    return holding(
        design=vault().design,
        tables=tables,
        panels={"P01": Drawing("P01", 4, (), (outline(part),), ())},
        layout=Layout({"S001": (3000.0, 1200.0)}, tuple(placed), raw),
        sheets={"S001": drawing([p.points for p in placed] if drawn is None else drawn)},
    )


def shifted(k, by):
    placed = placements()
    placed[k] = replace(placed[k], points=placed[k].points + by)
    return placed


def points(placed):
    return [p.points for p in placed]


def mirrored(k, **flags):
    placed = placements()
    low = placed[k].points.min(axis=0)
    flipped = PART * [-1, 1]
    placed[k] = replace(placed[k], points=(flipped - flipped.min(axis=0) + low)[::-1], **flags)
    return placed


@pytest.mark.parametrize("rule", nesting.RULES, ids=lambda rule: rule.id)
def test_a_good_layout_passes(rule):
    check = status(RULES, rule.id, delivery())
    assert check.status == "pass", check


TWICE = [*placements()[:3], placements()[2]]
FAULTS = [
    ("V31", {"quantity": 5}),
    ("V31", {"placed": placements()[1:]}),
    ("V31", {"sheet": "S002"}),
    ("V31", {"unplaced": [{"id": "P01", "reason": "no room"}]}),
    ("V31", {"placed": TWICE}),
    ("V31b", {"drawn": points(shifted(1, 0.1))}),
    ("V31b", {"drawn": points(placements())[1:]}),
    ("V31b", {"drawn": points(TWICE)}),
    ("V31b", {"drawn": points(mirrored(0))}),
    ("V32", {"placed": mirrored(0)}),
    ("V32", {"part": PART * [1, 1.0001]}),
    ("V32", {"placed": mirrored(0, turned_over=True)}),
    ("V32", {"placed": [replace(placements()[0], rotation_deg=180.0)]}),
    ("V32", {"placed": [replace(placements()[0], rotation_deg=17.0)]}),
    ("V33", {"placed": shifted(1, [-226.0, 0])}),
    ("V33", {"placed": shifted(2, [0, -0.1])}),
    ("V33", {"placed": TWICE}),
    ("V33b", {"placed": shifted(0, [-0.1, 0])}),
    ("V33b", {"drawn": [*points(placements())[:3], PART + 2500]}),
    ("V34", {"part_area_m2": [1.7001]}),
    ("V34", {"parts": [3]}),
    ("V34b", {"yield_percent": [47.2]}),
    ("V35", {"placed": placements() * 3}),
    ("V35b", {"placed": shifted(1, [-160.0, 0])}),
    ("V35b", {"placed": shifted(2, [0, -1.1])}),
    ("V35b", {"tree": {"placement": 0}}),
    ("V35b", {"tree": TREE | {"lines": TREE["lines"][::-1]}}),
    ("V35b", {"cutting": {"cut_tree": None}}),
    ("V35b", {"tree": TREE | {"pieces": TREE["pieces"][:2]}}),
    ("V35c", {"cutting": CUTTING | {"cuts": 5}}),
    ("V35c", {"cutting": CUTTING | {"cut_length_mm": CUTTING["cut_length_mm"] + 0.001}}),
]


@pytest.mark.parametrize(("rule", "fault"), FAULTS, ids=map(str, range(len(FAULTS))))
def test_faults_are_found(rule, fault):
    assert status(RULES, rule, delivery(**fault)).status == "fail"


def test_turning_over_is_allowed_where_panels_are_flippable():
    turned = delivery(placed=mirrored(0, turned_over=True))
    assert status(RULES, "V32", with_raw(turned, panel={"flippable": True})).status == "pass"


def test_a_gap_just_as_asked_passes_and_a_micrometre_less_fails():
    level = placements()[2].points[:, 1].min() - placements()[0].points[:, 1].max()
    assert level == 5.0
    assert status(RULES, "V33", delivery(placed=shifted(2, [0, -0.001]))).status == "fail"


PLATE = np.array([[0, 0], [480, 0], [500, 100], [20, 100.0]])
"""A parallelogram of 500 x 100 mm: turned end for end it is the same, upside down it leans the other way."""


def bar_delivery(
    positions=(10.0, 493.06, 976.12),
    pieces=3,
    offcut=(5990 - 1476.12,),
    bar="B001",
    turned=("none", "end_for_end", "none"),
):
    tables = {
        "member_instances": table(
            "member_instances",
            location=["a", "b", "c", "d"],
            mark=["M01"] * 4,
            bar=["B001"] * 3 + [bar],
            position_mm=[*positions, 1519 if bar == "B001" else 10],
            bar_turned=[*turned, "none"],
        ),
        "bars": table(
            "bars", bar=["B001", "B002"], stock=["x", "x"], pieces=[pieces, 1], offcut_mm=[*offcut, 5990 - 510.0]
        ),
    }
    members = {"M01": Drawing("M01", 4, (), (outline(PLATE),), ())}
    return holding(design=vault().design, tables=tables, members=members)


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        ({"bar": "B002"}, "pass"),
        ({"bar": "B002", "positions": (10.0, 493.0, 976.12)}, "fail"),
        ({"bar": "B002", "positions": (9.0, 493.06, 976.12)}, "fail"),
        ({"bar": "B002", "turned": ("none", "upside_down", "none")}, "fail"),
        ({"bar": "B002", "pieces": 4}, "fail"),
        ({"bar": "B002", "offcut": (4400.0,)}, "fail"),
        ({"bar": "B003"}, "fail"),
    ],
)
def test_bars(change, expected):
    assert status(RULES, "V34c", bar_delivery(**change)).status == expected


def test_the_list_for_the_saw_is_the_schedule(tmp_path):
    (tmp_path / "bars").mkdir()
    for content, expected in (("B001", "pass"), ("B002", "fail")):
        (tmp_path / "bars" / "bars.csv").write_bytes(f"bar\r\n{content}\r\n".encode())
        tables = {"bars": table("bars", bar=["B001"]), "member_instances": table("member_instances", bar=["B001"])}
        assert status(RULES, "V34d", holding(folder=tmp_path, tables=tables)).status == expected


def test_no_bars_do_not_apply():
    plain = bar_delivery()
    plain.tables["member_instances"] = table("member_instances", location=["a"], bar=[""])
    del plain.tables["bars"]
    assert status(RULES, "V34c", plain).status == "not_applicable"
