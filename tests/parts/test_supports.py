"""Base plates by hand, and what is refused about them."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import museum
from isomould.design import kit_settings
from isomould.errors import Refused
from isomould.form.mesh import Family, NodeKind
from isomould.parts.building import make_shapes
from isomould.parts.clash import refuse_clashes
from isomould.parts.nodes import NodeArms
from isomould.parts.outline import area
from isomould.parts.settings import BasePlateSettings, MemberSettings
from isomould.parts.solid import make_solids
from isomould.parts.supports import Drum, _make_base, _reach, make_bases, up_directions

DOME = museum.trimmed(museum.dome(5.2, nodes=6))
ASKED = BasePlateSettings()
MEMBERS = MemberSettings(section="FL120*10")


ROUND = Drum(45.0, -50.0, 50.0, np.empty((0, 4)))
CORNERS = np.array([[47.0, 60.0], [47.0, -60.0]])


def joint(height=100.0, radius=45.0):
    """A drum with members that end beside it, 10 mm wide."""
    stack = ((radius, height / 2),)
    end = SimpleNamespace(outline=CORNERS)
    return SimpleNamespace(stack=stack, under=stack, end=lambda *_: end, hold=lambda _: (10.0, 0.0))


def arms(elevation_deg=90.0 - 1e-3, family=Family.GENERATRIX):
    return NodeArms(np.array([0.0]), np.radians([elevation_deg]), np.array([int(family)]))


def test_a_drum_that_lies_on_its_side_by_hand():
    """Axis level, member rising: the plate's top is a radius and the clearance below, its stem a rectangle."""
    up = np.array([1.0, 0.0, 0.0])
    flat = arms(0.0)
    assert _reach(flat, up, joint(), MEMBERS) == pytest.approx(45.0)
    base = _make_base(up, ROUND, 45.0, ASKED, "N01")
    assert base.level == 55.0
    assert np.ptp(base.plate, axis=0).tolist() == [2 * (50 + 60), 2 * (45 + 60)]
    assert np.ptp(base.stem, axis=0) == pytest.approx([0.9 * 100, 10.0])
    assert {(hole.x, hole.y) for hole in base.holes} == {(x, y) for x in (-80.0, 80.0) for y in (-75.0, 75.0)}
    steel = (220 * 210 - 4 * np.pi / 4 * 18**2) * 15 + 90 * 10 * 15
    assert base.volume == pytest.approx(steel, rel=1e-12)
    assert base.frame[:3, 3] == pytest.approx([-55, 0, 0])


def test_a_drum_that_leans_by_hand():
    """At 45° the lowest corner is (R + H/2)/√2 down; the stem's notch ends there, the clearance above its foot."""
    up = np.array([1.0, 0.0, 1.0]) / np.sqrt(2)
    reach = _reach(arms(0.0), up, joint(), MEMBERS)
    assert reach == pytest.approx(95 / np.sqrt(2))
    base = _make_base(up, ROUND, reach, ASKED, "N01")
    assert base.level == np.ceil(95 / np.sqrt(2) + 10)
    lowest = base.stem[np.argsort(base.stem[:, 1])[2]]
    assert lowest == pytest.approx([(45 - 50) / np.sqrt(2), base.level - 95 / np.sqrt(2)], abs=1e-3)
    seat = 0.9 * 45 * np.sqrt(2)
    rectangle = 2 * seat * (base.level - 95 / np.sqrt(2))
    left, right = seat + lowest[0], seat - lowest[0]
    assert area(base.stem) == pytest.approx(rectangle + (left**2 + right**2) / 2, rel=1e-5)


def test_a_drum_that_stands_upright():
    up = np.array([0.0, 0.0, 1.0])
    base = _make_base(up, ROUND, 60.0, ASKED, "N01")
    assert np.ptp(base.plate, axis=0).tolist() == [210.0, 210.0]
    assert np.ptp(base.stem, axis=0) == pytest.approx([81.0, 20.0])


def test_a_drum_that_is_longer_on_one_side_by_hand():
    """Axis level along +x, 70 to the outside and 30 to the inside: the plate follows, its holes keep to its edges."""
    up = np.array([1.0, 0.0, 0.0])
    base = _make_base(up, replace(ROUND, low=-30.0, high=70.0), 45.0, ASKED, "N01")
    assert (base.plate[:, 0].min(), base.plate[:, 0].max()) == (-30 - 60, 70 + 60)
    assert {hole.x for hole in base.holes} == {-90 + 30, 130 - 30}
    assert (base.stem[:, 0].min(), base.stem[:, 0].max()) == pytest.approx((-0.9 * 30, 0.9 * 70))


def test_a_stem_ends_where_a_facet_begins():
    """A facet square to (0, −1, 1) of a drum that lies on its side cuts its lowest line at z = s √2 − 45."""
    up, normal = np.array([1.0, 0.0, 0.0]), np.array([-1.0, 0.0, 1.0]) / np.sqrt(2)
    at = 55.0
    base = _make_base(up, replace(ROUND, planes=np.array([[*normal, at]])), 45.0, ASKED, "N01")
    assert base.stem[:, 0].max() == pytest.approx(at * np.sqrt(2) - 45, abs=1e-3)
    assert base.stem[:, 0].min() == pytest.approx(-45)


def test_a_facet_under_the_work_point_is_refused():
    up = np.array([1.0, 0.0, 0.0])
    with pytest.raises(Refused, match=r"E-BASE-SEAT nodes\.base_plate \(N01\)"):
        _make_base(up, replace(ROUND, planes=np.array([[-1.0, 0.0, 0.0, 40.0]])), 45.0, ASKED, "N01")


DETAILS = {
    "faceted": {
        "nodes": {"detail": "faceted", "base_plate": {}},
        "members": {"section": "RHS 120x60x5", "sill": "FL120*10"},
    },
    "finned": {"nodes": {"detail": "finned", "base_plate": {}}, "members": {"section": "FL120*10"}},
}


@pytest.mark.parametrize("detail", DETAILS)
def test_bases_carry_drums_of_every_detail_and_take_nobodys_space(detail):
    design = museum.design(museum.changed(museum.trimmed(museum.dome(5.2, nodes=4)), **DETAILS[detail]))
    kit, settings = design.kit, kit_settings(design.project)
    made = [base for base in kit.bases if base]
    assert len(made) == np.count_nonzero(kit.nodes.kind == NodeKind.SUPPORT) > 0
    solids = make_solids(kit.nodes, kit.joints)
    refuse_clashes(kit, settings, make_shapes(kit, settings, solids))
    assert [base.level for base in made] == [
        np.ceil(round(_reach(arms, up, joint, design.project.members) + 10.0, 6))
        for arms, up, joint, base in zip(kit.nodes.arms, kit.nodes.up, kit.joints, kit.bases, strict=True)
        if base
    ]


def test_sills_keep_the_plate_below_them():
    up = np.array([1.0, 0.0, 0.0])
    both = NodeArms(np.array([0.0, np.pi / 2]), np.zeros(2), np.array([int(Family.GENERATRIX), int(Family.SILL)]))
    assert _reach(both, up, joint(), MEMBERS) == 60.0


def test_supports_of_a_dome_share_a_class_only_with_their_direction():
    design = museum.design(museum.changed(DOME, nodes={"base_plate": {}}))
    kit, settings = design.kit, kit_settings(design.project)
    up = up_directions(kit.mesh, settings.cuts)
    support = kit.mesh.kind == NodeKind.SUPPORT
    assert support.any()
    assert up[support] == pytest.approx(np.tile([0, 0, 1.0], (support.sum(), 1)))
    assert not up[~support].any()
    assert [base is not None for base in kit.bases] == [kind == NodeKind.SUPPORT for kind in kit.nodes.kind]
    reference, axis = kit.nodes.reference, kit.mesh.axes
    local = np.stack([np.einsum("ni,ni->n", way, up) for way in (reference, np.cross(axis, reference), axis)], axis=-1)
    assert local[support] == pytest.approx(kit.nodes.up[kit.nodes.classes.of][support], abs=1e-3)


def test_bases_tell_apart_what_sills_would():
    data = museum.trimmed(museum.dome(9.3, nodes=5), sill=False)
    plain, based = museum.design(data).kit, museum.design(museum.changed(data, nodes={"base_plate": {}})).kit
    assert len(based.nodes.marks) > len(plain.nodes.marks)


def test_marks_without_bases_stay_as_they_are():
    assert make_bases(museum.design(DOME).kit.nodes, (), MEMBERS, None) == (None,) * 10


@pytest.mark.parametrize(
    ("asked", "field"),
    [
        ({"edge_distance": 20}, "edge_distance"),
        ({"margin": 40}, "margin"),
        ({"holes": 8, "hole_diameter": 48, "edge_distance": 60, "margin": 110}, "holes"),
    ],
)
def test_holes_that_a_shop_would_not_drill_are_refused(asked, field):
    with pytest.raises(Refused, match=rf"nodes\.base_plate\.{field}"):
        museum.design(museum.changed(DOME, nodes={"base_plate": asked}))


def test_bases_need_a_trimmed_surface():
    with pytest.raises(Refused, match=r"it needs surface\.trim"):
        museum.design(museum.changed(museum.SMALL, nodes={"base_plate": {}}))
