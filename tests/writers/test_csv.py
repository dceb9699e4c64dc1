import csv
import io

import pytest

from isomould.errors import OutputFault
from isomould.writers.csv import csv_text, write_csv


def read(text):
    return list(csv.DictReader(io.StringIO(text, newline=""), strict=True))


@pytest.fixture
def texts(tables):
    return {table.name: csv_text(table) for table in tables}


def test_lines_end_with_crlf_and_nothing_else_breaks_a_line_but_quoted_text(texts):
    assert texts["panels"].count("\r\n") == texts["panels"].count("\n") == 3
    assert texts["panels"].endswith("\r\n")


def test_numbers_are_rounded_once_and_printed_without_noise(texts):
    first, second = read(texts["panels"])
    assert (first["side_a_mm"], second["side_a_mm"]) == ("1000", "1200.5")
    assert (first["area_m2"], first["total_area_m2"]) == ("1.0000005", "3.0000015")
    assert (first["angle_1_deg"], second["angle_1_deg"]) == ("90", "")


def test_no_negative_zero_and_negative_numbers_stay_numbers(texts):
    row = read(texts["panel_instances"])[0]
    assert (row["slope_deg"], row["y_mm"], row["turned_over"]) == ("0", "-12.5", "no")
    assert read(texts["panel_instances"])[-1]["turned_over"] == "yes"


def test_residuals_keep_six_significant_digits(texts):
    assert float(read(texts["checks"])[0]["worst"]) == 3.14159e-13


def test_text_never_becomes_a_formula(texts):
    found = [row["bar"] for row in read(texts["bars"])]
    assert not any(text.startswith(("=", "+", "-", "@", "\t", "\r")) for text in found)
    assert found[0] == "'=1+1"
    assert found[6:] == ['a,"b"\nc', "http://a.b/c", "007", "ünï"]


def test_file_is_utf8_without_bom(tables, tmp_path):
    path = tmp_path / "tables" / "bars.csv"
    write_csv(path, tables[3])
    assert path.read_bytes().startswith(b"bar,stock,pieces")
    assert "ünï" in path.read_bytes().decode("utf-8")


def test_fault_names_path_and_cause(tables, tmp_path):
    (tmp_path / "tables").write_text("a file, not a folder")
    with pytest.raises(OutputFault, match="tables"):
        write_csv(tmp_path / "tables" / "bars.csv", tables[3])
