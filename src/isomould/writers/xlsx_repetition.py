"""Charts of the price of repetition: what each mesh family costs, and how many classes it has."""

from typing import cast

from xlsxwriter.chart_column import ChartColumn

from isomould.documents.repetition import WORKS
from isomould.writers.xlsx_page import Page

_CLASSES = ("node_classes", "member_classes", "panel_classes")
_SIZE = {"width": 900, "height": 420}
_ROWS_PER_CHART = 22


def draw_repetition(page: Page) -> None:
    """Draw both charts under the table: works stacked per family, classes side by side."""
    currency = str(page.table.frame["currency"].iloc[0])
    _draw(page, "stacked", WORKS, f"What the works cost ({currency})", 0)
    _draw(page, "clustered", _CLASSES, "Classes", _ROWS_PER_CHART)


def _draw(page: Page, kind: str, columns: tuple[str, ...], title: str, rows: int) -> None:
    options = {"type": "column", "subtype": kind} if kind == "stacked" else {"type": "column"}
    chart = cast("ChartColumn", page.book.add_chart(options))
    names = [column.name for column in page.table.columns]
    last, sheet = len(page.table.frame), page.table.title
    for name in columns:
        at = names.index(name)
        chart.add_series(
            {"name": [sheet, 0, at], "categories": [sheet, 1, 0, last, 0], "values": [sheet, 1, at, last, at]}
        )
    chart.set_title({"name": title, "name_font": {"size": 13}})
    chart.set_legend({"position": "right"})
    chart.set_y_axis({"num_format": "#,##0", "major_gridlines": {"visible": True, "line": {"color": "#D9D9D9"}}})
    chart.set_size(_SIZE)
    page.sheet.insert_chart(page.below + rows, 0, chart)
