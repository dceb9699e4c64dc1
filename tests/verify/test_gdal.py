"""GDAL, which shares no code with the program, opens the machine files of a delivery and finds the schedule's areas."""

import csv
from collections import Counter
from pathlib import Path

import pyogrio
import pytest
import shapely

STEEL, THICKNESS = 7850e-9, 12.0
STOCK = 4000.0 * 2500.0
"""Of the project of the session's folder, mm²."""


def rings(path: Path) -> list[tuple[str, shapely.Polygon]]:
    """Layer and area of every contour and hole of a drawing; every one of them is a closed wire."""
    _, _, shapes, fields = pyogrio.raw.read(path, columns=["Layer"])
    lines = [
        (layer, line)
        for layer, line in zip(fields[0], shapely.from_wkb(shapes), strict=True)
        if layer in {"CUT", "CUT_INNER", "DRILL", "SHEET"}
    ]
    assert all(line.geom_type == "LineString" and line.is_ring for _, line in lines), path
    return [(layer, shapely.Polygon(line)) for layer, line in lines]


def net(path: Path) -> float:
    """Area of the one part of a drawing without its holes, mm²."""
    found = rings(path)
    assert Counter(layer for layer, _ in found)["CUT"] == 1, path
    return sum(ring.area if layer == "CUT" else -ring.area for layer, ring in found)


@pytest.fixture(scope="module", autouse=True)
def fine_arcs():
    """GDAL makes chords of arcs, by default every 4°."""
    pyogrio.set_gdal_config_options({"OGR_ARC_STEPSIZE": "0.5"})
    yield
    pyogrio.set_gdal_config_options({"OGR_ARC_STEPSIZE": None})


def rows(folder: Path, name: str) -> list[dict[str, str]]:
    with (folder / "tables" / f"{name}.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


@pytest.mark.parametrize("twins", ["", "r12"])
def test_panels_members_and_sheets(built_folder, twins):
    place = built_folder / twins
    for row in rows(built_folder, "panels"):
        assert net(place / "panels" / f"{row['mark']}.dxf") / 1e6 == pytest.approx(float(row["area_m2"]), rel=1e-9)
    for row in rows(built_folder, "members"):
        mass = net(place / "members" / f"{row['mark']}.dxf") * THICKNESS * STEEL
        assert mass == pytest.approx(float(row["mass_kg"]), abs=0.0005 + 1e-9)
    placed = 0
    for row in rows(built_folder, "sheets"):
        found = rings(place / row["file"])
        parts = [ring for layer, ring in found if layer == "CUT"]
        assert [ring.area for layer, ring in found if layer == "SHEET"] == [STOCK]
        assert len(parts) == int(row["parts"])
        assert sum(part.area for part in parts) / 1e6 == pytest.approx(float(row["part_area_m2"]), rel=1e-9)
        placed += len(parts)
    assert placed == sum(int(row["quantity"]) for row in rows(built_folder, "panels")) > 20


def test_nodes(built_folder):
    """The plan of a slotted drum times its height is its volume; chords of 0.5° leave a few parts in 100 000 out."""
    for row in rows(built_folder, "nodes"):
        found = net(built_folder / "nodes" / f"{row['mark']}.dxf") * float(row["drum_height_mm"])
        assert found / 1e3 == pytest.approx(float(row["volume_cm3"]), rel=1e-4)
