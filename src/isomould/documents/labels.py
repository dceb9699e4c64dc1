"""Labels: one for every piece, with mark, location and crate, in the order of packing."""

from dataclasses import dataclass

from isomould.documents.info import ProjectInfo
from isomould.documents.table import Table


@dataclass(frozen=True)
class PieceLabel:
    """What stands on a label; `code` is what its QR code says: mark and location."""

    mark: str
    location: str
    crate: str
    project: str

    @property
    def code(self) -> str:
        """Letters, digits, blank and minus only, so that small codes hold it.

        >>> PieceLabel("N01", "N-00-00", "R-00", "").code
        'N01 N-00-00'
        """
        return f"{self.mark} {self.location}"


def piece_labels(crates: Table, info: ProjectInfo) -> tuple[PieceLabel, ...]:
    """Give the labels of all pieces from the table "crates"."""
    project = " ".join(filter(None, (info.number, info.name)))
    rows = zip(*(crates.frame[name].tolist() for name in ("crate", "mark", "locations")), strict=True)
    return tuple(PieceLabel(mark, where, crate, project) for crate, mark, places in rows for where in places.split(";"))
