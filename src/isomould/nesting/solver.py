"""HiGHS without a word: its newer versions greet on stdout before they can be told to be quiet."""

import os
import sys
import threading
from collections.abc import Generator
from contextlib import contextmanager
from typing import Any

import highspy

_STDOUT = 1
_LOCK = threading.Lock()
"""A descriptor belongs to the whole process: two threads must not put it aside at once."""


def quiet_solver() -> Any:
    """Make a solver that prints nothing, neither now nor later."""
    with _nothing_printed():
        solver = highspy.Highs()
    solver.setOptionValue("output_flag", False)
    return solver


@contextmanager
def _nothing_printed() -> Generator[None]:
    """Send what native code prints nowhere; a process without stdout has nothing to put aside."""
    with _LOCK:
        if sys.stdout is not None:  # pyright: ignore[reportUnnecessaryComparison] - None under pythonw
            sys.stdout.flush()
        try:
            kept = os.dup(_STDOUT)
        except OSError:
            yield
            return
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, _STDOUT)
        try:
            yield
        finally:
            os.dup2(kept, _STDOUT)
            os.close(kept)
            os.close(nowhere)
