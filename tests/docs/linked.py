"""LibreOffice as the office: a workbook of its own that refers to ours, opened with its links brought up to date."""

import subprocess
from pathlib import Path

from recalculate import SOFFICE

_ITEM = (
    '<item oor:path="/org.openoffice.Office.{path}"><prop oor:name="{name}" oor:op="fuse"><value>{value}</value>{end}'
)
_SETTINGS = (
    '<?xml version="1.0" encoding="UTF-8"?><oor:items xmlns:oor="http://openoffice.org/2001/registry">'
    + _ITEM.format(path="Calc/Content/Update", name="Link", value=0, end="</prop></item>")
    + _ITEM.format(path="Common/Security/Scripting", name="MacroSecurityLevel", value=0, end="</prop></item>")
    + "</oor:items>"
)
_LIBRARIES = """<?xml version="1.0" encoding="UTF-8"?>
<!DOCTYPE library:libraries PUBLIC "-//OpenOffice.org//DTD OfficeDocument 1.0//EN" "libraries.dtd">
<library:libraries xmlns:library="http://openoffice.org/2000/library" xmlns:xlink="http://www.w3.org/1999/xlink">
<library:library library:name="Standard" library:link="false"/></library:libraries>
"""
_LIBRARY = """<?xml version="1.0" encoding="UTF-8"?>
<!DOCTYPE library:library PUBLIC "-//OpenOffice.org//DTD OfficeDocument 1.0//EN" "library.dtd">
<library:library xmlns:library="http://openoffice.org/2000/library" library:name="Standard" library:readonly="false"
 library:passwordprotected="false"><library:element library:name="Links"/></library:library>
"""
_MACRO = """<?xml version="1.0" encoding="UTF-8"?>
<!DOCTYPE script:module PUBLIC "-//OpenOffice.org//DTD OfficeDocument 1.0//EN" "module.dtd">
<script:module xmlns:script="http://openoffice.org/2000/script" script:name="Links" script:language="StarBasic">
Sub Refresh(source As String, target As String)
Dim how(1) As New com.sun.star.beans.PropertyValue
how(0).Name = "Hidden"
how(0).Value = True
how(1).Name = "UpdateDocMode"
how(1).Value = com.sun.star.document.UpdateDocMode.FULL_UPDATE
book = StarDesktop.loadComponentFromURL(source, "_blank", 0, how())
Dim kind(0) As New com.sun.star.beans.PropertyValue
kind(0).Name = "FilterName"
kind(0).Value = "Text - txt - csv (StarCalc)"
book.storeToURL(target, kind())
book.close(True)
StarDesktop.terminate()
End Sub
</script:module>
"""
_SPACES = " ".join(
    f'xmlns:{name}="urn:oasis:names:tc:opendocument:xmlns:{name}:1.0"' for name in ("office", "table", "text")
)


def write_office_book(path: Path, cells: list[tuple[str, float]]) -> Path:
    """Write a workbook (flat OpenDocument) of one column: formulas, and the values that they had when it was saved."""
    rows = "".join(
        f'<table:table-row><table:table-cell table:formula="of:={formula}" office:value-type="float" '
        f'office:value="{value}"/></table:table-row>'
        for formula, value in cells
    )
    path.write_text(
        f'<?xml version="1.0" encoding="UTF-8"?><office:document {_SPACES} xmlns:of="urn:oasis:names:tc:opendocument:'
        'xmlns:of:1.2" office:version="1.2" office:mimetype="application/vnd.oasis.opendocument.spreadsheet">'
        f'<office:body><office:spreadsheet><table:table table:name="Office">{rows}</table:table></office:spreadsheet>'
        "</office:body></office:document>"
    )
    return path


def refreshed(book: Path, folder: Path) -> list[float]:
    """Open a workbook with its links brought up to date, and give its column."""
    profile, target = _profile(folder / "office"), folder / "refreshed.csv"
    _run(profile, f"macro:///Standard.Links.Refresh({book.as_uri()},{target.as_uri()})")
    return [float(line) for line in target.read_text().split()]


def _profile(folder: Path) -> Path:
    """Make a profile that updates links and knows the macro; the first start writes libraries of its own."""
    settings, basic = folder / "user" / "registrymodifications.xcu", folder / "user" / "basic"
    settings.parent.mkdir(parents=True)
    settings.write_text(_SETTINGS)
    _run(folder, "--terminate_after_init")
    texts = {"script.xlc": _LIBRARIES, "Standard/script.xlb": _LIBRARY, "Standard/Links.xba": _MACRO}
    for name, text in texts.items():
        (basic / name).parent.mkdir(parents=True, exist_ok=True)
        (basic / name).write_text(text)
    return folder


def _run(profile: Path, *arguments: str) -> None:
    command = [str(SOFFICE), f"-env:UserInstallation={profile.as_uri()}", "--headless", "--norestore", *arguments]
    subprocess.run(command, check=True, capture_output=True, timeout=120)
