"""Sheets, bound, yield and seconds for part lists, others' programs beside them: the table in docs/nesting.md.

    python benchmarks/nesting.py INSTANCE.json … [--effort quick|normal|best] [--jobs N] [--no-rectpack]
        [--spyrrow SECONDS]

Every layout of ours is proved by the checker before it is counted. rectpack nests bounding rectangles with a quarter
turn allowed, the gap added to each side and to the sheet; the best of its algorithms counts. spyrrow nests outlines
with all four turns on one endless strip as high as a sheet: its length in sheets is optimistic, for nothing is lost
at their ends. Seconds are the processor's, of all processes, for other work on the machine does not lengthen them
much, and after the / those of the clock.
"""

import argparse
import os
import time
from itertools import product
from pathlib import Path

import numpy as np
import rectpack
import spyrrow

from isomould.intake.instance import Instance, read_instance
from isomould.nesting.checker import check_layout
from isomould.nesting.nest import nest_sheets
from isomould.nesting.search import Search

ALGORITHMS = (rectpack.MaxRectsBssf, rectpack.MaxRectsBaf, rectpack.MaxRectsBlsf, rectpack.SkylineMwfl)
ORDERS = (rectpack.SORT_AREA, rectpack.SORT_LSIDE, rectpack.SORT_SSIDE)
HEADER = ("instance", "pieces", "sheets", "bound", "gap", "of the pattern", "yield %", "seconds", "rectpack", "spyrrow")


def main() -> None:
    cli = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    cli.add_argument("instances", nargs="+", type=Path)
    cli.add_argument("--effort", choices=["quick", "normal", "best"], default="normal")
    cli.add_argument("--no-rectpack", action="store_true")
    cli.add_argument("--spyrrow", type=int, default=0, metavar="SECONDS", help="that spyrrow gets; 0 leaves it out")
    cli.add_argument("--jobs", type=int, default=1)
    given = cli.parse_args()
    print(line(HEADER), line(["---"] * len(HEADER)), sep="\n")
    for path in given.instances:
        instance = read_instance(path)
        others = [
            "" if given.no_rectpack else rectangles(instance),
            strip(instance, given.spyrrow) if given.spyrrow else "",
        ]
        print(line([*measure(instance, Search(given.effort, jobs=given.jobs)), *others]), flush=True)


def line(cells: object) -> str:
    return "| " + " | ".join(str(cell) for cell in cells) + " |"


def measure(instance: Instance, task: Search) -> tuple[object, ...]:
    start, clock = processor(), time.perf_counter()
    layout = nest_sheets(instance.parts, instance.stock, task)
    seconds = f"{processor() - start:.1f} / {time.perf_counter() - clock:.1f}"
    findings = check_layout(instance.parts, instance.stock, layout)
    assert not findings, findings[0]
    counts = (len(layout.placements), len(layout.sheets), layout.bound, layout.gap_to_bound, layout.pattern_bound or "")
    return (instance.name, *counts, f"{layout.yield_percent:.2f}", seconds)


def processor() -> float:
    """Give the seconds of this process and of those that it has waited for."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


def rectangles(instance: Instance) -> int:
    """Give the sheets of the best of rectpack's algorithms and orders."""
    boxes = [np.ptp(part.outline, axis=0) for part in instance.parts for _ in range(part.quantity)]
    sizes = [tuple(int(np.ceil((side + instance.stock.gap) * 1000)) for side in box) for box in boxes]
    sheet, trim = instance.stock.sheets[0], instance.stock.trim
    room = tuple(int((side - 2 * trim + instance.stock.gap) * 1000) for side in (sheet.width, sheet.height))
    return min(packed(sizes, room, *case) for case in product(ALGORITHMS, ORDERS))


def packed(
    sizes: list[tuple[int, ...]], room: tuple[int, ...], algorithm: type, order: object, *, turned: bool = True
) -> int:
    packer = rectpack.newPacker(pack_algo=algorithm, sort_algo=order, rotation=turned)
    for size in sizes:
        packer.add_rect(*size)
    packer.add_bin(*room, count=len(sizes))
    packer.pack()
    return len(packer)


def strip(instance: Instance, seconds: int) -> str:
    """Give the length of spyrrow's strip in sheets."""
    stock, sheet = instance.stock, instance.stock.sheets[0]
    turns = [0.0, 90.0, 180.0, 270.0]
    items = [spyrrow.Item(str(p.id), [*map(tuple, p.outline.tolist())], p.quantity, turns) for p in instance.parts]
    asked = spyrrow.StripPackingInstance(instance.name, strip_height=sheet.height - 2 * stock.trim, items=items)
    settings = spyrrow.StripPackingConfig(
        total_computation_time=seconds, min_items_separation=stock.gap, num_workers=1, seed=0
    )
    length = asked.solve(settings).width + stock.gap
    return f"{length / (sheet.width - 2 * stock.trim + stock.gap):.1f}"


if __name__ == "__main__":
    main()
