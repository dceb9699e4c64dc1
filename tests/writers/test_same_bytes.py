"""The same values give the same bytes: twice, later, and whatever the hash seed."""

import hashlib
import os
import subprocess
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).parent


def write_all(folder):
    """Write one file of every format; imported by the other process too."""
    import conftest  # noqa: PLC0415
    from isomould.documents.cut_sheets import part_drawing  # noqa: PLC0415
    from isomould.documents.info import ProjectInfo  # noqa: PLC0415
    from isomould.documents.totals import make_summary  # noqa: PLC0415
    from isomould.writers.csv import write_csv  # noqa: PLC0415
    from isomould.writers.dxf import write_dxf  # noqa: PLC0415
    from isomould.writers.model import Instance, write_glb, write_npz, write_obj  # noqa: PLC0415
    from isomould.writers.solids import write_3mf, write_stl  # noqa: PLC0415
    from isomould.writers.xlsx import Words, write_workbook  # noqa: PLC0415

    corners = np.array([[0, 0, 0], [900, 0, 0], [0, 800, 0], [0, 0, 50]], float)
    solid = (corners, np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]))
    parts = (conftest.panels(), conftest.panel_instances(), conftest.bars())
    tables = (make_summary([], parts), *parts, conftest.checks())
    outline = np.array([[0, 0], [900, 0], [800, 700], [50, 700]], float)
    write_csv(folder / "bars.csv", conftest.bars())
    write_workbook(folder / "schedules.xlsx", tables, Words(ProjectInfo(name="Vault")))
    for version in ("R2010", "R12"):
        write_dxf(folder / f"{version}.dxf", part_drawing("P01", outline), version=version)
    write_3mf(folder / "N01.3mf", *solid, "N01")
    write_stl(folder / "N01.stl", *solid)
    write_npz(folder / "geometry.npz", {"nodes": corners, "node_mark": np.array(["N01"] * 4)})
    write_obj(folder / "mesh.obj", corners, np.array([0, 1, 2]), np.array([0, 3]), ["P01 P-00-00"])
    marks = [f"N{k:02d}" for k in range(12)]
    instances = [Instance(mark, f"N-00-{k:02d}", np.eye(4)) for k, mark in enumerate(marks)]
    write_glb(folder / "model.glb", dict.fromkeys(marks, solid), instances)


def hashes(folder):
    return {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in sorted(folder.iterdir())}


def in_another_process(folder, seed, zone):
    code = "import pathlib, sys, test_same_bytes as t; t.write_all(pathlib.Path(sys.argv[1]))"
    paths = os.pathsep.join([str(HERE), *(path for path in sys.path if path)])
    environment = {**os.environ, "PYTHONHASHSEED": seed, "TZ": zone, "PYTHONPATH": paths}
    subprocess.run([sys.executable, "-c", code, str(folder)], env=environment, check=True, timeout=120)
    return hashes(folder)


def test_the_same_bytes_twice_and_under_another_hash_seed_and_time_zone(tmp_path):
    for name in ("one", "two"):
        (tmp_path / name).mkdir()
    first = in_another_process(tmp_path / "one", "1", "UTC")
    second = in_another_process(tmp_path / "two", "4242", "Asia/Tokyo")
    assert len(first) == 9
    assert first == second
