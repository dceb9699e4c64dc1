"""What is advised where an edge offset generatrix meets a pole is what passes, and what a trim costs is said."""

import re

import pytest

from isomould.errors import Refused
from museum import changed, design, sketched, sphere, template

DOME = changed(
    sphere(15, 30, radius=9000),
    generatrix={"curve": {"kind": "arc", "radius": 9000, "start_deg": 20, "end_deg": 90}},
    members={"section": {"kind": "plate", "depth": 120, "thickness": 10}},
    tolerances={"min_member": 250},
)
"""A dome over a circle, drawn up to its apex."""


def advised() -> float:
    with pytest.raises(Refused, match="E-GENERATRIX-POLE") as refusal:
        sketched(DOME)
    said = refusal.value.way_out
    assert "surface.kind = 'isogonal' and an eye" in said
    return float(re.search(r"at most where it is ([\d.]+)°", said)[1])


def cut(degrees: float):
    curve = {"kind": "arc", "radius": 9000, "start_deg": 20, "end_deg": degrees}
    return changed(DOME, generatrix={"curve": curve})


def test_the_cut_that_is_advised_passes_and_another_row_does_not():
    degrees = advised()
    assert 40 < degrees < 85
    assert sketched(cut(degrees)).mesh.shape[0] > 3
    with pytest.raises(Refused, match="E-SURFACE-SHORT"):
        sketched(cut(84.9))


def test_the_isogonal_dome_with_an_eye_passes():
    data = changed(cut(advised()), surface={"kind": "isogonal"})
    generatrix = {**data["generatrix"], "divide": {"nodes": 6}}
    assert sketched({**data, "generatrix": generatrix}).mesh.shape == (8, 24)


def test_trims_say_what_they_cost():
    street = template("covered-street")
    level = changed(street, surface={"trim": [{"plane": {"z": 1000}, "keep": "above"}], "sill": True})
    notes = {note.code: note.text for note in design(level).notes}
    assert re.fullmatch(r"the planes cost node classes: 4\d for 20 without them", notes["W-TRIM-CLASSES"])
    assert "W-TRIM-CLASSES" not in {note.code for note in design(street).notes}
