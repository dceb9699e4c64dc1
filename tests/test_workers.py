"""Work side by side: order, errors, and the death of a worker."""

import os
import signal

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
