"""isomould: from two curves to everything a shop needs to build a free-form gridshell."""

from isomould.api import (
    Checked,
    NestFiles,
    build,
    check,
    compare,
    draw,
    explore,
    frames,
    inspect,
    nest,
    new,
    schedule,
    verify,
)
from isomould.documents.viewing import Seen
from isomould.errors import CertificateFailed, IsomouldError, Note, OutputFault, Refused
from isomould.progress import Step
from isomould.running import Built, Run
from isomould.showing import Progress

__all__ = [
    "Built",
    "CertificateFailed",
    "Checked",
    "IsomouldError",
    "NestFiles",
    "Note",
    "OutputFault",
    "Progress",
    "Refused",
    "Run",
    "Seen",
    "Step",
    "build",
    "check",
    "compare",
    "draw",
    "explore",
    "frames",
    "inspect",
    "nest",
    "new",
    "schedule",
    "verify",
]
