"""Rounding noise decides nothing: designs that differ by 1e-13 have the same marks, arms, pictures and drawings."""

import re
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from isomould.design import kit_settings
from isomould.documents.shop.view import fit_scale
from isomould.documents.views import space_picture
from isomould.parts.congruence import classify, handedness
from isomould.parts.kit import make_kit
from isomould.ties import first_largest, first_least, first_least_of_rows, in_order, ranks
from isomould.writers.svg import svg_text
from museum import MONGE, SMALL, VAULT, changed, design, dome, sphere, template, trimmed

NOISE = 1e-13
DESIGNS = {
    "torus": changed(template("torus"), rail={"divide": {"nodes": 12}}),
    "sphere": sphere(20, 70),
    "vault": changed(VAULT, rail={"divide": {"nodes": 8}}, generatrix={"divide": {"per_arc": 3}}),
    "dome": trimmed(dome(10)),
    "small": SMALL,
    "monge": MONGE,
}


@cache
def made(name):
    return design(DESIGNS[name])


def noisy(mesh, seed):
    """Give a mesh as another processor might compute it: every number off by some of its last digits."""
    random = np.random.default_rng(seed)
    reach = np.abs(mesh.nodes).max()
    nodes = mesh.nodes + NOISE * reach * random.uniform(-1, 1, mesh.nodes.shape)
    axes = mesh.axes + NOISE * random.uniform(-1, 1, mesh.axes.shape)
    return replace(mesh, nodes=nodes, axes=axes)


def parts_of(kit):
    """Everything about a kit that names, counts or orders."""
    nodes, members, panels = kit.nodes, kit.members, kit.panels
    return {
        "nodes": nodes.classes.of.tolist(),
        "arms": nodes.arm_rows.tolist(),
        "arm edges": [kit.arms.edge[row[row >= 0]].tolist() for row in nodes.arm_rows],
        "node hands": nodes.handed,
        "members": members.classes.of.tolist(),
        "member variants": members.classes.variant.tolist(),
        "panels": panels.classes.of.tolist(),
        "first corners": panels.first_corner.tolist(),
        "turned over": panels.turned_over.tolist(),
        "panel hands": panels.handed,
        "outlines": [outline.tolist() for outline in panels.outlines],
    }


VIEWS = ("plan", "elevation", "axonometry")


@pytest.mark.parametrize("name", DESIGNS)
def test_noise_leaves_marks_arms_and_pictures_as_they_are(name):
    one = made(name)
    wanted = kit_settings(one.project)
    parts = parts_of(one.kit)
    pictures = [svg_text(space_picture(one.kit, name, view)) for view in VIEWS]
    for seed in range(2):
        kit = make_kit(noisy(one.kit.mesh, seed), wanted)
        other = parts_of(kit)
        assert [key for key in parts if other[key] != parts[key]] == []
        assert [svg_text(space_picture(kit, name, view)) for view in VIEWS] == pictures


def longer(value, share):
    """Give numbers and lengths that are not whole, and those with units, in all tables, longer by a share."""
    if isinstance(value, dict):
        return {key: longer(inner, share) for key, inner in value.items()}
    if isinstance(value, list | tuple):
        return [longer(inner, share) for inner in value]
    if isinstance(value, str) and (found := re.fullmatch(r"([\d.]+) m", value)):
        return f"{float(found[1]) * (1 + share):.17g} m"
    return value * (1 + share) if isinstance(value, float) else value


@pytest.mark.parametrize("share", [NOISE, -NOISE])
@pytest.mark.parametrize("name", ["small", "vault", "dome", "sphere"])
def test_curves_that_differ_by_noise_give_the_same_design(name, share):
    data = DESIGNS[name]
    tables = {table: longer(data[table], share) for table in ("rail", "generatrix")}
    one, other = made(name), design({**data, **tables})
    parts, noise = parts_of(one.kit), parts_of(other.kit)
    assert [key for key in parts if noise[key] != parts[key]] == []
    for view in VIEWS:
        assert svg_text(space_picture(other.kit, name, view)) == svg_text(space_picture(one.kit, name, view))


VALUES = st.lists(st.sampled_from([0.0, 1.0, 2.5, 1000.0]), min_size=1, max_size=8)


@settings(max_examples=25)
@given(VALUES, st.integers(0, 2**32 - 1))
@example([1.0, 1.0], 0)
def test_ties_are_in_the_order_they_stand(values, seed):
    exact = np.array(values)
    blurred = exact + 1e-10 * np.random.default_rng(seed).uniform(-1, 1, len(exact))
    assert ranks(blurred).tolist() == ranks(exact).tolist()
    assert in_order(blurred).tolist() == np.argsort(exact, kind="stable").tolist()
    assert first_least(blurred) == int(exact.argmin())
    assert first_largest(blurred) == int(exact.argmax())
    assert first_least_of_rows(np.stack([blurred, blurred[::-1]])).tolist() == [exact.argmin(), exact[::-1].argmin()]


def test_infinite_values_come_last_and_are_equal():
    assert ranks(np.array([np.inf, 1.0, np.inf, -np.inf])).tolist() == [2, 1, 2, 0]
    assert first_least(np.array([np.inf, np.inf])) == 0


def test_what_differs_by_just_the_tolerance_is_one_class():
    labels = np.zeros((2, 1, 1), dtype=np.int64)
    for noise in (-NOISE, 0.0, NOISE):
        numbers = np.array([[[100.0]], [[100.5 + 100 * noise]]])
        assert len(classify(numbers, labels, np.array([0.5])).quantity) == 1


def test_a_hand_is_not_decided_by_noise_at_the_tolerance():
    labels = np.zeros((1, 1, 1), dtype=np.int64)
    for noise in (-NOISE, 0.0, NOISE):
        own, mirror = np.array([[[100.0, 200.0]]]), np.array([[[100.5 + 100 * noise, 199.5]]])
        assert handedness((own, labels), (mirror, labels), np.array([0.5, 0.5])) == ("none",)


@pytest.mark.parametrize("noise", [-NOISE, 0.0, NOISE])
def test_a_view_that_just_fits_keeps_its_scale(noise):
    assert fit_scale((4800 * (1 + noise), 100.0), (240.0, 60.0)) == 20.0
