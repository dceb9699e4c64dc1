"""File names that are safe on every system, wherever the program runs (failure modes H2, H3)."""

import re
import unicodedata
from collections import Counter
from collections.abc import Iterable, Sequence

from isomould.errors import Refused

_PORTS = (f"{port}{digit}" for port in ("com", "lpt") for digit in "123456789¹²³")
_RESERVED = frozenset(("con", "prn", "aux", "nul", "conin$", "conout$", *_PORTS))
_FORBIDDEN = re.compile(r'[\x00-\x1f<>:"\\|?*]|[ .]$')
_LONGEST_NAME = 80
_LONGEST_PATH = 160


def safe_name(text: str, field: str = "project.name") -> str:
    """Make a folder name of a project's name: small ASCII letters, digits and single hyphens.

    Letters of other scripts have no ASCII letter to stand for them; a name of nothing else is written by the numbers
    of its characters (Unicode), so that different names stay different folders.

    Raises
    ------
    Refused
        If nothing is left, the name is reserved on Windows, too long, or holds control characters.

    Examples
    --------
    >>> safe_name("Barrel vault, Fig. 6"), safe_name("Südkuppel ../2"), safe_name("日本")
    ('barrel-vault-fig-6', 'sudkuppel-2', 'u65e5-u672c')
    """
    if any(unicodedata.category(character) in {"Cc", "Cs"} for character in text):
        raise _refused(field, repr(text), "printable text")
    plain = unicodedata.normalize("NFKD", text.casefold()).encode("ascii", "ignore").decode()
    slug = re.sub(r"[^a-z0-9]+", "-", re.sub(r"['’]", "", plain)).strip("-") or _by_numbers(text)
    if not slug or len(slug) > _LONGEST_NAME or slug in _RESERVED:
        limit = f"1 to {_LONGEST_NAME} letters and digits, and no device name of Windows"
        raise _refused(field, repr(slug or text), limit)
    return slug


def _by_numbers(text: str) -> str:
    return "-".join(f"u{ord(character):04x}" for character in unicodedata.normalize("NFC", text) if character.isalnum())


def check_file_name(name: str) -> None:
    """Refuse the name of one file or folder that some system cannot hold.

    >>> check_file_name("CON.toml")
    Traceback (most recent call last):
    isomould.errors.Refused: E-NAME-01 NAME: 'CON.toml'. Limit: a name that Windows allows, at most 80 characters: no
    device such as CON, none of <>:"|?*, no blank or dot at the end. Choose another name.
    """
    if len(name) > _LONGEST_NAME or not _is_portable(name):
        limit = (
            f"a name that Windows allows, at most {_LONGEST_NAME} characters: no device such as CON, none of "
            '<>:"|?*, no blank or dot at the end'
        )
        raise Refused("E-NAME-01", "NAME", repr(name), limit, "Choose another name.")


def check_names(paths: Iterable[str]) -> None:
    """Refuse relative paths (with /) that some system cannot hold, or that differ only in case.

    >>> check_names(["panels/P01.dxf", "tables/panels.csv"])
    """
    listed = list(paths)
    _check_case(listed)
    for path in listed:
        if len(path) > _LONGEST_PATH or any(not _is_portable(part) for part in path.split("/")):
            raise _refused("file name", repr(path), f"names that Windows allows, {_LONGEST_PATH} characters")


def _is_portable(part: str) -> bool:
    stem = part.partition(".")[0].rstrip().casefold()
    return part not in {"", ".", ".."} and not _FORBIDDEN.search(part) and stem not in _RESERVED


def _check_case(paths: Sequence[str]) -> None:
    counts = Counter(unicodedata.normalize("NFC", path).casefold() for path in paths)
    twins = [path for path in paths if counts[unicodedata.normalize("NFC", path).casefold()] > 1]
    if twins:
        raise _refused("file name", repr(max(twins)), "names that differ in more than case")


def _refused(field: str, found: str, limit: str) -> Refused:
    return Refused("E-NAME-01", field, found, limit, "Choose another name, or another folder with --out.")
