"""Independent work side by side on several processes; the results and their order do not depend on how many."""

import multiprocessing
import os
import signal
import sys
import threading
from collections.abc import Callable, Generator, Sequence
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from functools import partial
from typing import Protocol, TypeVar

from isomould.errors import IsomouldError
from isomould.progress import Told, count_for_nobody, counted, counted_to

Item = TypeVar("Item")
Result = TypeVar("Result")

_CHUNKS_PER_WORKER = 4


class Spread(Protocol):
    """Applies a function of a module to many items and gives the results in their order."""

    def __call__(
        self, function: Callable[[Item], Result], items: Sequence[Item], told: Told = count_for_nobody
    ) -> list[Result]:
        """Apply `function` to every item and count those that are done; the first exception is raised."""
        ...


def one_by_one(
    function: Callable[[Item], Result], items: Sequence[Item], told: Told = count_for_nobody
) -> list[Result]:
    """Apply a function to every item in this process.

    >>> one_by_one(abs, [-1, 2])
    [1, 2]
    """
    return [function(item) for item in counted(items, told)]


@contextmanager
def workers(jobs: int | None = None, prepare: Callable[[], None] | None = None) -> Generator[Spread]:
    """Give a `Spread` over `jobs` processes; None takes one per core, 1 stays in this process.

    `prepare` runs once in every process before its work begins; not in this one.
    """
    count = jobs or os.cpu_count() or 1
    if count == 1:
        yield one_by_one
        return
    # Forked workers start at once; other systems have no safe fork.
    context = multiprocessing.get_context("fork" if sys.platform == "linux" else "spawn")
    pool = ProcessPoolExecutor(count, context, initializer=_begin, initargs=(prepare,))
    try:
        list(pool.map(abs, range(count)))
        yield partial(_spread, pool, count)
        pool.shutdown()
    except BrokenProcessPool as error:
        message = "E-WORKERS: a worker process was ended from outside, perhaps for want of memory. Try --jobs 1."
        raise IsomouldError(message) from error
    except KeyboardInterrupt:
        # The interrupt may have struck inside the pool's own locks: waiting for it could last for ever.
        for worker in multiprocessing.active_children():
            worker.terminate()
        raise
    finally:
        pool.shutdown(wait=False, cancel_futures=True)


def _spread(
    pool: ProcessPoolExecutor,
    count: int,
    function: Callable[[Item], Result],
    items: Sequence[Item],
    told: Told = count_for_nobody,
) -> list[Result]:
    size = max(1, len(items) // (_CHUNKS_PER_WORKER * count))
    return list(counted_to(len(items), pool.map(function, items, chunksize=size), told))


def _begin(prepare: Callable[[], None] | None) -> None:
    """Leave signals to the parent, end with it, and prepare."""
    for name in ("SIGINT", "SIGBREAK"):
        if hasattr(signal, name):
            signal.signal(getattr(signal, name), signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    if hasattr(os, "setpgid"):
        os.setpgid(0, 0)  # what is sent to the parent's group is for the parent
    threading.Thread(target=_end_with_parent, daemon=True).start()
    if prepare is not None:
        prepare()


def _end_with_parent() -> None:
    """Wait for the end of the parent: however it comes, nobody is left behind."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)
