"""Bars, bound and seconds for 1,300 members of many lengths, and how time grows: tables in docs/nesting.md.

    python benchmarks/bars.py [SEED …]
    python benchmarks/bars.py growth

Lengths are drawn evenly between two limits, to 0.001 mm, and pieces shared out among them by lot; kerf 3 mm. Every
layout is proved by the checker before it is counted. FFD is first fit decreasing alone. Seconds are the processor's.
"""

import sys
import time

import numpy as np

from isomould.nesting.bar_checker import check_bars
from isomould.nesting.bar_greedy import first_fit
from isomould.nesting.bar_rack import ENDLESS, BarRack, Need, bars_in
from isomould.nesting.bars import nest_bars
from isomould.nesting.layout import Member
from isomould.nesting.settings import BarStock, StockSettings

PIECES = 1300
KINDS = [
    (30, (600, 2400), 6000),
    (30, (600, 2400), 12000),
    (700, (600, 2400), 6000),
    (700, (600, 2400), 12000),
    (30, (1200, 3600), 6000),
    (700, (1200, 3600), 6000),
]


GROWTH = [1_000, 10_000, 100_000]
"""Pieces of 100 lengths, 600 to 2,400 mm, on bars of 6 m."""


def main() -> None:
    if sys.argv[1:] == ["growth"]:
        grow()
        return
    print("| seed | lengths | from, to | bar | FFD | bars | bound | by | seconds |", "| --- " * 9 + "|", sep="\n")
    for seed in [int(word) for word in sys.argv[1:]] or [1]:
        for lengths, limits, bar in KINDS:
            print(line(seed, lengths, limits, bar), flush=True)


def line(seed: int, lengths: int, limits: tuple[int, int], bar: int) -> str:
    chance = np.random.default_rng(seed)
    sizes = np.round(chance.uniform(*limits, lengths), 3)
    counts = 1 + chance.multinomial(PIECES - lengths, np.full(lengths, 1 / lengths))
    members = [Member(k, "P", float(x), int(n)) for k, (x, n) in enumerate(zip(sizes, counts, strict=True))]
    stock = StockSettings(bars=(BarStock(section="P", length=bar),), bar_kerf=3)
    start = time.process_time()
    layout = nest_bars(members, stock)
    seconds = time.process_time() - start
    findings = check_bars(members, stock, layout)
    assert not findings, findings[0]
    plain = bars_in(first_fit(*rack(sizes, counts, bar)))
    found = (plain, len(layout.bars), layout.bound, layout.bound_kind, f"{seconds:.1f}")
    cells = (seed, lengths, f"{limits[0]}, {limits[1]}", bar, *found)
    return "| " + " | ".join(str(cell) for cell in cells) + " |"


def grow() -> None:
    """Print how seconds grow with the pieces, their lengths the same."""
    print("| pieces | bars | bound | seconds |", "| --- " * 4 + "|", sep="\n")
    lengths = np.round(np.random.default_rng(1).uniform(600, 2400, 100), 1)
    stock = StockSettings(bars=(BarStock(section="P", length=6000),), bar_kerf=3)
    for pieces in GROWTH:
        members = [Member(k, "P", float(x), pieces // 100) for k, x in enumerate(lengths)]
        start = time.process_time()
        layout = nest_bars(members, stock)
        seconds = f"{time.process_time() - start:.1f}"
        print(f"| {pieces:,} | {len(layout.bars):,} | {layout.bound:,} | {seconds} |", flush=True)


def rack(sizes: np.ndarray, counts: np.ndarray, bar: int) -> tuple[BarRack, Need]:
    order = np.argsort(-sizes)
    micrometres = np.round((sizes[order] + 3) * 1000).astype(np.int64)
    room = np.array([(bar + 3) * 1000])
    return BarRack(micrometres, room, np.ones(1)), Need(counts[order], np.array([ENDLESS]))


if __name__ == "__main__":
    main()
