"""The page of a delivery: what people look at first, before they open files."""

from dataclasses import dataclass

from isomould.documents.charts import Chart
from isomould.documents.info import ProjectInfo
from isomould.documents.picture import Picture
from isomould.documents.scene import Scene
from isomould.documents.table import Table
from isomould.errors import Note


@dataclass(frozen=True)
class FileRow:
    """A file of the folder: path with /, size in bytes and hash."""

    path: str
    size: int
    sha256: str


@dataclass(frozen=True, eq=False)
class Report:
    """What stands on the page.

    Attributes
    ----------
    summary : Table
        Key figures and totals, as in the workbook.
    checks : Table
        The certificate, its checks of this page apart.
    files
        All files of the folder but manifest, certificate and this page.
    """

    project: ProjectInfo
    scene: Scene
    summary: Table
    charts: tuple[Chart, ...]
    pictures: tuple[Picture, ...]
    notes: tuple[Note, ...]
    checks: Table
    files: tuple[FileRow, ...]
