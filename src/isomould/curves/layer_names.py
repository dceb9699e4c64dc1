"""Names of layers, blocks and objects: how they are compared, and how messages print them."""

import unicodedata
from collections.abc import Iterable

_NAMED = 12
"""Names that a message lists."""


def layer_key(name: str) -> str:
    """Give what two spellings of one name share: neither case, outer blanks nor composition of letters count.

    >>> layer_key(" Rail ") == layer_key("RAIL")
    True
    """
    return unicodedata.normalize("NFC", name.strip()).casefold()


def quoted(name: str) -> str:
    r"""Give a name in quotes, with letters that cannot be printed or decoded as escapes.

    >>> quoted("RA\udc84IL\t")
    "'RA\\x84IL\\t'"
    """
    readable = [_readable(letter) for letter in name]
    return "'" + "".join(readable) + "'"


def _readable(letter: str) -> str:
    if "\udc80" <= letter <= "\udcff":
        # a byte that the file's encoding does not know
        return f"\\x{ord(letter) - 0xDC00:02x}"
    return letter if letter.isprintable() else letter.encode("unicode_escape").decode("ascii")


def listed(names: Iterable[str]) -> str:
    """Give names in quotes, the first dozen by name."""
    every = sorted(set(names))
    more = f" and {len(every) - _NAMED} more" if len(every) > _NAMED else ""
    return ", ".join(quoted(name) for name in every[:_NAMED]) + more
