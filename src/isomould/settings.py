"""The base of every settings type: frozen, closed to unknown keys, finite numbers only; user text of one line."""

import unicodedata
from collections.abc import Iterator
from typing import Annotated, Self

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, model_validator

_LONGEST = 120


class Settings(BaseModel):
    """A table of the project file. Defined beside the stage that reads it; composed by `isomould.project`."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False, defer_build=True)

    def conflicts(self) -> Iterator[str]:
        """Say which values of the table do not go together, each as "found; limit" in a line of its own."""
        yield from ()

    @model_validator(mode="after")
    def _without_conflicts(self) -> Self:
        """Refuse all conflicts together: the reader of project files tells the lines apart."""
        said = list(self.conflicts())
        if said:
            raise ValueError("\n".join(said))
        return self


def _one_line(text: str) -> str:
    """Hold user text to one printable line in Unicode's composed form (failure mode A9)."""
    if not text.isprintable():
        message = "must be text without control characters, line breaks and direction marks"
        raise ValueError(message)
    return unicodedata.normalize("NFC", text)


ONE_LINE = AfterValidator(_one_line)
"""Stands behind the limits of a text's length, which would not know it as a text after it."""

Text = Annotated[str, Field(max_length=_LONGEST), ONE_LINE]
"""One line of printable text."""

Name = Annotated[str, Field(min_length=1, max_length=_LONGEST), ONE_LINE]
"""One line of printable text, not empty."""
