"""A toy delivery: two panel classes, one of them handed by its name, with texts that bite."""

import pytest

from isomould.documents.table import make_table
from isomould.documents.totals import make_summary

EVIL = (
    "=1+1",
    "+cmd|' /C calc'!A0",
    "-2+3",
    "@SUM(1)",
    "\t=1",
    "\r=1",
    'a,"b"\nc',
    "http://a.b/c",
    "007",
    "ünï",
)


def panels(**changes):
    columns = {f"side_{side}_mm": [1000.00049, 1200.5] for side in "abcd"}
    columns |= {f"diagonal_{k}_mm": [1500.0, 1600.0] for k in (1, 2)}
    columns |= {f"angle_{k}_deg": [90.00004, None] for k in range(1, 5)}
    columns |= {
        "mark": ["P01", "P02"],
        "quantity": [3, 1],
        "height_mm": [1000.0, 1001.0],
        "outline": ["", "0,0;1,0;1,1"],
        "area_m2": [1.0000005, 0.1],
        "charged_area_m2": [1.1, 0.5],
        "box_width_mm": [1000.0, 1200.0],
        "box_height_mm": [1000.0, 1001.0],
        "mass_kg": [25.0, 2.5],
        "handed": ["none", "L"],
        "files": ["panels/P01.dxf", "panels/P02.dxf"],
    }
    return make_table("panels", columns | changes)


def panel_instances(count=4):
    marks = ["P01"] * (count - 1) + ["P02"]
    nothing, zero = [""] * count, [0.0] * count
    return make_table(
        "panel_instances",
        {
            "location": [f"P-00-{k:02d}" for k in range(count)],
            "mark": marks,
            "i": [0] * count,
            "j": list(range(count)),
            "first_corner": [1] * count,
            "nodes": nothing,
            "members": nothing,
            "packers_mm": ["0;0.5;0;1"] * count,
            "slope_deg": [-0.00001] * count,
            "flatness_mm": zero,
            "sheet": nothing,
            "x_mm": [None] * count,
            "y_mm": [-12.5] * count,
            "rotation_deg": zero,
            "turned_over": [False] * (count - 1) + [True],
            "deviation_mm": zero,
        },
    )


def bars(texts=EVIL):
    count = len(texts)
    return make_table(
        "bars",
        {
            "bar": list(texts),
            "stock": ["FL 200x12"] * count,
            "pieces": [1] * count,
            "used_mm": [0.1] * count,
            "offcut_mm": [-0.25] * count,
            "price": [None] * count,
        },
    )


def checks():
    return make_table(
        "checks",
        {
            "id": ["V1", "V2"],
            "what": ["planarity", "parallels"],
            "count": [4, None],
            "worst": [3.14159265e-13, None],
            "where": ["P-00-01", ""],
            "limit": [1e-6, None],
            "unit": ["mm", ""],
            "status": ["pass", "fail"],
            "reason": ["", "not readable"],
        },
    )


@pytest.fixture
def tables():
    parts = (panels(), panel_instances(), bars())
    return [make_summary([("Greatest deviation", 12.3456, "mm")], parts), *parts, checks()]
