"""Nests against rectpack and spyrrow in one run: own trapezoids, and how time grows with pieces.

    python -m benchmarks [--effort quick|normal|best] [--spyrrow SECONDS] [--most PIECES]

Prints the tables of docs/nesting.md. Every layout is proved by the checker before it is counted; seconds are the
processor's, then the clock's.
"""

import argparse
from dataclasses import replace

from benchmarks.nesting import line, measure, rectangles, strip
from benchmarks.trapezoids import SHAPES, STOCK, trapezoids

from isomould.intake.instance import Instance
from isomould.nesting.search import Search

COLUMNS = ("instance", "pieces", "sheets", "bound", "gap", "of the pattern", "yield %", "seconds")


def main() -> None:
    cli = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    cli.add_argument("--effort", choices=["quick", "normal", "best"], default="normal")
    cli.add_argument("--spyrrow", type=int, default=20, metavar="SECONDS", help="that spyrrow gets; 0 leaves it out")
    cli.add_argument("--most", type=int, default=100_000, help="pieces up to which time is measured")
    given = cli.parse_args()
    shapes(Search(given.effort), given.spyrrow)
    growth(Search(given.effort), given.most)


def shapes(task: Search, seconds: int) -> None:
    print(line([*COLUMNS, "rectpack", "spyrrow"]), line(["---"] * 10), sep="\n")
    for shape in SHAPES:
        instance = Instance(f"{shape}-1", trapezoids(shape, 1), STOCK)
        others = [rectangles(instance), strip(instance, seconds) if seconds else ""]
        print(line([*measure(instance, task), *others]), flush=True)


def growth(task: Search, most: int) -> None:
    """Twenty different panels, ten times as many of each again and again."""
    print("", line(COLUMNS), line(["---"] * 8), sep="\n")
    panels = trapezoids("isosceles", 2)[::12]
    for times in (5, 50, 500, 5000):
        if times * len(panels) <= most:
            parts = tuple(replace(part, quantity=times) for part in panels)
            print(line(measure(Instance("twenty kinds", parts, STOCK), task)), flush=True)


main()
