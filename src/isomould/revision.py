"""A former delivery: read, trusted only if untouched, and its marks kept."""

from dataclasses import replace
from pathlib import Path

from isomould.design import Design, kit_settings
from isomould.documents.revision import PARTS, Former, Row, keep_marks
from isomould.documents.schedules import part_tables
from isomould.errors import Refused
from isomould.parts.solid import Solid
from isomould.verify.read.tables import Table, pairs, read_table
from isomould.verify.rules import Unreadable
from isomould.writers.manifest import folder_faults

_GONE = ("dropped", "retired")


def read_former(folder: Path) -> Former:
    """Read classes, places and retired marks of a delivered folder.

    Raises
    ------
    Refused
        If the folder is no delivery, or was changed since.
    """
    faults = folder_faults(folder)
    if faults:
        raise _no_delivery(folder, faults[0])
    try:
        return _read(folder / "tables")
    except (Unreadable, OSError, KeyError) as error:
        raise _no_delivery(folder, str(error)) from error


def _no_delivery(folder: Path, found: str) -> Refused:
    limit = "a folder that isomould delivered, as it was delivered"
    return Refused("E-PREVIOUS", f"--previous {folder}", found, limit, "Name the folder of the former revision.")


def _read(folder: Path) -> Former:
    classes = {name: _rows(read_table(folder / f"{name}.csv")) for name in PARTS}
    places = {
        name: pairs(read_table(folder / f"{name.removesuffix('s')}_instances.csv"), "location", "mark")
        for name in PARTS
    }
    history = folder / "revision.csv"
    status = pairs(read_table(history), "mark", "status") if history.exists() else {}
    return Former(classes, places, frozenset(mark for mark, word in status.items() if word in _GONE))


def _rows(table: Table) -> list[Row]:
    return [dict(zip(table.columns, row, strict=True)) for row in zip(*table.columns.values(), strict=True)]


def keep_design_marks(design: Design, solids: tuple[Solid, ...], former: Former) -> Design:
    """Name the classes of a design as the former delivery did, where they are the same parts."""
    tables = {t.name: t for t in part_tables(design.kit, kit_settings(design.project), solids, {}, {})}
    parts = {name: replace(getattr(design.kit, name), marks=keep_marks(tables[name], former)) for name in PARTS}
    return replace(design, kit=replace(design.kit, **parts))
