"""Small helpers for frozen values that hold numpy arrays."""

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

T = TypeVar("T", bound=np.generic)

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]


def read_only(array: NDArray[T]) -> NDArray[T]:
    """Return the array with its write flag cleared (the array itself, not a copy)."""
    array.setflags(write=False)
    return array


def round_um(values: Floats) -> Floats:
    """Round lengths to 0.001 mm, half to even, after snapping to 1e-6 mm.

    The snap makes two values that differ by rounding noise land on the same side of a tie, so that
    parallel sides stay parallel and classes do not flip between machines (failure mode E5).
    """
    return np.round(np.round(values, 6), 3)
