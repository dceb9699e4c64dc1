"""Work side by side: order, errors, and the death of a worker."""

import multiprocessing
import os
import signal
import sys
import time
from pathlib import Path

import pytest

from isomould.errors import IsomouldError, Refused
from isomould.workers import workers


def double(value):
    return 2 * value


def refuse(value):
    raise Refused("E-TEST", "field", str(value), "limit", "way out")


def die(value):
    os.kill(os.getpid(), signal.SIGKILL)


@pytest.mark.parametrize("jobs", [1, 2, 3])
def test_results_keep_their_order(jobs):
    with workers(jobs) as spread:
        assert spread(double, list(range(50))) == list(range(0, 100, 2))
        assert spread(double, []) == []


@pytest.mark.parametrize("jobs", [1, 2])
def test_refusals_arrive_whole(jobs):
    with pytest.raises(Refused) as refusal, workers(jobs) as spread:
        spread(refuse, [7])
    assert (refusal.value.code, refusal.value.found, refusal.value.way_out) == ("E-TEST", "7", "way out")


def test_a_dead_worker_is_told():
    with pytest.raises(IsomouldError, match="--jobs 1"), workers(2) as spread:
        spread(die, [1, 2])


def employ(pipe):
    with workers(2):
        pipe.send([child.pid for child in multiprocessing.active_children()])
        time.sleep(60)


@pytest.mark.skipif(sys.platform != "linux", reason="/proc tells who runs")
def test_workers_end_with_a_parent_that_is_killed():
    ours, theirs = multiprocessing.get_context("fork").Pipe()
    parent = multiprocessing.get_context("fork").Process(target=employ, args=(theirs,))
    parent.start()
    pids = ours.recv()
    assert len(pids) == 2
    parent.kill()
    parent.join()
    until = time.monotonic() + 20
    while any(map(runs, pids)) and time.monotonic() < until:
        time.sleep(0.02)
    assert not any(map(runs, pids))


def runs(pid):
    """Tell whether a process is there and more than an entry that nobody has read."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False
