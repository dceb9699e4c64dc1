"""What is loaded by what: a program that answers at once has loaded little. Modules are counted, not seconds."""

import subprocess
import sys

import click
import pytest

from isomould.cli.program import cli
from museum import SMALL, changed

NUMERICS = {"numpy", "scipy", "pandas", "shapely", "ezdxf", "manifold3d", "highspy", "trimesh", "plotly", "reportlab"}
LIBRARIES = NUMERICS | {"pydantic", "openpyxl", "pypdf", "xlsxwriter", "segno"}

RUN = """
import sys
from isomould.cli import main
try:
    main(sys.argv[1:])
except SystemExit as end:
    print("exit", end.code, file=sys.stderr)
print("loaded", *{name.partition(".")[0] for name in sys.modules}, file=sys.stderr)
"""


def loaded_by(*arguments, folder):
    """Exit code of a run of the command line, and the packages that it had loaded at its end."""
    command = [sys.executable, "-c", RUN, *map(str, arguments)]
    run = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=240, check=True)
    *_, ended, loaded = run.stderr.splitlines()
    return int(ended.split()[1]), set(loaded.split()[1:])


@pytest.mark.parametrize("arguments", [["--help"], ["check", "--help"], ["new", "roof"]])
def test_help_and_new_load_no_library(tmp_path, arguments):
    code, loaded = loaded_by(*arguments, folder=tmp_path)
    assert (code, loaded & LIBRARIES) == (0, set())


def test_the_help_page_names_every_command_by_its_own_words():
    """It is written without the commands' modules; each begins its own page with the same words."""
    context = click.Context(cli)
    page = " ".join(cli.get_help(context).split())
    for name in cli.list_commands(context):
        own = " ".join(cli.get_command(context, name).help.split())
        said = page.partition("Commands: ")[2].partition(f"{name} ")[2]
        assert said.split()[:4] == own.split()[:4], name


@pytest.mark.parametrize("verb", [["check"], ["build"], ["compare"]])
def test_files_refused_for_their_syntax_load_no_library(tmp_path, verb):
    (tmp_path / "broken.toml").write_text("rail = ")
    code, loaded = loaded_by(*verb, "broken.toml", folder=tmp_path)
    assert (code, loaded & LIBRARIES) == (2, set())


@pytest.mark.parametrize("verb", [["build"], ["schedule"], ["draw", "--out", "a.svg"]])
def test_files_refused_for_their_keys_load_no_numerics(tmp_path, project_file, verb):
    project_file(changed(SMALL, panels={"gapp": 3}))
    code, loaded = loaded_by(*verb, "project.toml", folder=tmp_path)
    assert (code, loaded & NUMERICS) == (2, set())


def test_curves_by_formula_are_tried_without_readers_of_drawings(tmp_path, project_file):
    """The curves of a file with wrong keys are tried in the same run, so that all its faults are told at once."""
    project_file(changed(SMALL, panels={"gapp": 3}))
    code, loaded = loaded_by("check", "project.toml", folder=tmp_path)
    assert (code, loaded & (LIBRARIES - {"numpy", "scipy", "shapely", "manifold3d", "pydantic"})) == (2, set())


@pytest.mark.parametrize("change", [{"nodes": {"drum_diameter": 30}}])
def test_refused_designs_load_nothing_that_writes(tmp_path, project_file, change):
    project_file(changed(SMALL, **{table: {**SMALL.get(table, {}), **keys} for table, keys in change.items()}))
    code, loaded = loaded_by("check", "project.toml", folder=tmp_path)
    assert (code, loaded & {"plotly", "reportlab", "trimesh", "openpyxl", "pypdf", "xlsxwriter"}) == (2, set())
