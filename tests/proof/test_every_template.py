"""Every template with everything that can be delivered: counted by the test itself, and opened with FreeCAD.

The results stand in docs/proof.md.
"""

import csv
import json
import os
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
import trimesh

import isomould
from museum import TEMPLATES

MEASURES = Path(__file__).parent / "freecad_measures.py"
FREECAD = shutil.which("freecadcmd") or shutil.which("FreeCADCmd")
NAMES = sorted(path.stem for path in TEMPLATES.glob("*.toml"))
EVERYTHING = [
    'deliver.solids=["members", "panels"]',
    'deliver.dxf=["R2010", "R12"]',
    "deliver.labels=true",
    "deliver.drawings=true",
    "deliver.parquet=true",
    'project.datum={origin=["691608.123 m", "5334765.4567 m", "519.25 m"], rotation_deg=33.5}',
]
PROVED = [
    "V13",
    "V20",
    "V21",
    "V22",
    "V23",
    "V24",
    "V25",
    "V26",
    "V40",
    "V41",
    "V42",
    "V42c",
    "V43",
    "V44",
    "V45",
    "V45b",
]

pytestmark = pytest.mark.long


def rows(folder: Path, name: str) -> list[dict[str, str]]:
    path = folder / "tables" / f"{name}.csv"
    return list(csv.DictReader(path.read_text(encoding="utf-8").splitlines())) if path.exists() else []


@pytest.fixture(scope="module", params=NAMES)
def delivered(request, tmp_path_factory):
    """One template at a time, in a folder that is removed after its tests."""
    folder = tmp_path_factory.mktemp(request.param) / "out"
    built = isomould.build(TEMPLATES / f"{request.param}.toml", folder, EVERYTHING, isomould.Run(effort="quick"))
    yield built.folder
    shutil.rmtree(folder)


def test_certificate_and_own_counts(delivered):
    checks = {check.id: check for check in isomould.verify(delivered).checks}
    assert not [check.id for check in checks.values() if check.status == "fail"]
    assert all(checks[name].status == "pass" and checks[name].count > 0 for name in PROVED)
    with np.load(delivered / "model" / "geometry.npz") as mesh:
        marks, instances = set(mesh["node_mark"].tolist()), len(mesh["nodes"])
        placed = {f"{a}_{b}" for k in ("node", "edge", "face")
                  for a, b in zip(mesh[f"{k}_mark"], mesh[f"{k}_location"], strict=True)}  # fmt: skip
    nodes = rows(delivered, "nodes")
    assert {path.stem for path in (delivered / "nodes").glob("*.3mf")} == marks == {row["mark"] for row in nodes}
    assert sum(int(row["quantity"]) for row in nodes) == instances
    scene = trimesh.load(delivered / "model" / "model.glb", process=False)
    assert len(scene.graph.nodes_geometry) >= len(placed)
    for row in nodes:
        solid = trimesh.load(delivered / "nodes" / f"{row['mark']}.stl")
        assert solid.is_watertight
        assert solid.volume / 1e3 == pytest.approx(float(row["volume_cm3"]), rel=1e-5, abs=1e-3)


def nc1_numbers(path: Path) -> tuple[list[str], np.ndarray]:
    """Header and contour of an NC1 file, read here once more."""
    lines = path.read_text(encoding="ascii").splitlines()
    contour = lines[lines.index("AK") + 1 :] if "AK" in lines else []
    points = [[float(x) for x in re.findall(r"-?\d+\.\d+", line)[:2]] for line in contour if line.startswith("  ")]
    stamp = next((k for k, line in enumerate(contour) if not line.startswith("  ")), len(points))
    return [line.strip() for line in lines[1:21]], np.array(points[:stamp])


def test_nc1_files_are_read_back_to_a_hundredth(delivered):
    for row in rows(delivered, "members"):
        header, points = nc1_numbers(delivered / "members" / f"{row['mark']}.nc1")
        assert (header[3], header[5], header[6]) == (row["mark"], row["quantity"], row["section"])
        assert float(header[8].split(",")[0]) == pytest.approx(float(row["cut_length_mm"]), abs=0.01)
        if header[7] == "B":
            assert np.ptp(points[:, 0]) == pytest.approx(float(row["cut_length_mm"]), abs=0.01)


@pytest.fixture(scope="module")
def measured(delivered, tmp_path_factory):
    if FREECAD is None:
        pytest.skip("FreeCAD is not on this machine: install it, and `freecadcmd` opens every drawing and solid")
    target = tmp_path_factory.mktemp("freecad") / "measured.json"
    environment = os.environ | {"DELIVERED": str(delivered), "MEASURED": str(target)}
    subprocess.run([FREECAD, str(MEASURES)], env=environment, check=True, capture_output=True, timeout=1800)
    return json.loads(target.read_text())


def net(found: dict[str, list[float | None]]) -> float:
    """Area of the one contour of a part less its holes; open wires have none."""
    assert len(found["CUT"]) == 1
    assert all(area is not None for areas in found.values() for area in areas)
    return 2 * found["CUT"][0] - sum(sum(areas) for areas in found.values())


def test_freecad_finds_closed_wires_with_the_areas_of_the_schedule(delivered, measured):
    raw = json.loads((delivered / "model" / "design.json").read_text(encoding="utf-8"))
    sections, density = raw["member"]["sections"], raw["member"]["density_kg_m3"] * 1e-9
    areas = measured["areas"]
    for place in ("", "r12/"):
        for row in rows(delivered, "panels"):
            assert net(areas[f"{place}panels/{row['mark']}.dxf"]) / 1e6 == pytest.approx(
                float(row["area_m2"]), rel=1e-9
            )
        for row in rows(delivered, "members"):
            found, section = areas[f"{place}members/{row['mark']}.dxf"], sections[row["section"]]
            if section["kind"] == "plate":
                mass = net(found) * section["thickness"] * density
                assert mass == pytest.approx(float(row["mass_kg"]), abs=0.0005 + 1e-6)
            else:
                assert found["CUT"][0] == pytest.approx(section["depth"] * float(row["cut_length_mm"]), abs=0.6)
        for row in rows(delivered, "sheets"):
            found = areas[f"{place}sheets/{row['sheet']}.dxf"]
            assert len(found["CUT"]) == int(row["parts"])
            assert sum(found["CUT"]) / 1e6 == pytest.approx(float(row["part_area_m2"]), rel=1e-9)
    assert all(area is not None for found in areas.values() for wires in found.values() for area in wires)


def test_freecad_finds_sound_solids_with_the_volumes_of_the_schedule(delivered, measured):
    raw = json.loads((delivered / "model" / "design.json").read_text(encoding="utf-8"))
    solids = measured["solids"]
    assert all(solid["sound"] for solid in solids.values())
    for row in rows(delivered, "nodes"):
        volume = solids[f"nodes/{row['mark']}.stl"]["volume"]
        assert volume / 1e3 == pytest.approx(float(row["volume_cm3"]), rel=1e-4)
    for kind, density in (("members", raw["member"]["density_kg_m3"]), ("panels", raw["panel"]["density_kg_m3"])):
        for row in rows(delivered, kind):
            mass = solids[f"{kind}/{row['mark']}.stl"]["volume"] * density * 1e-9
            assert mass == pytest.approx(float(row["mass_kg"]), rel=2e-3, abs=1e-3)
