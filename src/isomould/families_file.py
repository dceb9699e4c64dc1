"""A comparison of mesh families as a file of its own, with what repetition costs where there are rates."""

from dataclasses import replace
from pathlib import Path

from isomould.comparison import Compared, families_table
from isomould.documents.table import Table
from isomould.errors import Refused
from isomould.nesting.settings import StockSettings
from isomould.project.load import LoadedProject
from isomould.project.schema import Project
from isomould.repetition import is_priced, make_pricing, price_families
from isomould.writers.csv import csv_text
from isomould.writers.disk import replace_file
from isomould.writers.xlsx import Words, workbook_bytes


def write_families(out: Path, compared: tuple[Compared, ...], loaded: LoadedProject) -> None:
    """Write a comparison in the format that the file's name asks for, whole or not at all.

    Raises
    ------
    Refused
        E-COMPARE-FILE for other formats than CSV and XLSX.
    """
    table = families_table(compared)
    match out.suffix.lower():
        case ".csv":
            replace_file(out, csv_text(table).encode())
        case ".xlsx":
            words = Words(loaded.project.project, logo=loaded.logo)
            replace_file(out, workbook_bytes((table, *_priced(compared, loaded.project)), words))
        case _:
            way_out = "Write --out families.csv or --out families.xlsx."
            raise Refused("E-COMPARE-FILE", "--out", str(out), "a file that ends in .csv or .xlsx", way_out)


def _priced(compared: tuple[Compared, ...], project: Project) -> tuple[Table, ...]:
    """Give rates and the price of repetition, if the project has rates."""
    if not is_priced(project):
        return ()
    pricing = replace(make_pricing(project, project.stock or StockSettings()), repetition=True)
    return price_families(compared, project, pricing)
