"""How a build is run, and what comes of it: what callers know before any stage is loaded."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

    from isomould.design import Design
    from isomould.documents.table import Table
    from isomould.nesting.search import Effort
    from isomould.verify import Certificate

Report = Callable[[str], None]
"""Told the name of every stage as it begins."""


@dataclass(frozen=True, eq=False)
class Built:
    """A delivery that was written, proved and published."""

    folder: Path
    design: Design
    tables: tuple[Table, ...]
    certificate: Certificate


@dataclass(frozen=True)
class Run:
    """How a build is run: `jobs` processes (None: one per core) change the time, never the result.

    `previous` is a former delivery of the project: unchanged classes keep its marks.
    """

    overwrite: bool = False
    effort: Effort = "normal"
    jobs: int | None = None
    report: Report = lambda stage: None
    previous: Path | None = None
