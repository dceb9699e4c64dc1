"""Node details against sizes computed by hand, and against the parts that they ask for."""

import math

import numpy as np
import pytest

from isomould.arrays import Floats
from isomould.errors import Refused
from isomould.form.mesh import Family
from isomould.parts.catalogue import RhsSection, find_section
from isomould.parts.details import size_nodes
from isomould.parts.details.faceted import size_faceted
from isomould.parts.details.finned import size_finned
from isomould.parts.details.fittings import make_fittings
from isomould.parts.details.joint import Counts
from isomould.parts.hardware import Bolt, Item, find_bolt, next_length
from isomould.parts.nodes import NodeArms
from isomould.parts.settings import FacetedSettings, FinnedSettings, HardwareSettings, MemberSettings, SlottedSettings
from isomould.parts.solid import make_solid, make_solids
from museum import SMALL, changed, design


class OneClass:
    """Nodes of one class, as much of them as details read."""

    def __init__(self, azimuth: list[float], elevation: list[float], family: list[Family]) -> None:
        self.arms = (NodeArms(np.radians(azimuth), np.radians(elevation), np.array(family)),)
        self.marks = ("N01",)


G, P = Family.GENERATRIX, Family.PARALLEL
CROSS = OneClass([0, 90, 180, 270], [0, 0, 0, 0], [G, P, G, P])
TUBES = MemberSettings(section=find_section("RHS100*50*4"))
CAPPED = {"retention": "lipped-cap"}


def named(joint) -> dict[str, tuple[float, float]]:
    return {limit.name: (limit.value, limit.required) for limit in joint.limits}


def test_a_flat_cross_of_hollow_sections_by_hand():
    """Bolts M12x30 through a plate of 12 and a washer of 2.5: 15.5 of thread, a hole 3 x 1.75 deeper.

    The holes end where those of the neighbour at 90° are a web of 6 away, or a core of 8 from the bore of 20:
    max((12 + 6)/(2 sin 45°), 10 + 8) = 18, so s = 20.75 + 18 = 38.75, given as 39. Facets need (25 + 3)/tan 45° = 28.
    R = hypot(39, 28) = 48.01, so the drum has 100; it is 100 + 2 x 3 high.
    """
    joint = size_faceted(CROSS, TUBES, FacetedSettings())[0]
    assert (joint.distance, joint.diameter, joint.height) == (39.0, 100.0, 106.0)
    limits = named(joint)
    assert limits["radius that holds the facets"] == pytest.approx((50, math.hypot(39, 28)))
    assert limits["distance of facets from the axis"] == pytest.approx((39, 28))
    assert limits["distance of facets uncut by others"] == pytest.approx((39, 28))
    assert limits["distance of threaded holes from the axis"] == pytest.approx((18.25, 18))
    assert joint.counts == Counts(facets=4, holes=9, threads=8)
    assert joint.hardware == (Item("bolt", "M12x30 8.8", "ISO 4017", 8), Item("washer", "M12", "ISO 7089", 8))
    assert (joint.stack_height, joint.stack_radius) == (53, 50)


def test_the_volume_of_a_flat_cross_by_hand():
    """A disc less four segments beyond the facets, times the height, less bore and eight holes."""
    joint = size_faceted(CROSS, TUBES, FacetedSettings())[0]
    solid = make_solids(CROSS, (joint,))[0]
    angle = 2 * math.acos(39 / 50)
    segment = 50**2 / 2 * (angle - math.sin(angle))
    expected = (math.pi * (50**2 - 10**2) - 4 * segment) * 106 - 8 * math.pi * 6**2 * 20.75
    assert solid.volume == pytest.approx(expected, rel=2e-4)  # round surfaces have facets within 0.002 mm
    assert solid.genus == 1


def test_inclined_facets_are_not_cut_by_their_neighbours():
    """Every corner of a member's end lies on its facet and inside all others, at the smallest distance by a hair."""
    arms = ([0, 50, 130, 245], [20, -5, 10, -18], [G, P, G, P])
    joint = size_faceted(OneClass(*arms), TUBES, FacetedSettings())[0]
    axes, corners = frame(joint.arms), corner_points(joint, 25 + 3, 50)
    inside = corners @ axes.T - joint.distance
    assert np.max(inside) < 1e-9
    assert np.hypot(corners[..., 0], corners[..., 1]).max() <= joint.radius
    assert corners[..., 2].min() - 3 >= joint.low
    assert corners[..., 2].max() + 3 <= joint.high
    assert make_solids(OneClass(*arms), (joint,))[0].components == 1


def frame(arms: NodeArms) -> Floats:
    level = np.cos(arms.elevation)
    return np.stack([level * np.cos(arms.azimuth), level * np.sin(arms.azimuth), np.sin(arms.elevation)], axis=-1)


def corner_points(joint, half_width: float, half_depth: float) -> Floats:
    """Corners (v, 4, 3) of the facets that members and their borders take."""
    axes = frame(joint.arms)
    across = np.stack([-np.sin(joint.arms.azimuth), np.cos(joint.arms.azimuth), 0 * joint.arms.azimuth], axis=-1)
    up = np.cross(axes, across)
    signs = ((1, 1), (1, -1), (-1, 1), (-1, -1))
    corners = [joint.distance * axes + a * half_width * across + b * half_depth * up for a, b in signs]
    return np.stack(corners, axis=1)


def test_a_member_between_facets_by_hand():
    """Square cuts 47 from both nodes, a plate and two access holes of 30 + 7.5 + 10 = 47.5 in every end."""
    kit = design(changed(SMALL, nodes={"detail": "faceted"}, members={"section": "RHS 100x50x4"})).kit
    shape, s = kit.members.shapes[0], kit.joints[0].distance
    assert shape.cut_length == pytest.approx(shape.system_length - 2 * s, abs=1e-3)
    assert (shape.end_angle, shape.set_back) == ((0.0, 0.0), (s, s))
    assert [(hole.x, hole.y) for hole in shape.holes[:2]] == [(s + 12 + 47.5 / 2, -25), (s + 12 + 47.5 / 2, 25)]
    assert all((hole.diameter, hole.diameter + hole.lengthening) == (25, 47.5) for hole in shape.holes)
    opening = math.pi / 4 * 25**2 + 25 * 22.5
    plate = 12 * (92 * 42 - (4 - math.pi) * 4**2 - 2 * math.pi / 4 * 13**2)
    tube = (100 * 50 - 92 * 42 - (4 - math.pi) * (8**2 - 4**2)) * shape.cut_length
    assert shape.volume == pytest.approx(tube - 4 * opening * 4 + 2 * plate, rel=1e-12)


def test_a_capped_tongue_by_hand():
    """Drum Ø90: lip from 35 to 40; notch from sqrt(35² - 6²) - 0.5 to 40.5 and 6.5 deep; flat arms, H = 200."""
    kit = design(changed(SMALL, nodes=CAPPED)).kit
    joint = kit.joints[0]
    assert (joint.diameter, joint.height) == (90, 200)
    end = joint.end(find_section("FL200*12"), 0.0)
    inner = math.sqrt(35**2 - 6**2) - 0.5
    expected = [(47, 100), (40.5, 100), (40.5, 93.5), (inner, 93.5), (inner, 100), (20, 100)]
    assert end.outline == pytest.approx(np.array(expected + [(x, -y) for x, y in reversed(expected)]))
    assert named(joint)["hook behind the lip"] == pytest.approx((inner - 20, 8))
    # 200 + 2 x 8 of caps, 2 washers of 2.5, a nut of 10.8 and two threads of 1.75 make 235.3
    assert joint.hardware[0] == Item("bolt", "M12x240 8.8", "ISO 4014", 1)
    assert joint.stack == ((45, 108), (12, 110.5), (20.03 / 2, 118))
    assert joint.weld_length == 0


def test_grooves_take_what_lips_need():
    """A drum with grooves is lighter than a welded one by the ring between 34.5 and 40.5, less the slots, twice."""
    plain, capped = (design(changed(SMALL, nodes=nodes)).kit for nodes in ({}, CAPPED))
    one, other = (make_solids(kit.nodes, kit.joints)[0] for kit in (plain, capped))
    slots = len(capped.joints[0].slot_widths) * 12.5 * 6  # nearly radial strips across the ring
    ring = math.pi * (40.5**2 - 34.5**2) - slots
    assert one.volume - other.volume == pytest.approx(2 * 6.5 * ring, rel=5e-3)


def test_caps_by_hand():
    kit = design(changed(SMALL, nodes=CAPPED)).kit
    cap = make_fittings(kit.nodes, kit.joints, kit.members)[0]
    volume = math.pi * (8 * (45**2 - 6.5**2) + 6 * (40**2 - 35**2))
    assert (cap.mark, cap.kind, cap.size, cap.quantity) == ("F01", "cap", "Ø90x8", 2 * len(kit.nodes.locations))
    assert cap.volume == pytest.approx(volume, rel=2e-4)


def test_end_plates_are_two_per_member():
    members = {"section": "SHS 80x80x5", "parallel": "RHS 80x40x4"}
    kit = design(changed(SMALL, nodes={"detail": "faceted"}, members=members)).kit
    plates = make_fittings(kit.nodes, kit.joints, kit.members)
    assert [(plate.kind, plate.size) for plate in plates] == [("end-plate", "70x70x12"), ("end-plate", "72x32x12")]
    assert sum(plate.quantity for plate in plates) == 2 * len(kit.members.locations)
    assert plates[0].volume == pytest.approx(12 * (70**2 - (4 - math.pi) * 25 - math.pi / 4 * 13**2))


def test_slots_of_unequal_plates_keep_their_webs():
    members = MemberSettings(section=find_section("FL200*12"), parallel=find_section("FL200*25"))
    nodes = OneClass([0, 40, 180, 215], [0, 5, 0, -5], [G, P, G, P])
    joint = size_nodes(nodes, members, SlottedSettings())[0]
    assert joint.slot_widths.tolist() == [12.5, 25.5, 12.5, 25.5]
    assert named(joint)["engagement of plates"] == pytest.approx((50, 50), abs=2.5)
    assert named(joint)["web between slots"][0] >= 6
    assert make_solid(joint.carve(), 1, "N01").volume > 0


PLATES = MemberSettings(section=find_section("FL200*12"))


def test_a_flat_cross_of_forks_by_hand():
    """Forks of 13 between fins of 8 are 14.5 wide on each side; faces meet the hub (14.5 + 12)/tan 45° from its axis.

    R = hypot(26.5, 14.5) = 30.2, so the hub has 65. Bolts M12 through 29, two washers of 2.5, a nut of 10.8 and two
    threads of 1.75 are 50 long; their nuts end at 14.5 + 50 - 29 - 2.5 = 33. The plate ends at 34.5, its holes 1.2 x 13
    further.
    """
    joint = size_finned(CROSS, PLATES, FinnedSettings())[0]
    assert (joint.diameter, joint.height, joint.fin_height, joint.distance) == (65.0, 200.0, 190.0, 51.0)
    limits = named(joint)
    assert limits["foot of fins from the axis"] == pytest.approx((math.sqrt(32.5**2 - 14.5**2), 26.5))
    assert limits["room for bolts and tool beside forks"] == pytest.approx((51 - 12.5, 33))
    assert limits["end of the members before their bolts"] == pytest.approx((51 - 34.5, 15.6))
    assert limits["edge of the fins beside their bolts"] == pytest.approx((95 - 50, 15.6))
    assert limits["pitch of bolts"] == pytest.approx((100, 31.2))
    assert joint.counts == Counts(fins=8, holes=17)
    assert joint.weld_length == pytest.approx(8 * 190)
    assert joint.hardware == (
        Item("bolt", "M12x50 8.8", "ISO 4017", 8),
        Item("nut", "M12", "ISO 4032", 8),
        Item("washer", "M12", "ISO 7089", 16),
    )
    foot = math.sqrt(32.5**2 - 6.5**2)
    corners = np.array([(foot, -95), (67, -95), (67, 95), (foot, 95)])
    assert np.array(joint.fins[0].corners) == pytest.approx(corners, abs=1e-3)


def test_the_volume_of_a_flat_cross_of_forks_by_hand():
    """Hub and fins from its round surface on, the wedges filled, less bore and holes."""
    joint = size_finned(CROSS, PLATES, FinnedSettings())[0]
    solid = make_solids(CROSS, (joint,))[0]

    def under(y: float) -> float:
        return (y * math.sqrt(32.5**2 - y**2) + 32.5**2 * math.asin(y / 32.5)) / 2

    fin = 190 * (8 * 67 - (under(14.5) - under(6.5))) - 2 * 8 * math.pi / 4 * 13**2
    assert solid.volume == pytest.approx(math.pi * (32.5**2 - 10**2) * 200 + 8 * fin, rel=2e-4)
    assert (solid.genus, solid.components) == (17, 1)


def test_tools_and_bolts_reach_the_holes_of_acute_forks():
    """A socket before the head of a bolt whose tip is at its fin stays clear of what stands on the next fork."""
    nodes = OneClass([0, 50, 130, 245], [14, -5, 10, -12], [G, P, G, P])
    joint = size_finned(nodes, PLATES, FinnedSettings(bolt_columns=2))[0]
    assert make_solids(nodes, (joint,))[0].genus == 4 * 8 + 1
    fork, radius = joint.forks[0], find_bolt("M12").tool / 2
    for arm, (azimuth, elevation) in enumerate(zip(joint.arms.azimuth, joint.arms.elevation, strict=True)):
        near = joint.distance * math.cos(elevation) - 50 * abs(math.sin(elevation)) - radius
        for other in np.delete(joint.arms.azimuth, arm):
            turn = min(abs(other - azimuth), 2 * math.pi - abs(other - azimuth))
            corners = [(near, 0.0), (near, fork.reach), (near + 400, fork.reach)]
            aside = [x * math.sin(turn) - y * math.cos(turn) for x, y in corners]
            assert turn > math.pi / 2 + 0.3 or min(aside) >= fork.envelope - 1e-9


REFUSALS = {
    "tube in a fork": (
        {"nodes": {"detail": "finned"}, "members": {"section": "RHS 100x50x4"}},
        ["E-NODE-SECTION", "RHS100*50*4 in a fork", "faceted"],
    ),
    "hub too small": ({"nodes": {"detail": "finned", "drum_diameter": 50}}, ["E-NODE-DRUM", "50.000 mm", "63.235 mm"]),
    "holes too near to the plate's end": (
        {"nodes": {"detail": "finned", "bolt_distance": 45}},
        ["E-NODE-LIMIT", "end of the members before their bolts", "at least 15.600 mm", "bolt_distance"],
    ),
    "rows too far apart": (
        {"nodes": {"detail": "finned", "bolt_spacing": 150}},
        ["E-NODE-LIMIT", "edge of the fins beside their bolts", "at least 15.600 mm"],
    ),
    "rows too near": (
        {"nodes": {"detail": "finned", "bolt_spacing": 20}},
        ["E-NODE-LIMIT", "pitch of bolts is 20.000 mm", "31.200 mm"],
    ),
    "columns too near": (
        {"nodes": {"detail": "finned", "bolt_columns": 2, "bolt_pitch": 20}},
        ["E-NODE-LIMIT", "pitch of bolts is 20.000 mm", "31.200 mm"],
    ),
    "fins higher than members": (
        {"nodes": {"detail": "finned", "fin_height": 220}},
        ["E-NODE-LIMIT", "level of members' edges at the hub is 100.000 mm", "at least 115"],
    ),
    "bore as wide as the hub": (
        {"nodes": {"detail": "finned", "drum_diameter": 70, "bore": 60}},
        ["E-NODE-DRUM", "76"],
    ),
    "longer than any bolt": (
        {"nodes": {"detail": "finned", "fin_thickness": 250}},
        ["E-NODE-BOLT", "250 mm", "500 mm"],
    ),
    "tube in a slot": ({"members": {"section": "RHS 100x50x4"}}, ["E-NODE-SECTION", "RHS100*50*4", "faceted"]),
    "plate on a facet": ({"nodes": {"detail": "faceted"}}, ["E-NODE-SECTION", "FL200*12", "slotted"]),
    "bolt too thick": (
        {"members": {"section": "RHS 100x50x4"}, "nodes": {"detail": "faceted", "hardware": {"bolt": "M20"}}},
        ["E-NODE-LIMIT", "edge of the end plate beside its bolts is 21.000 mm", "26.400 mm"],
    ),
    "bolts too near": (
        {"members": {"section": "RHS 100x50x4"}, "nodes": {"detail": "faceted", "bolt_spacing": 30}},
        ["E-NODE-LIMIT", "pitch of bolts is 30.000 mm", "31.200 mm"],
    ),
    "facets too near": (
        {"members": {"section": "RHS 100x50x4"}, "nodes": {"detail": "faceted", "facet_distance": 30}},
        ["E-NODE-LIMIT", "facet_distance"],
    ),
    "no such bolt": ({"nodes": {"hardware": {"bolt": "M13"}}}, ["nodes.hardware.bolt", "M13", "M12, M16"]),
    "bore too small for the bolt": ({"nodes": {**CAPPED, "bore": 12}}, ["E-NODE-BORE", "12 mm", "at least 13 mm"]),
    "key of another detail": (
        {"nodes": {"detail": "faceted", "slot_end": "round"}},
        ["nodes.slot_end", "another kind"],
    ),
    "no such detail": ({"nodes": {"detail": "welded"}}, ["nodes", "welded", "slotted"]),
}


@pytest.mark.parametrize("case", REFUSALS)
def test_refused(case):
    change, words = REFUSALS[case]
    with pytest.raises(Refused) as refusal:
        design(changed(SMALL, **change))
    for word in words:
        assert word in str(refusal.value)


def test_bolts_are_found_by_their_exact_size():
    assert find_bolt("M16") == Bolt("M16", 16, 2, 18, 10, 26.75, 14.8, 30, 3, 33)
    assert [next_length(x) for x in (1, 40, 40.1, 149, 155)] == [20, 40, 45, 150, 160]
    assert HardwareSettings().bolt == "M12"


def test_end_plates_fit_their_tubes():
    section = RhsSection(depth=100, width=50, wall=4)
    assert section.void == pytest.approx(92 * 42 - (4 - math.pi) * 16)
