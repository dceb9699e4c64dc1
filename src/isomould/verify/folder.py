"""Prove a delivered folder from its files alone."""

import re
from pathlib import Path

from isomould.errors import OutputFault
from isomould.verify.certificate import Certificate
from isomould.verify.checks import (
    bars,
    classes,
    drawings,
    manifest,
    nesting,
    nodes,
    panels,
    polygons,
    solids,
    topology,
    totals,
    trimming,
    workbook,
)
from isomould.verify.delivery import Delivery
from isomould.verify.rules import Rule, judge
from isomould.workers import Spread, one_by_one

_GROUPS = (
    panels,
    nodes,
    polygons,
    topology,
    trimming,
    solids,
    nesting,
    bars,
    classes,
    drawings,
    workbook,
    totals,
    manifest,
)


def _order(rule: Rule) -> tuple[int, str]:
    return int(re.sub(r"\D", "", rule.id)), rule.id


RULES: tuple[Rule, ...] = tuple(sorted((rule for group in _GROUPS for rule in group.RULES), key=_order))
"""Every check there is, in the order of the certificate."""


def verify_folder(folder: Path, *, final: bool = True, spread: Spread = one_by_one) -> Certificate:
    """Run every check on a folder (proof.md).

    Parameters
    ----------
    folder
        A delivered folder, or the candidate of one.
    final
        False for a candidate: its manifest is provisional and certificate.json is not there yet.
    spread
        Reads the drawings side by side.

    Raises
    ------
    OutputFault
        If there is no such folder. Whatever is wrong inside it is a failed check.
    """
    if not folder.is_dir():
        message = f"{folder}: no such folder. Give the folder that a build delivered."
        raise OutputFault(message)
    delivery = Delivery(folder, final, spread)
    return Certificate(tuple(judge(rule, delivery) for rule in RULES))
