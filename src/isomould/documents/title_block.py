"""The title block: what every document says about its project."""

from isomould.documents.info import DatumSettings, ProjectInfo
from isomould.documents.numbers import format_number


def heading(info: ProjectInfo) -> str:
    """Give the project in one line, without what was left empty.

    >>> heading(ProjectInfo(name="Barrel vault", revision="B"))
    'Barrel vault, revision B'
    """
    revision = f"revision {info.revision}" if info.revision else ""
    return ", ".join(filter(None, (info.name, info.number, revision)))


def datum_text(datum: DatumSettings) -> str:
    """Say where the project's origin lies in the datum of the site, and how its x axis is turned there.

    >>> datum_text(DatumSettings(origin=(1000.0, -250.5, 0.0), rotation_deg=12.5))
    'origin at 1000, -250.5, 0 mm; x axis turned by 12.5°'
    """
    origin = ", ".join(format_number(value, 3) for value in datum.origin)
    return f"origin at {origin} mm; x axis turned by {format_number(datum.rotation_deg, 9)}°"


def title_lines(info: ProjectInfo) -> list[tuple[str, str]]:
    """Give project and datum as pairs of label and text, without what was left empty."""
    date = info.date.isoformat() if info.date else ""
    texts = {"Project": info.name, "Number": info.number, "Client": info.client, "Revision": info.revision}
    more = {"Author": info.author, "Date": date, "Datum": datum_text(info.datum)}
    return [(label, text) for label, text in {**texts, **more}.items() if text]
