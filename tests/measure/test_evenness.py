"""Low Gaussian curvature and strong anisotropy (paper §4.4): noted where they are, with the curve to change."""

import numpy as np
import pytest

from isomould.measure.evenness import measure_evenness
from isomould.measure.smooth import Smooth
from isomould.sizing import curvature_notes
from museum import MONGE, design, sketched, sphere, template


def notes(data):
    return {note.code: note.text for note in curvature_notes(design(data))}


def measured(data):
    drawn = sketched(data)
    smooth = Smooth(drawn.rail.curve, drawn.generatrix, drawn.rail.plane)
    return measure_evenness(drawn.form, smooth, drawn.mesh.face_ij)


def test_a_sphere_is_even_all_over():
    """Its Gaussian curvature is 1/R² and its radii are equal, everywhere."""
    data = sphere(15, 40)
    found = measured(data)
    assert found.gauss == pytest.approx(1.0, abs=1e-9)
    assert found.radii == pytest.approx(1.0, abs=1e-9)
    assert found.closed == {"rail"}
    assert notes(data) == {}


def test_radii_of_a_torus_are_those_of_the_text_book():
    """R1/R2 = |R + r cos μ| / |r cos μ| on a tube of r = 3.5 m around a ring of R = 8 m, at least 1."""
    data = template("torus")
    cosine = np.cos(sketched(data).form.surface.profile.latitude)
    ratio = np.abs((8.0 + 3.5 * cosine) / (3.5 * cosine))
    found = measured(data)
    expected = np.broadcast_to(np.maximum(ratio, 1 / ratio)[:, None], found.radii.shape)
    assert found.radii[found.counted] == pytest.approx(expected[found.counted], rel=1e-9)


def test_a_torus_near_its_top_is_told_with_both_ratios():
    told = notes(template("torus"))
    assert told.keys() == {"W-ANISOTROPY"}
    assert "L/l is 6.65 and R1/R2 6.72 at P-01-00, long along the rail" in told["W-ANISOTROPY"]
    assert "near generatrix 0 of 24" in told["W-ANISOTROPY"]


def test_flat_ends_of_a_generatrix_are_told():
    """The curve of Fig. 6 ends without curvature: its last panels are the largest."""
    text = notes(template("barrel-vault"))["W-LOW-CURVATURE"]
    assert "at P-00-01 is 0.0 % of the surface's mean" in text
    assert "4.0 times as large" in text
    assert "Bend the generatrix more at its beginning (near parallel 0 of 33)" in text


def test_the_most_oblong_dome_of_the_paper_is_not_noted():
    assert notes(template("dome-oblong")) == {}


def test_rails_in_space_have_none():
    assert curvature_notes(design(MONGE)) == ()
