"""The documentation says what the program is: keys, modules, commands, licence of every claim that can be checked."""

import re
from pathlib import Path
from typing import get_args

import click
import pytest

import isomould
from isomould.cli import cli
from isomould.project.schema import Project
from isomould.settings import Settings

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"


def settings_in(annotation) -> set[type[Settings]]:
    if isinstance(annotation, type) and issubclass(annotation, Settings):
        return {annotation}.union(*(settings_in(field.annotation) for field in annotation.model_fields.values()))
    return set().union(*(settings_in(part) for part in get_args(annotation)))


KEYS = sorted({f.alias or name for model in settings_in(Project) for name, f in model.model_fields.items()})


@pytest.mark.parametrize("key", KEYS)
def test_every_key_of_a_project_is_documented(key):
    text = (DOCS / "project-file.md").read_text(encoding="utf-8")
    assert re.search(rf"\b{key}\b", text), key


def test_documented_tables_exist():
    text = (DOCS / "project-file.md").read_text(encoding="utf-8")
    tables = re.findall(r"^## \[(\w+)\]", text, re.MULTILINE)
    assert tables
    assert set(tables) <= set(Project.model_fields)


def test_every_room_and_module_of_the_architecture_exists():
    text = (DOCS / "architecture.md").read_text(encoding="utf-8")
    source = ROOT / "src" / "isomould"
    rooms = re.findall(r"^\*\*(\w+)/\*\*(.*?)(?=^\*\*|^## )", text, re.MULTILINE | re.DOTALL)
    assert {room for room, _ in rooms} == {path.name for path in source.iterdir() if (path / "__init__.py").exists()}
    top = re.findall(r"^\| (`[\w`, ]+`) \|", text, re.MULTILINE)
    named = {name for cell in top for name in re.findall(r"\w+", cell)}
    modules = {path.stem for path in source.glob("*.py")} - {"__init__", "__main__"}
    assert named == modules


def test_commands_have_functions_and_documentation():
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    commands = cli.list_commands(click.Context(cli))
    assert commands
    for command in commands:
        assert callable(getattr(isomould, command))
        assert f"isomould {command}" in text


def test_readme_links_exist():
    for page in [ROOT / "README.md", *DOCS.glob("*.md")]:
        for target in re.findall(r"\]\(([^)#:]+)\)", page.read_text(encoding="utf-8")):
            assert (page.parent / target).exists(), f"{page.name}: {target}"
