"""Classes: complete linkage, variants, mirror images."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from isomould.parts.congruence import classify, handedness, joined
from isomould.parts.panels import _handedness
from museum import SMALL, changed, design


def singles(values):
    numbers = np.array(values, dtype=float)[:, None, None]
    return numbers, np.zeros((len(values), 1, 1), dtype=np.int64)


def test_no_chain_of_neighbours():
    """Steps of 0.4 at a tolerance of 0.5 never merge 1000.0 with 1002.8 (failure mode E1)."""
    values = 1000 + 0.4 * np.arange(8)
    classes = classify(*singles(values), np.array([0.5]))
    for k in range(len(classes.representative)):
        assert np.ptp(values[classes.of == k]) <= 0.5


@given(st.lists(st.floats(0, 20), min_size=1, max_size=60), st.floats(0.01, 3))
def test_spread_within_a_class_keeps_the_tolerance(values, tolerance):
    classes = classify(*singles(values), np.array([tolerance]))
    assert classes.deviation.max() <= tolerance
    for k in range(len(classes.representative)):
        assert np.ptp(np.array(values)[classes.of == k]) <= tolerance


def test_variants_of_one_thing_are_one_class():
    """A description read from another start is the same thing, and says which variant agrees."""
    row = np.array([1.0, 2.0, 3.0])
    numbers = np.stack([np.stack([np.roll(np.roll(row, s), -k) for k in range(3)]) for s in range(3)])
    classes = classify(numbers, np.zeros((3, 3, 1), dtype=np.int64), np.full(3, 0.1))
    assert len(classes.representative) == 1
    assert classes.variant.tolist() == [0, 1, 2]


def test_classes_are_numbered_by_their_first_instance():
    classes = classify(*singles([7.0, 3.0, 7.0, 1.0]), np.array([0.1]))
    assert classes.of.tolist() == [0, 1, 0, 2]
    assert classes.quantity.tolist() == [2, 1, 1]


def test_labels_keep_apart_what_numbers_would_merge():
    numbers = np.zeros((2, 1, 1))
    assert len(classify(numbers, np.array([[[0]], [[1]]]), np.array([1.0])).representative) == 2


@pytest.mark.parametrize("turn", range(4))
def test_mirrored_panels_never_share_a_letter(turn):
    """Whatever corner the first piece of a class starts at, a mirrored pair is L and R."""
    panel = np.array([[0.0, 0.0], [1000.0, 0.0], [900.0, 500.0], [250.0, 500.0]])
    mirrored = (panel * [-1, 1])[::-1]
    both = np.stack([np.roll(panel, turn, axis=0), mirrored])
    assert sorted(_handedness(both, np.full(2, 4), np.zeros((2, 4)), 0.1, flippable=False)) == ["L", "R"]


def hand(gaps, rises, noise=0.0):
    """Letter of a node of four arms at a tolerance of 1e-3; noise goes on every number."""
    shake = noise * np.sin(7.0 * np.arange(16)).reshape(2, 2, 4)
    own, turned = np.stack([gaps, rises]) + shake[0], np.stack([gaps[::-1], rises[::-1]]) + shake[1]
    # Read the other way round, the gap after an arm belongs to the arm that follows.
    turned[0] = np.roll(turned[0], -1)
    both = [np.stack([np.roll(one, -k, axis=1).ravel() for k in range(4)])[None] for one in (own, turned)]
    labels = np.zeros((1, 4, 1), dtype=np.int64)
    order = np.append(np.arange(8).reshape(2, 4).T.ravel(), 8)
    return handedness((both[0], labels), (both[1], labels), np.full(8, 1e-3), order)[0]


@pytest.mark.parametrize("turn", range(4))
@pytest.mark.parametrize("noise", [0.0, 3e-5, -3e-5, 2e-4, -2e-4])
def test_noise_below_the_tolerance_decides_no_letter(turn, noise):
    """All gaps are equal but for noise: what tells the node from its mirror image are its elevations."""
    gaps, rises = np.full(4, np.pi / 2), np.roll([0.1, 0.2, 0.3, 0.5], turn)
    assert hand(gaps, rises, noise) == hand(gaps, np.array([0.1, 0.2, 0.3, 0.5])) in ("L", "R")
    assert {hand(gaps, rises, noise), hand(gaps, rises[::-1], noise)} == {"L", "R"}


def test_a_node_within_the_tolerance_of_its_mirror_image_has_no_hand():
    assert hand(np.full(4, np.pi / 2), np.array([0.1, 0.2, 0.3, 0.2 + 9e-4])) == "none"
    assert hand(np.full(4, np.pi / 2), np.array([0.1, 0.2, 0.3, 0.2 + 3e-3])) in ("L", "R")


def test_groups_are_joined_in_the_order_of_their_first_instances():
    rows = [np.array([1, 3]), np.array([0, 2, 4])]
    parts = [classify(*singles(values), np.array([0.1])) for values in ([5.0, 6.0], [7.0, 8.0, 7.05])]
    both = joined(rows, parts)
    assert both.of.tolist() == [0, 1, 2, 3, 0]
    assert both.representative.tolist() == [0, 1, 2, 3]
    assert both.deviation[:, 0] == pytest.approx([0, 0, 0, 0, 0.05])


def test_what_a_class_holds_may_be_other_than_what_it_is_read_by():
    """Gaps of 0.4 more each are alike at a tolerance of 0.5; sums of them are not."""
    gaps = np.array([[[90.0, 90.0, 90.0, 90.0]], [[90.4, 90.4, 90.0, 89.2]]])
    sums = np.cumsum(gaps, axis=2) - gaps
    labels, tolerance = np.zeros((2, 1, 1), dtype=np.int64), np.full(4, 1.0)
    assert len(classify(gaps, labels, tolerance).representative) == 1
    assert len(classify(gaps, labels, tolerance * 0.85, held=sums).representative) == 1
    assert len(classify(gaps, labels, tolerance * 0.75, held=sums).representative) == 2


@pytest.mark.parametrize("stations", [9, 14, 20])
@pytest.mark.parametrize("angle_deg", [0.05, 0.5])
def test_nodes_of_a_class_have_its_azimuths(stations, angle_deg):
    """Azimuths from arm 1, which the certificate proves (V36): neighbouring gaps within the tolerance may add up."""
    rail = {"divide": {"stations": stations}}
    generatrix = {"divide": {"stations": stations}, "curve": {"kind": "arc", "span": 9000, "rise": 900}}
    made = design(
        changed(
            SMALL,
            rail=rail,
            generatrix={**generatrix, "axes": "zd"},
            surface={"kind": "moulding"},
            tolerances={"angle_deg": angle_deg, "min_member": 10},
            members={"min_clear": 5},
            stock={"bars": [], "sheets": []},
        )
    ).kit
    nodes, arms = made.nodes, made.arms
    for rows, of in zip(nodes.arm_rows, nodes.classes.of, strict=True):
        rows = rows[rows >= 0]  # noqa: PLW2901
        azimuth = np.mod(arms.azimuth[rows] - arms.azimuth[rows[0]] + 1.0, 2 * np.pi) - 1.0
        assert np.degrees(abs(azimuth - nodes.arms[of].azimuth)).max() <= angle_deg + 1e-4
        assert np.degrees(abs(arms.elevation[rows] - nodes.arms[of].elevation)).max() <= angle_deg + 1e-4
