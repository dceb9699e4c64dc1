"""The page of a delivery: one file that shows user text as text, the same bytes every time."""

import re

import numpy as np
import pytest

from isomould.documents.charts import Chart
from isomould.documents.info import ProjectInfo
from isomould.documents.report import FileRow, Report
from isomould.documents.scene import make_scene
from isomould.documents.table import make_table
from isomould.errors import Note
from isomould.verify.read.page import read_page
from isomould.writers.report import chart_figure, report_text, scene_figure, write_report
from museum import SMALL, design

EVIL = '</script><script src="https://a.b/c.js"></script><img src=x onerror=alert(1)>&amp;'
ROW = {
    "id": ["V1"],
    "what": ["planes"],
    "count": [3],
    "worst": [2.5e-12],
    "where": [EVIL],
    "limit": [1e-6],
    "unit": ["mm"],
    "status": ["pass"],
    "reason": [None],
}


@pytest.fixture(scope="module")
def report():
    return Report(
        project=ProjectInfo(name=f"A {EVIL}"[:100], client="Κτίριο & Söhne"),
        scene=make_scene(design(SMALL).kit),
        summary=make_table("summary", {"item": ["Nodes", EVIL], "value": [680, 0.1 + 0.2], "unit": [None, "mm"]}),
        charts=(Chart(EVIL, "pieces", ("N01", EVIL), (3.0, 4.0)),),
        pictures=(),
        notes=(Note("W-X", "rail", EVIL),),
        checks=make_table("checks", ROW),
        files=(FileRow("panels/P 01#.dxf", 12345678, "ab"), FileRow("schedules.xlsx", 1, "cd")),
    )


def test_user_text_stays_text(report, tmp_path):
    write_report(tmp_path / "report.html", report)
    page = read_page(tmp_path / "report.html")
    assert page.loaded == ()
    assert page.tables["certificate"] == [("V1", "planes", "3", "2.5e-12", EVIL, "1e-06", "mm", "pass", "")]
    assert page.tables["summary"] == [("Nodes", "680", ""), (EVIL, "0.3", "mm")]
    assert page.tables["files"] == [("panels/P 01#.dxf", "12345678", "ab"), ("schedules.xlsx", "1", "cd")]
    assert [link for link in page.linked if link[0] != "#"] == ["panels/P%2001%23.dxf", "schedules.xlsx"]
    text = (tmp_path / "report.html").read_text("utf-8")
    assert text.count("<script") == text.count("</script>")
    assert "onerror=alert(1)>" not in text
    assert "Κτίριο &amp; Söhne" in text


def test_the_same_report_is_the_same_text(report):
    assert report_text(report) == report_text(report)


def test_a_failed_check_is_said_first(report):
    bad = make_table("checks", {**ROW, "status": ["fail"]})
    text = report_text(Report(**{**vars(report), "checks": bad}))
    assert re.search(r'class="banner bad">1 checks failed', text)


def test_the_scene_shows_every_part_where_it_stands(report):
    figure, scene = scene_figure(report.scene), report.scene
    panels, *members, nodes = figure.data
    places = np.array([nodes.x, nodes.y, nodes.z]).T
    assert places == pytest.approx(scene.nodes.places, abs=1e-5)
    assert len(panels.facecolor) == len(scene.panels.triangles)
    for drawn, strokes in zip(members, scene.members, strict=True):
        path = np.array([drawn.x, drawn.y, drawn.z]).T.reshape(-1, 4, 3)
        assert path[:, [0, 2]] == pytest.approx(strokes.ends, abs=1e-5)
        assert np.isnan(path[:, 3]).all()
        assert drawn.text[2::4] == strokes.texts


def test_a_chart_has_a_bar_for_every_label(report):
    bars = chart_figure(report.charts[0]).data[0]
    assert (list(bars.y), len(bars.x)) == ([3.0, 4.0], 2)
