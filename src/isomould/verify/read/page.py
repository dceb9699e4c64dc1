"""`report.html`: its tables as texts, and what it refers to outside itself."""

from dataclasses import dataclass, field
from html.parser import HTMLParser
from pathlib import Path

from isomould.verify.read.text import refusing

Row = tuple[str, ...]


@dataclass(frozen=True)
class Page:
    """Rows of the tables by their id or else class, cell by cell; what is loaded, and what is linked to."""

    tables: dict[str, list[Row]]
    loaded: tuple[str, ...]
    linked: tuple[str, ...]


@refusing
def read_page(path: Path) -> Page:
    """Read a page."""
    reader = _Reader()
    reader.feed(path.read_text("utf-8"))
    reader.close()
    return Page(reader.tables, tuple(reader.loaded), tuple(reader.linked))


@dataclass
class _Reader(HTMLParser):
    """Collects cells (td) of rows of tables."""

    tables: dict[str, list[Row]] = field(default_factory=dict[str, list[Row]])
    loaded: list[str] = field(default_factory=list[str])
    linked: list[str] = field(default_factory=list[str])
    _table: str = ""
    _row: list[str] = field(default_factory=list[str])
    _in_cell: bool = False

    def __post_init__(self) -> None:
        super().__init__()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        named = {name: value or "" for name, value in attrs}
        self.loaded += [named["src"]] if "src" in named else []
        self.loaded += [named.get("href", "")] if tag == "link" else []
        self.linked += [named["href"]] if tag == "a" and "href" in named else []
        if tag == "table":
            self._table = named.get("id") or named.get("class", "")
        elif tag == "tr":
            self._row = []
        elif tag == "td":
            self._in_cell = True
            self._row.append("")

    def handle_endtag(self, tag: str) -> None:
        if tag == "td":
            self._in_cell = False
        elif tag == "tr" and self._row:
            self.tables.setdefault(self._table, []).append(tuple(self._row))

    def handle_data(self, data: str) -> None:
        if self._in_cell:
            self._row[-1] += data
