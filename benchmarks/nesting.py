"""Sheets, bound, yield and seconds for part lists, with rectpack's best beside them.

    python benchmarks/nesting.py INSTANCE.json … [--effort quick|normal|best] [--no-rectpack]

Every layout is proved by the checker before it is counted. rectpack nests bounding rectangles with a
quarter turn allowed, the gap added to each side and to the sheet; the best of its algorithms counts.
"""

import argparse
import time
from itertools import product
from pathlib import Path

import numpy as np
import rectpack

from isomould.nesting.instance import Instance, read_instance
from isomould.nesting.nest import nest_sheets
from isomould.nesting.search import Search

ALGORITHMS = (rectpack.MaxRectsBssf, rectpack.MaxRectsBaf, rectpack.MaxRectsBlsf, rectpack.SkylineMwfl)
ORDERS = (rectpack.SORT_AREA, rectpack.SORT_LSIDE, rectpack.SORT_SSIDE)
COLUMNS = "{:<24}{:>8}{:>8}{:>7}{:>9}{:>9}{:>10}"


def main() -> None:
    cli = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    cli.add_argument("instances", nargs="+", type=Path)
    cli.add_argument("--effort", choices=["quick", "normal", "best"], default="normal")
    cli.add_argument("--no-rectpack", action="store_true")
    given = cli.parse_args()
    print(COLUMNS.format("instance", "pieces", "sheets", "bound", "yield %", "seconds", "rectpack"))
    for path in given.instances:
        print(
            measure(read_instance(path), Search(given.effort), with_rectpack=not given.no_rectpack),
            flush=True,
        )


def measure(instance: Instance, task: Search, *, with_rectpack: bool) -> str:
    start = time.perf_counter()
    layout = nest_sheets(instance.parts, instance.stock, task)
    seconds = time.perf_counter() - start
    row = (
        len(layout.placements),
        len(layout.sheets),
        layout.bound,
        f"{layout.yield_percent:.2f}",
        f"{seconds:.1f}",
    )
    return COLUMNS.format(instance.name, *row, rectangles(instance) if with_rectpack else "-")


def rectangles(instance: Instance) -> int:
    """Give the sheets of the best of rectpack's algorithms and orders."""
    boxes = [np.ptp(part.outline, axis=0) for part in instance.parts for _ in range(part.quantity)]
    sizes = [tuple(int(np.ceil((side + instance.stock.gap) * 1000)) for side in box) for box in boxes]
    sheet, trim = instance.stock.sheets[0], instance.stock.trim
    room = tuple(int((side - 2 * trim + instance.stock.gap) * 1000) for side in (sheet.width, sheet.height))
    return min(packed(sizes, room, *case) for case in product(ALGORITHMS, ORDERS))


def packed(sizes: list[tuple[int, ...]], room: tuple[int, ...], algorithm: type, order: object) -> int:
    packer = rectpack.newPacker(pack_algo=algorithm, sort_algo=order)
    for size in sizes:
        packer.add_rect(*size)
    packer.add_bin(*room, count=len(sizes))
    packer.pack()
    return len(packer)


if __name__ == "__main__":
    main()
