"""Rows D of the failure modes, each provoked: code, field, value found with its unit, limit and way out."""

import re

import numpy as np
import pytest

from isomould.errors import Refused
from isomould.form.mesh import Family
from isomould.parts.catalogue import find_section
from isomould.parts.details import size_nodes
from isomould.parts.details.joint import Carving
from isomould.parts.kernel import block
from isomould.parts.nodes import NodeArms
from isomould.parts.quality import refuse_torsion
from isomould.parts.settings import FacetedSettings, FinnedSettings, HardwareSettings, MemberSettings, SlottedSettings
from isomould.parts.solid import SolidError, make_solid
from museum import SMALL, changed, design, dome, trimmed

FACETED = {"nodes": {"detail": "faceted"}, "members": {"section": "RHS 100x50x4"}}
FINNED = {"nodes": {"detail": "finned"}}
BASED = trimmed(dome(5.2, nodes=6))
M20 = {"bolt": "M20"}

REFUSED = {
    "D1 slots meet": (changed(SMALL, nodes={"drum_diameter": 60}), "E-NODE-DRUM", "nodes.drum_diameter", "or more"),
    "D1 forks meet": (
        changed(SMALL, nodes={"detail": "finned", "drum_diameter": 40}),
        "E-NODE-DRUM",
        "nodes.drum_diameter",
        "or more",
    ),
    "D1 facets meet": (
        changed(changed(SMALL, **FACETED), nodes={"facet_distance": 30}),
        "E-NODE-LIMIT",
        "nodes (N01)",
        "facet_distance",
    ),
    "D1 slot too shallow": (changed(SMALL, nodes={"slot_depth": 12}), "E-NODE-SLOT", "nodes.slot_depth", "or more"),
    "D2 too short": (changed(SMALL, members={"min_clear": "3 m"}), "E-MEMBER-SHORT", "members (MG-00-00)", "min_clear"),
    "D2 too short for its holes": (
        changed(changed(SMALL, **FINNED), nodes={"bolt_distance": 900}),
        "E-MEMBER-SHORT",
        "members (MG-00-00)",
        "min_clear",
    ),
    "D3 too sharp": (changed(SMALL, members={"max_end_angle_deg": 0.5}), "E-MEMBER-SHARP", r"members \(M.*", "saw"),
    "D8 edge of a tube": (
        changed(changed(SMALL, **FACETED), nodes={"hardware": M20}),
        "E-NODE-LIMIT",
        "nodes (N01)",
        "smaller sections or bolts",
    ),
    "D8 bolts of a tube too near": (
        changed(changed(SMALL, **FACETED), nodes={"bolt_spacing": 30}),
        "E-NODE-LIMIT",
        "nodes (N01)",
        "bolts",
    ),
    "D8 rows of a fork too near": (
        changed(changed(SMALL, **FINNED), nodes={"bolt_spacing": 20}),
        "E-NODE-LIMIT",
        "nodes (N01)",
        "bolt_spacing",
    ),
    "D8 holes at the edge of fins": (
        changed(changed(SMALL, **FINNED), nodes={"bolt_spacing": 165}),
        "E-NODE-LIMIT",
        "nodes (N01)",
        "bolt_spacing",
    ),
    "D8 holes at the end of members": (
        changed(changed(SMALL, **FINNED), nodes={"bolt_distance": 45}),
        "E-NODE-LIMIT",
        "nodes (N01)",
        "bolt_distance",
    ),
    "D8 centre bolt wider than the bore": (
        changed(SMALL, nodes={"retention": "lipped-cap", "bore": 12}),
        "E-NODE-BORE",
        "nodes.bore",
        "larger bore",
    ),
    "D8 no bolt is long enough": (
        changed(changed(SMALL, **FINNED), nodes={"fin_thickness": 250}),
        "E-NODE-BOLT",
        "nodes.fin_thickness",
        "thinner",
    ),
    "D8 holes at the edge of a base": (
        changed(BASED, nodes={"base_plate": {"edge_distance": 20}}),
        "E-BASE-HOLES",
        "nodes.base_plate.edge_distance",
        "margin",
    ),
    "D9 section that is in no table": (
        changed(SMALL, members={"section": "FL199*12"}),
        "E-PROJECT",
        "museum: members.section",
        "Change the value",
    ),
    "D9 bolt that is in no table": (
        changed(SMALL, nodes={"hardware": {"bolt": "M14"}}),
        "E-PROJECT",
        "museum: nodes.hardware.bolt",
        "Change the value",
    ),
    "D9 section of another detail": (
        changed(SMALL, nodes={"detail": "finned"}, members={"section": "RHS 100x50x4"}),
        "E-NODE-SECTION",
        "members.section",
        "faceted",
    ),
    "D10 no panel between its gaps": (
        changed(
            SMALL, panels={"gap": 5000, "seat_width": 9000, "min_bearing": 1}, tolerances={"min_member": 1}
        ),
        "E-PANEL-VANISHED",
        "panels",
        "smaller gaps",
    ),
    "D10 too little of the seat": (
        changed(SMALL, panels={"min_bearing": 25}),
        "E-PANEL-BEARING",
        "panels.seat_width",
        "seats",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", REFUSED)
def test_each_row_is_refused_with_all_that_a_user_needs(name):
    data, code, field, way_out = REFUSED[name]
    with pytest.raises(Refused) as refusal:
        design(data)
    found = refusal.value
    assert found.code == code
    assert found.field == field or re.fullmatch(field, found.field)
    assert re.search(r"\d|FL|RHS|M14", found.found)
    assert re.search(r"\d|plates|FL|M16|positive", found.limit), found.limit
    assert re.search(way_out, found.way_out), found.way_out


class OneClass:
    """Two arms at an acute angle, as much of a class as details read."""

    def __init__(self, between_deg: float) -> None:
        arms = np.radians([0.0, between_deg]), np.zeros(2), np.full(2, int(Family.GENERATRIX))
        self.arms, self.marks = (NodeArms(*arms),), ("N01",)


def sized(nodes, section, settings):
    return size_nodes(nodes, MemberSettings(section=find_section(section)), settings)[0]


@pytest.mark.parametrize(("between", "clear"), [(90, 1.0), (60, 0.577350), (45, 0.414214), (20, 0.176327)])
def test_d1_plates_of_one_width_are_as_far_apart_as_the_formula_says(between, clear):
    """`(w/2)/tan(γ/2)`, the width with its webs, borders or access to welds."""
    fork = sized(OneClass(between), "FL200*12", FinnedSettings())
    limits = {limit.name: limit for limit in fork.limits}
    assert limits["foot of fins from the axis"].required == pytest.approx((14.5 + 12) / clear, rel=1e-5)
    facet = sized(OneClass(between), "RHS 100x50x4", FacetedSettings())
    limits = {limit.name: limit for limit in facet.limits}
    assert limits["distance of facets from the axis"].required == pytest.approx((25 + 3) / clear, rel=1e-5)
    half = np.radians(between) / 2
    slot = sized(OneClass(between), "FL200*12", SlottedSettings(bore=0))
    web = 2 * (slot.slot_floor * np.sin(half) - 12.5 / 2 * np.cos(half))
    assert web >= 6 - 1e-9
    assert {limit.name: limit.value for limit in slot.limits}["web between slots"] == pytest.approx(web)


def test_d8_a_bolt_that_cannot_be_put_in_is_refused():
    """At 30° the next fork is in the way of bolt and socket long before the plate's end is."""
    free = sized(OneClass(30), "FL200*12", FinnedSettings())
    with pytest.raises(Refused) as refusal:
        sized(OneClass(30), "FL200*12", FinnedSettings(bolt_distance=free.distance - 2))
    assert refusal.value.found.startswith("room for bolts and tool beside forks is ")
    assert refusal.value.code == "E-NODE-LIMIT"


def test_d8_every_detail_reports_room_for_edges_and_tools():
    capped = sized(OneClass(90), "FL200*12", SlottedSettings(retention="lipped-cap"))
    wide = HardwareSettings(bolt="M12")
    faceted = sized(OneClass(90), "RHS 100x50x4", FacetedSettings(hardware=wide))
    finned = sized(OneClass(90), "FL200*12", FinnedSettings(hardware=wide))
    for joint in (capped, faceted, finned):
        named = [limit.name for limit in joint.limits]
        assert any("tool" in name for name in named), named
        assert any("edge" in name or "end of" in name for name in named), named
        assert min(limit.margin for limit in joint.limits) > -1e-9


def test_d5_torsion_is_refused_with_node_and_angle():
    with pytest.raises(
        Refused, match=r"E-NODE-TORSION nodes \(N-00-01\): a torsion of 0\.0200°\. Limit: 0\.01°\. Members"
    ):
        refuse_torsion(np.radians([0.0, 0.02]), ("N-00-00", "N-00-01"))
    refuse_torsion(np.radians([0.0, 0.009]), ("N-00-00", "N-00-01"))


SPOILT = {
    "empty": ((-5, -5, -5), (25, 25, 25), 1.0, "status"),
    "two pieces": ((8, -5, -5), (12, 25, 25), 6400.0, "2 components"),
    "a hole too many": ((8, 8, -5), (12, 12, 25), 7680.0, "genus 1"),
    "another volume": ((8, 8, 15), (12, 12, 25), 8000.0, "off the one computed without it"),
    "not finite": ((np.nan, 8, 15), (12, 12, 25), 7920.0, "status"),
}
"""A cutter between two corners, taken from a cube of 20 mm, the volume that it should leave, and what is wrong."""


@pytest.mark.parametrize("name", SPOILT)
def test_d6_spoilt_solids_are_faults_of_the_program(name):
    low, high, volume, words = SPOILT[name]
    with pytest.raises(SolidError, match="E-SOLID N01") as fault:
        make_solid(Carving(block((0, 0, 0), (20, 20, 20)), block(low, high), volume), 0, "N01")
    assert words in str(fault.value)


def test_d7_solids_keep_double_precision():
    joint = sized(OneClass(70), "FL200*12", SlottedSettings())
    vertices = make_solid(joint.carve(), joint.genus, "N01").vertices
    assert np.abs(vertices - vertices.astype(np.float32)).max() > 1e-9
