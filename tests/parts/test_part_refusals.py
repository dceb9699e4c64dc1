"""What the parts refuse, with the number that is needed."""

import pytest

from isomould.errors import Refused
from museum import SMALL, changed, design

CASES = {
    "drum too small": ({"nodes": {"drum_diameter": 60}}, ["E-NODE-DRUM", "60.000 mm", "at least", "mm or more"]),
    "slot too shallow": ({"nodes": {"slot_depth": 12}}, ["E-NODE-SLOT", "12.000 mm", "at least 27.000 mm"]),
    "drum too low": ({"nodes": {"drum_diameter": "2 m"}}, ["E-NODE-LIMIT", "height of the drum", "120.000 mm"]),
    "member too short": ({"members": {"min_clear": "3 m"}}, ["E-MEMBER-SHORT", "min_clear = 3000 mm", "MG-"]),
    "end cut too sharp": ({"members": {"max_end_angle_deg": 0.5}}, ["E-MEMBER-SHARP", "max_end_angle_deg = 0.5°"]),
    "bearing too small": ({"panels": {"min_bearing": 25}}, ["E-PANEL-BEARING", "seat_width", "Give seats of"]),
    "panel between its gaps": (
        {"panels": {"gap": 5000, "seat_width": 9000, "min_bearing": 1}, "tolerances": {"min_member": 1}},
        ["E-PANEL-VANISHED"],
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_refused(case):
    change, words = CASES[case]
    with pytest.raises(Refused) as refusal:
        design(changed(SMALL, **change))
    for word in words:
        assert word in str(refusal.value)


def test_the_number_needed_is_enough():
    """The drum that a refusal asks for is accepted, and a hundredth less is not."""
    with pytest.raises(Refused) as refusal:
        design(changed(SMALL, nodes={"drum_diameter": 60}))
    needed = float(refusal.value.limit.removeprefix("at least ").removesuffix(" mm"))
    assert design(changed(SMALL, nodes={"drum_diameter": needed + 0.001})).kit.joints[0].diameter == needed + 0.001
    with pytest.raises(Refused):
        design(changed(SMALL, nodes={"drum_diameter": needed - 0.01}))
