"""Bars of the Bin Packing Problem Library, beside their bound: the table in docs/nesting.md.

    python benchmarks/bpplib.py FOLDER [COUNT]

The library (Delorme, Iori and Martello 2018, Optimization Letters 12, 235-250) may be used but not passed on in
parts: fetch it from its authors and unpack the files "…_CSP" of its benchmarks into FOLDER. A file holds the number of
lengths, the length of a bar, and a line per length with its pieces. COUNT files of every folder are drawn by lot, seed
35 (default 5).
"""

import random
import sys
import time
from collections.abc import Iterator
from pathlib import Path

from isomould.nesting.bars import nest_bars
from isomould.nesting.layout import Member
from isomould.nesting.settings import BarStock, StockSettings


def main() -> None:
    folder, count = Path(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 5
    print("| folder | file | lengths | pieces | bars | bound | seconds |", "| --- " * 7 + "|", sep="\n")
    for path in drawn(folder, count):
        print(line(path), flush=True)


def drawn(folder: Path, count: int) -> Iterator[Path]:
    chance = random.Random(35)
    folders = sorted({path.parent for path in folder.rglob("*.txt")})
    for one in folders:
        files = sorted(one.glob("*.txt"))
        yield from sorted(chance.sample(files, min(count, len(files))))


def read(path: Path) -> tuple[list[Member], StockSettings]:
    """Read a file of the library as members, one length each, and bars without kerf."""
    _, (capacity, *_), *rows = [line.split() for line in path.read_text().splitlines() if line.strip()]
    members = [Member(k, "P", float(size), int(many)) for k, (size, many, *_) in enumerate(rows)]
    return members, StockSettings(bars=(BarStock(section="P", length=float(capacity)),), bar_kerf=0)


def line(path: Path) -> str:
    members, stock = read(path)
    start = time.process_time()
    layout = nest_bars(members, stock)
    seconds = f"{time.process_time() - start:.1f}"
    pieces = sum(member.quantity for member in members)
    cells = (path.parent.name, path.stem, len(members), pieces, len(layout.bars), layout.bound, seconds)
    return "| " + " | ".join(map(str, cells)) + " |"


if __name__ == "__main__":
    main()
