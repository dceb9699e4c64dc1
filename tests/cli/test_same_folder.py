"""Same input, same bytes: whatever the number of processes, the hash seed and the time zone."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from museum import DELIVERED


def files(folder: Path) -> dict[str, bytes]:
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.mark.slow
def test_two_builds_are_the_same_bytes(project_file, tmp_path, built_folder):
    project = project_file(DELIVERED)
    environment = {**os.environ, "PYTHONHASHSEED": "4711", "TZ": "Pacific/Apia", "LC_ALL": "C"}
    command = [sys.executable, "-m", "isomould", "build", project, "--out", tmp_path / "other"]
    options = ["--effort", "quick", "--jobs", "2", "--quiet"]
    subprocess.run([*map(str, command), *options], env=environment, check=True, timeout=240, capture_output=True)
    one, other = files(built_folder), files(tmp_path / "other")
    assert one.keys() == other.keys()
    assert [name for name in one if one[name] != other[name] and name != "manifest.json"] == []
