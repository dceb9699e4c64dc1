"""A process of its own that asks spyrrow for parts in a strip, as this file run by itself.

    python -P strip_engine.py < asked.json > found.json

It reads {"items": [{"shape", "demand", "turns"}], "height", "width", "attempts", "seconds", "workers", "seed"} and
writes {"ended": "fits" | "gives up" | "time", "placed": [[item, rotation_deg, x, y], ...]}. The first layout that is
not wider than `width` counts, and the search gives up after so many failed attempts: both come of the seed and the
number of workers alone, not of the clock. A process, because spyrrow cannot be told to stop, and ends its process where
it meets what it cannot work with.
"""

import json
import os
import sys
import threading
import time
from typing import Any

import spyrrow

_PAUSE = 0.01
"""Seconds between two looks at what was found."""

_FITTING = (spyrrow.ReportType.ExplFeas, spyrrow.ReportType.CmprFeas, spyrrow.ReportType.Final)


def main() -> None:
    """Solve one task."""
    asked = json.load(sys.stdin)
    json.dump(_solve(asked), sys.stdout)
    sys.stdout.flush()
    # The search goes on in its thread: nothing but the end of the process ends it.
    os._exit(0)


def _solve(asked: dict[str, Any]) -> dict[str, Any]:
    queue, ended = spyrrow.ProgressQueue(), threading.Event()
    threading.Thread(target=_search, args=(asked, queue, ended), daemon=True).start()
    failed, latest = 0, time.monotonic() + asked["seconds"]
    while time.monotonic() < latest:
        over = ended.wait(_PAUSE)
        for kind, solution in queue.drain():
            if kind in _FITTING and solution.width <= asked["width"]:
                return {
                    "ended": "fits",
                    "placed": [[int(p.id), p.rotation, *p.translation] for p in solution.placed_items],
                }
            failed += kind == spyrrow.ReportType.ExplInfeas
            if failed >= asked["attempts"]:
                return {"ended": "gives up", "placed": []}
        if over:
            return {"ended": "gives up", "placed": []}
    return {"ended": "time", "placed": []}


def _search(asked: dict[str, Any], queue: spyrrow.ProgressQueue, ended: threading.Event) -> None:
    items = [
        spyrrow.Item(str(k), [(x, y) for x, y in item["shape"]], item["demand"], item["turns"])
        for k, item in enumerate(asked["items"])
    ]
    config = spyrrow.StripPackingConfig(
        early_termination=True,
        total_computation_time=None,
        exploration_time=int(asked["seconds"]) + 1,
        compression_time=1,
        num_workers=asked["workers"],
        seed=asked["seed"],
    )
    try:
        spyrrow.StripPackingInstance("", asked["height"], items).solve(config, queue)
    finally:
        ended.set()


if __name__ == "__main__":
    main()
