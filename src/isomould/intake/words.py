"""Lists of names in messages."""

from collections.abc import Sequence


def listed(names: Sequence[str], most: int = 8) -> str:
    """Give the first names, and how many more there are.

    Examples
    --------
    >>> listed(["A", "B", "C"], 2)
    'A, B and 1 more'
    """
    more = len(names) - most
    return ", ".join(names[:most]) + (f" and {more} more" if more > 0 else "")
