"""Time of the workbook of 6,800 panels, beside that of writing the same cells plainly with XlsxWriter.

    python benchmarks/workbook.py

The plain workbook holds the same values in the same places, without tables, formats, formulas, widths and print set-up.
"""

import io
import time
from collections.abc import Callable, Sequence
from pathlib import Path

from xlsxwriter import Workbook

import isomould
from isomould.cutting import nest_kit
from isomould.delivery.goods import Delivery
from isomould.documents.overview import build_checks, kit_facts, layout_facts
from isomould.documents.table import Table, cells
from isomould.documents.totals import make_summary
from isomould.nesting.search import Search
from isomould.parts.solid import make_solids
from isomould.workers import one_by_one
from isomould.writers.csv import csv_text
from isomould.writers.xlsx import Words, workbook_bytes

TEMPLATE = Path(__file__).parents[1] / "templates" / "barrel-vault.toml"
SIZES = ((18, 8), (44, 37))
"""Nodes of the rail, and nodes per arc of the generatrix: the template as it is, and 6,800 panels."""
_RUNS = 3


def deliver(rail: int, arc: int) -> Delivery:
    """Compute a delivery of a barrel vault; blanks to order instead of sheets, for nesting is not measured here."""
    scale = max(1.0, rail / 18)
    sizes = [f"rail.divide.nodes={rail}", f"generatrix.divide.per_arc={arc}", "stock.sheets=[]", "stock.bars=[]"]
    spans = [f"rail.curve.span={24_000 * scale}", f"generatrix.curve.wavelength={14_000 * arc / 8}"]
    heights = [f"rail.curve.rise={9_000 * scale}", f"generatrix.curve.amplitude={1_000 * arc / 8}"]
    free = ["tolerances.max_deviation=100000"]
    design = isomould.check(TEMPLATE, [*sizes, *spans, *heights, *free]).design
    solids = make_solids(design.kit.nodes, design.kit.drum, design.project.nodes.slot_end)
    section = design.project.members.section.name
    cutting = nest_kit(design.kit, section, design.project.stock, Search("quick"), one_by_one)
    return Delivery(design, solids, {}, cutting)


def sheets_of(delivery: Delivery) -> tuple[Table, ...]:
    """Give all tables of the workbook."""
    cutting, kit = delivery.cutting, delivery.design.kit
    facts = (*kit_facts(kit), *layout_facts(cutting.sheets, cutting.bars))
    checks = build_checks(kit, delivery.solids, cutting.sheets)
    return make_summary(facts, delivery.tables), *delivery.tables, checks


def plainly(tables: Sequence[Table]) -> bytes:
    """Write the same cells and nothing else."""
    buffer = io.BytesIO()
    with Workbook(buffer, {"in_memory": True}) as book:
        for table in tables:
            sheet = book.add_worksheet(table.title)
            for index, column in enumerate(table.columns):
                sheet.write_string(0, index, column.header)
                for row, cell in enumerate(cells(table, column), start=1):
                    if isinstance(cell, str):
                        sheet.write_string(row, index, cell)
                    elif cell is not None:
                        sheet.write_number(row, index, cell)
    return buffer.getvalue()


def best(work: Callable[[], object]) -> float:
    """Best time of several runs, in seconds of the processor, for other work may go on beside."""
    found = float("inf")
    for _ in range(_RUNS):
        begin = time.process_time()
        work()
        found = min(found, time.process_time() - begin)
    return found


def main() -> None:
    print("panels      cells   workbook      plain   ratio        csv")
    for sizes in SIZES:
        delivery = deliver(*sizes)
        tables = sheets_of(delivery)
        words = Words(delivery.design.project.project, delivery.design.notes, delivery.cost.results)
        count = sum(table.frame.size for table in tables)
        ours, plain = best(lambda t=tables, w=words: workbook_bytes(t, w)), best(lambda t=tables: plainly(t))
        csv = best(lambda t=tables: [csv_text(table) for table in t])
        panels = len(delivery.design.kit.mesh.face_ij)
        print(f"{panels:6d} {count:10d} {ours:8.2f} s {plain:8.2f} s {ours / plain:7.2f} {csv:8.2f} s")


if __name__ == "__main__":
    main()
