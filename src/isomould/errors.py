"""The errors and notes that users see.

A refusal names the field (or file and entity), the value found with its unit, the limit and a way
out. The library raises these and never prints or exits; `isomould.cli` turns them into one message
and an exit code.
"""

from dataclasses import dataclass


class IsomouldError(Exception):
    """Base of every error that is meant for users; `exit_code` is what the command line returns."""

    exit_code = 2


class Refused(IsomouldError):
    """Input that would lead to a wrong or impossible part.

    >>> raise Refused("E-RAIL-01", "rail.divide.nodes", "1 node", "at least 3", "Give more nodes.")
    Traceback (most recent call last):
    isomould.errors.Refused: E-RAIL-01 rail.divide.nodes: 1 node. Limit: at least 3. Give more nodes.
    """

    def __init__(self, code: str, field: str, found: str, limit: str, way_out: str) -> None:
        super().__init__(f"{code} {field}: {found}. Limit: {limit}. {way_out}")
        self.code, self.field, self.found, self.limit, self.way_out = code, field, found, limit, way_out

    def __reduce__(self) -> tuple[type["Refused"], tuple[str, ...]]:
        """Travel between processes by the five texts, not by the message made of them."""
        return type(self), (self.code, self.field, self.found, self.limit, self.way_out)


class CertificateFailed(IsomouldError):
    """A delivered folder that does not prove what it claims."""

    exit_code = 1


class OutputFault(IsomouldError):
    """A file or folder that could not be read or written."""

    exit_code = 3


@dataclass(frozen=True)
class Note:
    """Something that the user should know and that does not stop the work.

    Printed by `check`, repeated on the Summary sheet.
    """

    code: str
    field: str
    text: str

    def __str__(self) -> str:
        return f"{self.code} {self.field}: {self.text}"
