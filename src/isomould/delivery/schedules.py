"""The tables as CSV and as workbook."""

from pathlib import Path

from isomould.delivery.goods import Delivery
from isomould.documents.overview import build_checks
from isomould.writers.csv import write_csv
from isomould.writers.parquet import write_parquet
from isomould.writers.xlsx import Words, write_workbook


def write_schedules(folder: Path, delivery: Delivery) -> None:
    """Write every table as CSV, as Parquet if asked for, and the workbook."""
    design, cutting, tables = delivery.design, delivery.cutting, delivery.tables
    for table in tables:
        write_csv(folder / "tables" / f"{table.name}.csv", table)
        if design.project.deliver.parquet:
            write_parquet(folder / "tables" / f"{table.name}.parquet", table)
    checks = build_checks(design.kit, delivery.solids, cutting.sheets)
    words = Words(design.project.project, design.notes, delivery.cost.results, delivery.logo)
    write_workbook(folder / "schedules.xlsx", (delivery.summary, *tables, checks), words)


def write_bars(path: Path, delivery: Delivery) -> None:
    """Write the bars once more, beside the saw."""
    for table in delivery.tables:
        if table.name == "bars":
            write_csv(path, table)
