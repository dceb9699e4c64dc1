"""The templates: what their first lines say, how they are found, and the three briefs that an architect starts from."""

import re

import numpy as np
import pytest

from isomould.errors import Refused
from isomould.form.mesh import NodeKind
from isomould.measure.faces import aspect_ratios
from isomould.measure.take_off import take_off
from isomould.templates import copy_template, describe_template, near_templates, template_folder, template_names
from museum import design, template


def head(name: str) -> list[str]:
    """Paragraphs of a template's first comment."""
    text = (template_folder() / f"{name}.toml").read_text(encoding="utf-8")
    lines = text[: text.index("\nschema")].splitlines()
    return [" ".join(part.split()) for part in "\n".join(line[2:] for line in lines).split("\n\n")]


@pytest.mark.parametrize("name", template_names())
def test_one_sentence_without_figures_of_the_paper(name):
    said = describe_template(name)
    assert said == head(name)[0]
    assert re.fullmatch(r"[A-Z][^.]*\.", said)
    assert len(said.split()) <= 24
    assert "Fig" not in said


@pytest.mark.parametrize("name", template_names())
def test_a_brief_with_size_use_and_loads(name):
    briefs = [part for part in head(name) if part.startswith("Brief: ")]
    assert len(briefs) == 1
    assert re.search(r"\d m\b", briefs[0])
    assert "To be proved by the engineer: " in briefs[0]
    assert briefs[0].count("kN/m²") >= 2


@pytest.mark.parametrize("name", template_names())
def test_where_the_building_lies(name):
    places = head(name)[-2:] + head(name)[-3:-2]
    assert name == "canopy-from-dxf" or any(re.search(r"\b[xyz] = |origin|z is height", place) for place in places)


def test_names_with_a_word_in_them_are_offered(tmp_path):
    domes = [name for name in template_names() if "dome" in name]
    assert list(near_templates("dome")) == domes
    with pytest.raises(Refused) as refusal:
        copy_template("dome", tmp_path / "roof.toml")
    assert all(f"{name}: {describe_template(name)}" in refusal.value.way_out for name in domes)
    assert near_templates("barel-vault")[0] == "barrel-vault"
    assert near_templates("qqqqqq") == template_names()


BRIEFS = {
    "covered-street": ((24, 60), (2500, 2500), 13),
    "stadium-canopy": ((72, 35.8), (3200, 2600), 16),
    "courtyard-dome": ((18, 16.4), (2000, 2000), 5),
}
"""Plan in m, largest panel in mm, node classes inside (at most 24 asked for on the street)."""


@pytest.mark.parametrize("name", BRIEFS)
def test_three_briefs(name):
    plan, largest, inside = BRIEFS[name]
    kit = design(template(name)).kit
    mesh = kit.mesh
    assert np.ptp(mesh.nodes, axis=0)[:2] / 1000 == pytest.approx(plan, abs=0.06)
    boxes = take_off(mesh, kit.arms).boxes
    assert (boxes.max(axis=0) <= largest).all()
    assert aspect_ratios(mesh).max() < 6
    assert np.isin(kit.nodes.kind, (NodeKind.INTERIOR, NodeKind.FLAT)).sum() == inside


def test_feet_of_the_street_are_level():
    """The section stands upright on the ground, so its outside is level there: no trim, no class of supports."""
    mesh = design(template("covered-street")).kit.mesh
    feet = mesh.nodes.reshape(*mesh.shape, 3)[:, [0, -1], 2]
    assert abs(feet).max() < 1e-6
