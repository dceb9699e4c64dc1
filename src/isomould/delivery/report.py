"""The page of the delivery, written when all else is written and proved."""

from collections.abc import Iterable
from dataclasses import fields
from pathlib import Path

from isomould.delivery.goods import Delivery
from isomould.delivery.pictures import flat_pictures
from isomould.documents.charts import make_charts
from isomould.documents.report import FileRow, Report
from isomould.documents.scene import make_scene
from isomould.documents.table import Table, make_table
from isomould.verify.certificate import Certificate, Check
from isomould.writers.manifest import FileEntry
from isomould.writers.report import write_report


def write_page(path: Path, delivery: Delivery, certificate: Certificate, files: Iterable[FileEntry]) -> None:
    """Write the page of a delivery over its certificate and its other files."""
    design = delivery.design
    report = Report(
        project=design.project.project,
        scene=make_scene(design.kit),
        summary=delivery.summary,
        charts=make_charts({table.name: table for table in delivery.schedules}, delivery.cost),
        pictures=flat_pictures(design),
        notes=design.notes,
        checks=_check_table(certificate),
        files=tuple(FileRow(entry.path, entry.size, entry.sha256) for entry in files),
    )
    write_report(path, report)


def _check_table(certificate: Certificate) -> Table:
    """Give the checks as the table that the workbook has, too."""
    names = [field.name for field in fields(Check)]
    return make_table("checks", {name: [getattr(check, name) for check in certificate.checks] for name in names})
