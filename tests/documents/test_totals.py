from isomould.documents.columns import columns
from isomould.documents.reconciliations import reconcile
from isomould.documents.table import Table, cells, make_table
from isomould.documents.totals import column_totals, make_summary


def sheets(parts):
    count = len(parts)
    names = [column.name for column in columns("sheets")]
    blank = {name: [None] * count for name in names}
    return make_table("sheets", blank | {"parts": parts, "part_area_m2": [0.1] * count})


def instances(count):
    blank = {column.name: [None] * count for column in columns("panel_instances")}
    return make_table("panel_instances", blank | {"location": [f"P-{k}" for k in range(count)]})


def test_totals_are_free_of_the_noise_of_adding():
    values = {total.column.name: total.value for total in column_totals([sheets([1] * 10)])}
    assert values["part_area_m2"] == 1.0
    assert values["parts"] == 10.0
    assert values["price"] == 0.0


def test_summary_ends_with_the_totals():
    summary = make_summary([("Greatest gap", 0.5, "mm")], [sheets([2])])
    rows = list(zip(*(cells(summary, column) for column in summary.columns), strict=True))
    assert rows[0] == ("Greatest gap", 0.5, "mm")
    assert rows[2] == ("Sheets: part area", 0.1, "m²")


def test_reconciliation_passes_and_fails():
    assert [check.status for check in reconcile([sheets([2, 3]), instances(5)])] == ["pass"]
    assert [check.status for check in reconcile([sheets([2, 3]), instances(6)])] == ["fail"]


def test_tables_without_rows_are_not_reconciled():
    assert reconcile([sheets([]), instances(6)]) == ()
    assert isinstance(make_summary([], []), Table)
