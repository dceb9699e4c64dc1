"""Who and what a delivery is for: the `[project]` table."""

import datetime
import unicodedata
from typing import Annotated

from pydantic import AfterValidator, Field

from isomould.settings import Settings

_LONGEST = 120


def _one_line(text: str) -> str:
    """Hold user text to one printable line in Unicode's composed form (failure mode A9)."""
    if not text.isprintable():
        message = "control characters, line breaks and direction marks are not allowed here"
        raise ValueError(message)
    return unicodedata.normalize("NFC", text)


Text = Annotated[str, Field(max_length=_LONGEST), AfterValidator(_one_line)]
"""One line of printable text."""


class ProjectInfo(Settings):
    """The `[project]` table."""

    name: Annotated[Text, Field(min_length=1)]
    number: Text = ""
    client: Text = ""
    revision: Text = ""
    author: Text = ""
    date: datetime.date | None = None
