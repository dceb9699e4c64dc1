"""The page as people see it: in a browser, the whole building stands inside the frame."""

import io
import shutil
import subprocess

import numpy as np
import pytest
from PIL import Image

from isomould.documents.info import ProjectInfo
from isomould.documents.report import Report
from isomould.documents.scene import make_scene
from isomould.documents.table import make_table
from isomould.writers.report import report_text
from museum import SMALL, design, sphere

BROWSER = next(
    (found for name in ("chromium", "chromium-browser", "google-chrome") if (found := shutil.which(name))), ""
)
CHECKS = {
    "id": ["V1"], "what": ["planes"], "count": [3], "worst": [0.0], "where": ["P"], "limit": [1.0], "unit": ["mm"],
    "status": ["pass"], "reason": [None],
}  # fmt: skip

ALONE = """<style>
body { margin: 0 !important; padding: 0 !important; max-width: none !important; }
body > *:not(#model), #model > h2, .infolayer, .menulayer, .modebar-container { display: none !important; }
</style></head>"""
"""Everything but the model is hidden, so that the picture is its room alone."""

WIDTH, HEIGHT = 1200, 640
"""The room of the model is 40rem high and as wide as the window."""

SHAPES = {
    "vault": SMALL,
    "ball": sphere(30, 60),
}


def screenshot(page, folder):
    picture = folder / "page.png"
    flags = ("--headless=new", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
             "--hide-scrollbars", "--virtual-time-budget=15000", f"--window-size={WIDTH},{HEIGHT + 200}",
             f"--user-data-dir={folder / 'profile'}", f"--screenshot={picture}")  # fmt: skip
    subprocess.run([BROWSER, *flags, page.as_uri()], check=True, capture_output=True, timeout=240)
    return np.asarray(Image.open(io.BytesIO(picture.read_bytes())).convert("RGB")).astype(int)


@pytest.mark.slow
@pytest.mark.skipif(not BROWSER, reason="no Chromium on this machine")
@pytest.mark.parametrize("shape", SHAPES)
def test_the_whole_building_stands_inside_the_frame(shape, tmp_path):
    report = Report(
        project=ProjectInfo(name="Page"),
        scene=make_scene(design(SHAPES[shape]).kit),
        summary=make_table("summary", {"item": ["Nodes"], "value": [1], "unit": [None]}),
        charts=(),
        pictures=(),
        notes=(),
        checks=make_table("checks", CHECKS),
        files=(),
    )
    page = tmp_path / "report.html"
    page.write_text(report_text(report).replace("</head>", ALONE, 1), encoding="utf-8")
    pixels = screenshot(page, tmp_path)
    drawn = np.abs(pixels - 255).max(axis=2) > 24
    rows, columns = np.flatnonzero(drawn.any(axis=1)), np.flatnonzero(drawn.any(axis=0))
    assert len(rows)
    assert min(rows[0], columns[0], HEIGHT - 1 - rows[-1], WIDTH - 1 - columns[-1]) >= 8
    assert max((rows[-1] - rows[0]) / HEIGHT, (columns[-1] - columns[0]) / WIDTH) > 0.45
