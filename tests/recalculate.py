"""LibreOffice as an independent reader: workbooks recalculated, whatever values they store."""

import re
import shutil
import subprocess
import zipfile
from pathlib import Path

import pytest

SOFFICE = shutil.which("soffice")
needs_libreoffice = pytest.mark.skipif(SOFFICE is None, reason="LibreOffice is not installed")

_ALWAYS = (
    '<?xml version="1.0" encoding="UTF-8"?><oor:items xmlns:oor="http://openoffice.org/2001/registry" '
    'xmlns:xs="http://www.w3.org/2001/XMLSchema" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance">'
    '<item oor:path="/org.openoffice.Office.Calc/Formula/Load"><prop oor:name="OOXMLRecalcMode" oor:op="fuse">'
    "<value>0</value></prop></item></oor:items>"
)


def recalculate(books: list[Path], folder: Path) -> list[Path]:
    """Let LibreOffice open and save workbooks with every formula computed anew; all in one run."""
    profile = folder / "profile"
    settings = profile / "user" / "registrymodifications.xcu"
    settings.parent.mkdir(parents=True)
    settings.write_text(_ALWAYS)
    command = [SOFFICE, f"-env:UserInstallation={profile.as_uri()}", "--headless", "--convert-to", "xlsx"]
    target = folder / "recalculated"
    subprocess.run([*command, "--outdir", target, *books], check=True, capture_output=True, timeout=280)
    return [target / book.name for book in books]


def with_cell(book: Path, sheet: int, cell: str, value: float, target: Path) -> Path:
    """Copy a workbook with another number in one cell, touching nothing else."""
    name = f"xl/worksheets/sheet{sheet}.xml"
    with zipfile.ZipFile(book) as old, zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as new:
        for entry in old.namelist():
            data = old.read(entry)
            if entry == name:
                text, hits = re.subn(rf'(<c r="{cell}"[^>]*>)<v>[^<]*</v>', rf"\g<1><v>{value!r}</v>", data.decode())
                assert hits == 1, cell
                data = text.encode()
            new.writestr(entry, data)
    return target
