"""The title block: what every document says about its project."""

from dataclasses import dataclass

from isomould.documents.info import ProjectInfo


@dataclass(frozen=True)
class Logo:
    """A picture (PNG) and its size in pixels."""

    content: bytes
    width: int
    height: int


def heading(info: ProjectInfo) -> str:
    """Give the project in one line, without what was left empty.

    >>> heading(ProjectInfo(name="Barrel vault", revision="B"))
    'Barrel vault, revision B'
    """
    revision = f"revision {info.revision}" if info.revision else ""
    return ", ".join(filter(None, (info.name, info.number, revision)))


def title_lines(info: ProjectInfo) -> list[tuple[str, str]]:
    """Give the title block as pairs of label and text."""
    date = info.date.isoformat() if info.date else ""
    texts = {"Project": info.name, "Number": info.number, "Client": info.client, "Revision": info.revision}
    return [(label, text) for label, text in {**texts, "Author": info.author, "Date": date}.items() if text]
