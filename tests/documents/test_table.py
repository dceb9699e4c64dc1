import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from isomould.documents.columns import TABLES, columns
from isomould.documents.numbers import format_number, round_to
from isomould.documents.table import cells, make_table
from isomould.errors import Refused

BAR = {"bar": ["B1"], "stock": ["6000"], "pieces": [2], "used_mm": [1.0], "offcut_mm": [0.0], "price": [None]}


@pytest.mark.parametrize("name", TABLES)
def test_headers_can_stand_in_structured_references(name):
    headers = [column.header for column in columns(name, arms=6)]
    assert len({header.lower() for header in headers}) == len(headers)
    assert not set("[]#'@") & set("".join(headers))


def test_arms_stand_where_the_contract_has_them():
    names = [column.name for column in columns("nodes", arms=2)]
    at = names.index("azimuth_1_deg")
    assert names[at - 1] == "handed"
    assert names[at + 4 : at + 8] == ["azimuth_2_deg", "elevation_2_deg", "family_2", "section_2"]
    assert names[at + 8] == "drum_diameter_mm"


def test_lists_in_a_cell_are_text():
    kinds = {column.name: column.kind for column in columns("panel_instances")}
    assert kinds["packers_mm"] == "text"
    assert kinds["x_mm"] == "number"
    assert kinds["turned_over"] == "yes_no"


def test_cells_are_plain_python_values():
    table = make_table("bars", BAR | {"pieces": [np.int64(2)], "used_mm": [np.float64(1.0004)]})
    found = [cells(table, column)[0] for column in table.columns]
    assert found == ["B1", "6000", 2, 1.0, 0.0, None]
    assert [type(cell) for cell in found] == [str, str, int, float, float, type(None)]


@pytest.mark.parametrize("value", [float("nan"), float("inf"), np.float64("-inf")])
def test_numbers_that_are_none_are_refused(value):
    with pytest.raises(Refused, match="used_mm, row 0"):
        make_table("bars", BAR | {"used_mm": [value]})


@pytest.mark.parametrize(
    "change",
    [
        {"pieces": [2.0]},
        {"pieces": [True]},
        {"used_mm": ["1.0"]},
        {"used_mm": [False]},
        {"bar": [1]},
        {"bar": ["B1", "B2"]},
        {"colour": ["red"]},
    ],
)
def test_wrong_types_lengths_and_names_are_errors(change):
    with pytest.raises(ValueError, match="table bars"):
        make_table("bars", BAR | change)


def test_a_missing_column_is_an_error():
    with pytest.raises(ValueError, match=r"missing columns \['price'\]"):
        make_table("bars", {name: values for name, values in BAR.items() if name != "price"})


@given(st.floats(-1e7, 1e7), st.sampled_from([0, 2, 3, 4, 9, 12, None]))
def test_rounding_is_done_once_and_text_reads_back_the_same(value, decimals):
    rounded = round_to(np.array([value]), decimals)
    text = format_number(rounded[0])
    assert float(text) == rounded[0] == round_to(rounded, decimals)[0]
    assert text != "-0"
    assert "e" not in text


@given(st.integers(-(10**10), 10**10))
def test_micrometres_print_as_decimals(micrometres):
    assert format_number(micrometres * 0.001, 3) == format_number(micrometres / 1000, 3)
    assert len(format_number(micrometres * 0.001, 3).partition(".")[2]) <= 3


def test_ties_fall_to_the_same_side_in_spite_of_noise():
    noisy = np.array([0.0125, np.nextafter(0.0125, 1), np.nextafter(0.0125, 0)])
    assert round_to(noisy, 3).tolist() == [0.012] * 3


def test_frames_hold_no_negative_zero():
    assert not np.signbit(round_to(np.array([-0.0001, -0.0]), 3)).any()
