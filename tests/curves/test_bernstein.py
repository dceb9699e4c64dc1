import numpy as np
import pytest
from curve_strategies import quick
from hypothesis import given
from hypothesis import strategies as st
from numpy.polynomial import Polynomial
from scipy.special import comb

from isomould.curves.bernstein import product, sign_changes, slope, value


def from_roots(roots, sign=1.0):
    """Bernstein coefficients of the monic polynomial with these roots."""
    result = np.array([sign])
    for root in roots:
        result = product(result, np.array([-root, 1 - root]))
    return result


def power_to_bernstein(c):
    n = len(c) - 1
    return np.array([sum(comb(k, i) / comb(n, i) * c[i] for i in range(k + 1)) for k in range(n + 1)])


@quick
@given(st.lists(st.floats(-2, 2), min_size=1, max_size=7), st.floats(0, 1))
def test_value_product_and_slope_agree_with_numpy(c, t):
    poly, ours = Polynomial(c), power_to_bernstein(np.array(c))
    assert value(ours, t) == pytest.approx(poly(t), abs=1e-12)
    assert value(product(ours, ours), t) == pytest.approx(poly(t) ** 2, abs=1e-11)
    if len(c) > 1:
        assert value(slope(ours), t) == pytest.approx(poly.deriv()(t), abs=1e-11)


@quick
@given(st.lists(st.integers(1, 99), min_size=1, max_size=6, unique=True), st.sampled_from([1.0, -1.0]))
def test_finds_every_simple_root(hundredths, sign):
    roots = np.sort(hundredths) / 100
    found = sign_changes(from_roots(roots, sign), 1.0)
    np.testing.assert_allclose(found, roots, atol=2e-6)


def test_finds_simple_roots_to_the_last_digits():
    np.testing.assert_allclose(sign_changes(from_roots([0.1, 0.5, 0.7]), 1.0), [0.1, 0.5, 0.7], atol=1e-14)


@pytest.mark.parametrize(
    ("roots", "expected"),
    [
        ([0.3, 0.3], []),
        ([0.5, 0.5], []),
        ([0.5, 0.5, 0.5], [0.5]),
        ([0.3, 0.3, 0.3], [0.3]),
        ([1 / 3] * 4, []),
        ([0.25, 0.25, 0.75], [0.75]),
        ([0.0, 0.6], [0.6]),
        ([1.0, 1.0, 0.6], [0.6]),
        ([0.0, 1.0], []),
        ([-0.5, 1.5], []),
    ],
)
def test_counts_only_sign_changes(roots, expected):
    np.testing.assert_allclose(sign_changes(from_roots(roots), 1.0), expected, atol=1e-4)


def test_noise_is_no_sign():
    assert sign_changes(np.array([1e-15, -1e-15, 1e-15, -1e-15]), 1.0) == []
    assert sign_changes(np.zeros(4), 0.0) == []
    assert sign_changes(np.array([1e-15, -1e-15]), 1e-14) == [0.5]
