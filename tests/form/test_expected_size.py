"""Counts are bounded from the turning of both curves before anything is divided (failure mode J1)."""

import time

import pytest

from isomould.errors import Refused
from museum import EDGE_OFFSET_VAULT, MONGE, SMALL, changed, sketched

STATIONS = {"divide": {"stations": 100_000}}
FINE = {"divide": {"angle_deg": 0.001}}

HUGE = {
    "stations of both": changed(SMALL, rail=STATIONS, generatrix=STATIONS, surface={"kind": "moulding"}),
    "an angle of the rail": changed(SMALL, rail=FINE),
    "an angle of the generatrix": changed(SMALL, generatrix=FINE),
    "ranges of angles": changed(SMALL, rail={"divide": {"angles": [{"angle_deg": 0.001}]}}),
    "nodes": changed(SMALL, rail={"divide": {"nodes": 150_000}}),
    "nodes of every arc": changed(SMALL, generatrix={"divide": {"per_arc": 150_000}}),
    "slopes of an edge offset mesh": changed(EDGE_OFFSET_VAULT, rail={"divide": {"angle_deg": 0.01}}),
    "a rail in space": changed(
        MONGE, rail={"curve": {"kind": "spline", "points": [[0, 0, 0], [9e3, 0, 1e3], [2e4, 99, 0]]}, **STATIONS}
    ),
}


@pytest.mark.parametrize("case", HUGE)
def test_too_many_are_refused_at_once(case):
    begun = time.process_time()
    with pytest.raises(Refused, match="E-SIZE"):
        sketched(HUGE[case])
    assert time.process_time() - begun < 0.5
