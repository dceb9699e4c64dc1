"""What all tests share. Example designs live in `museum`."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import isomould
from museum import DELIVERED, write_project


def pytest_addoption(parser: pytest.Parser) -> None:
    """Let the long run build as many plausible projects as are asked for."""
    parser.addoption("--plausible", type=int, default=40, help="random projects that the long run builds")


@pytest.fixture(scope="session")
def built_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A small project, delivered with sheets, bars, R12 twins and a datum; copy it before changing it."""
    folder = tmp_path_factory.mktemp("built")
    project = write_project(folder / "small.toml", DELIVERED)
    return isomould.build(project, folder / "small", run=isomould.Run(effort="quick", jobs=1)).folder


@pytest.fixture
def project_file(tmp_path: Path) -> Callable[[dict[str, Any]], Path]:
    """Write a project's tables to a file in a folder of the test's own."""
    return lambda data: write_project(tmp_path / "project.toml", data)
