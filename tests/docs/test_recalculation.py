"""LibreOffice, an independent reader, opens the workbook and recalculates every stored value."""

import shutil
import subprocess

import openpyxl
import pytest

SOFFICE = shutil.which("soffice")


@pytest.mark.slow
@pytest.mark.skipif(SOFFICE is None, reason="LibreOffice is not installed")
def test_every_stored_value_comes_back(built_folder, tmp_path):
    profile = tmp_path / "profile"
    settings = profile / "user" / "registrymodifications.xcu"
    settings.parent.mkdir(parents=True)
    settings.write_text(
        '<?xml version="1.0" encoding="UTF-8"?><oor:items xmlns:oor="http://openoffice.org/2001/registry" '
        'xmlns:xs="http://www.w3.org/2001/XMLSchema" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance">'
        '<item oor:path="/org.openoffice.Office.Calc/Formula/Load"><prop oor:name="OOXMLRecalcMode" oor:op="fuse">'
        "<value>0</value></prop></item></oor:items>"
    )
    command = [SOFFICE, f"-env:UserInstallation={profile.as_uri()}", "--headless", "--convert-to", "xlsx"]
    subprocess.run(
        [*command, "--outdir", tmp_path, built_folder / "schedules.xlsx"], check=True, capture_output=True, timeout=180
    )
    ours = openpyxl.load_workbook(built_folder / "schedules.xlsx", data_only=True)
    theirs = openpyxl.load_workbook(tmp_path / "schedules.xlsx", data_only=True)
    formulas = openpyxl.load_workbook(built_folder / "schedules.xlsx")
    compared = 0
    for sheet in formulas:
        for row in sheet.iter_rows():
            for cell in row:
                if cell.data_type == "f":
                    stored, found = (book[sheet.title][cell.coordinate].value for book in (ours, theirs))
                    assert found == (pytest.approx(stored, rel=1e-12) if isinstance(stored, float | int) else stored)
                    compared += 1
    assert compared > 50
