"""Digits that people see: printed by one function, held to the exact value by another that knows nothing of it."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from isomould.documents.digits import shown
from isomould.verify.shown_digits import shows

UNITS = ("mm", "°", "m²", "kg", "%", "cm³", "EUR", "")
NUMBERS = (
    st.floats(-1e7, 1e7, allow_subnormal=False)
    | st.floats(-1e-3, 1e-3, allow_subnormal=False)
    | st.integers(-(10**6), 10**6).map(float)
)


@settings(max_examples=200)
@given(NUMBERS, st.sampled_from(UNITS))
def test_what_is_printed_is_accepted(value, unit):
    assert shows(shown(value, unit), value, unit)


@settings(max_examples=100)
@given(st.floats(1.0, 1e6), st.sampled_from(UNITS))
def test_the_next_number_is_not(value, unit):
    """A whole unit of the last digit more is wrong, however the value was rounded."""
    text = shown(value, unit)
    decimals = len(text.partition(".")[2])
    assert not shows(f"{float(text) + 1.01 * 10.0**-decimals:.{decimals + 2}f}", value, unit)


@pytest.mark.parametrize(
    ("text", "value", "unit"),
    [
        ("1235", 1234.6, "mm"),  # too few digits
        ("1234.55", 1234.5678, "mm"),  # a digit that is wrong
        ("0", 2.5e-12, "mm"),  # a residual is not nothing
        ("1001", 1000.4, "kg"),
        ("12", 12.4, "kg"),  # whole kilograms begin at a tonne
        ("8", 7.0, ""),
        ("NaN", 1.0, "mm"),
        ("inf", 1.0, "mm"),
        ("", 0.0, "mm"),
        ("one", 1.0, ""),
    ],
)
def test_other_texts_are_not_accepted(text, value, unit):
    assert not shows(text, value, unit)
