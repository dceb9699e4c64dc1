"""The program's other details against the arithmetic of section 8 of docs/worked-example.md."""

from math import radians
from types import SimpleNamespace

import numpy as np
import pytest
import worked_details as hand

from isomould.form.mesh import Family
from isomould.parts.catalogue import find_section
from isomould.parts.details import size_nodes
from isomould.parts.details.fittings import make_fittings
from isomould.parts.nodes import NodeArms
from isomould.parts.settings import BasePlateSettings, FacetedSettings, MemberSettings, SlottedSettings
from isomould.parts.solid import make_solids
from isomould.parts.supports import Drum, _make_base
from museum import SMALL, changed, design

G, P = Family.GENERATRIX, Family.PARALLEL
ARMS = NodeArms(np.radians([0, 90, 180, 270]), np.zeros(4), np.array([G, P, G, P]))
CROSS = SimpleNamespace(arms=(ARMS,), marks=("N01",))


def test_faceted_drum():
    (joint,) = size_nodes(CROSS, MemberSettings(section=find_section("RHS100*50*4")), FacetedSettings())
    assert (joint.distance, joint.diameter, joint.height) == (hand.S, *hand.DRUM)
    assert make_solids(CROSS, (joint,))[0].volume == pytest.approx(hand.drum_volume(), rel=2e-4)


def test_tubes_and_their_end_plates():
    kit = design(changed(SMALL, nodes={"detail": "faceted"}, members={"section": "RHS 100x50x4"})).kit
    away = kit.joints[0].distance - hand.S
    for shape in kit.members.shapes:
        assert shape.cut_length == pytest.approx(shape.system_length - 2 * (hand.S + away), abs=1e-3)
        expected = hand.tube_volume(shape.cut_length + 2 * hand.S)
        assert shape.volume == pytest.approx(expected, rel=1e-12)
    (plate,) = make_fittings(kit.nodes, kit.joints, kit.members)
    assert plate.volume == pytest.approx(hand.END_PLATE, rel=1e-12)


def test_notches_of_caps():
    members = MemberSettings(section=find_section("FL200*12"))
    (joint,) = size_nodes(CROSS, members, SlottedSettings(retention="lipped-cap", bore=20, drum_diameter=90))
    inner, outer, deep = hand.NOTCH
    corners = {tuple(point) for point in joint.end(find_section("FL200*12"), 0.0).outline.round(6).tolist()}
    assert {(round(inner, 6), 100 - deep), (outer, 100 - deep)} <= corners


def test_sills_end_clear_of_the_drum():
    members, asked = MemberSettings(section=find_section("FL200*12")), SlottedSettings(bore=20, drum_diameter=90)
    (joint,) = size_nodes(CROSS, members, asked)
    assert (joint.radius, joint.height) == (45, 200)
    steps = hand.detail_steps()
    assert joint.reach(radians(30)) + joint.clearance == pytest.approx(steps["sill set-back"][0], abs=1e-9)


def test_base_plates():
    drum = Drum(45.0, -50.0, 50.0, np.empty((0, 4)))
    base = _make_base(np.array([1.0, 0.0, 0.0]), drum, 45.0, BasePlateSettings(), "N01")
    steps = hand.detail_steps()
    assert [base.level] == steps["level"]
    assert np.ptp(base.plate, axis=0).tolist() == steps["plate"]
    assert {(abs(hole.x), abs(hole.y)) for hole in base.holes} == {tuple(steps["base holes"])}
    assert base.volume == pytest.approx(hand.BASE, rel=1e-12)
