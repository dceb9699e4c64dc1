"""Prove a delivered folder from its files alone."""

from collections.abc import Iterable
from pathlib import Path
from types import ModuleType

from isomould.errors import OutputFault
from isomould.progress import Told, count_for_nobody, counted
from isomould.verify.certificate import Certificate
from isomould.verify.checks import (
    bars,
    bases,
    clash,
    classes,
    crossing,
    cutting_plan,
    details,
    drawings,
    fittings,
    forks,
    gaps,
    labels,
    machines,
    manifest,
    marks,
    nesting,
    nodes,
    packing,
    page,
    panels,
    parquet,
    plates,
    polygons,
    saw_list,
    scoring,
    setting_out,
    shapes,
    sheet_marks,
    sheet_numbers,
    sheets,
    solids,
    topology,
    totals,
    trimming,
    workbook,
)
from isomould.verify.delivery import Delivery
from isomould.verify.rules import Measured, NotApplicable, Rule, faults, judge, order
from isomould.workers import Spread, one_by_one

_GROUPS = (
    panels,
    nodes,
    polygons,
    topology,
    crossing,
    trimming,
    solids,
    clash,
    gaps,
    bases,
    marks,
    details,
    fittings,
    forks,
    nesting,
    sheet_marks,
    scoring,
    cutting_plan,
    bars,
    saw_list,
    classes,
    drawings,
    machines,
    plates,
    setting_out,
    packing,
    labels,
    workbook,
    parquet,
    totals,
    shapes,
    sheet_numbers,
    sheets,
    page,
    manifest,
)


_SCHEDULED = (panels, nodes, polygons, topology, workbook, parquet, totals, packing, manifest)
"""What can be proved of schedules alone."""


def _rules(groups: Iterable[ModuleType], *more: Rule) -> tuple[Rule, ...]:
    return tuple(sorted((*more, *(rule for group in groups for rule in group.RULES)), key=order))


def _each_shape(delivery: Delivery) -> Measured:
    """Prove the folders of the other shapes; those of a candidate were proved already, and are as they were."""
    if not delivery.shapes:
        raise NotApplicable("the project has one shape")
    rules = RULES if delivery.final else manifest.RULES
    checks = [(name, judge(rule, shape)) for name, shape in delivery.shapes.items() for rule in rules]
    failed = [f"{name}: {check.id} {check.what}: {check.reason}" for name, check in checks if check.status == "fail"]
    return faults(len(checks), failed)


RULES = _rules(_GROUPS, Rule("V60", "the other shapes pass their own checks", 0, "checks", _each_shape))
"""Every check there is, in the order of the certificate."""

WITHOUT_PAGE = tuple(rule for rule in RULES if rule not in page.RULES)
"""Those of a candidate: its page shows what they found."""

SCHEDULE_RULES = _rules(_SCHEDULED, *setting_out.TABLE_RULES)
"""The checks of a folder that holds schedules only."""


def verify_folder(
    folder: Path, *, final: bool = True, spread: Spread = one_by_one, told: Told = count_for_nobody
) -> Certificate:
    """Run every check on a folder (proof.md), or those of schedules on one that holds nothing else.

    Parameters
    ----------
    folder
        A delivered folder, or the candidate of one.
    final
        False for a candidate: its manifest is provisional, certificate.json and report.html are not there yet.
    spread
        Reads the drawings side by side.
    told
        Told of the checks that are done.

    Raises
    ------
    OutputFault
        If there is no such folder. Whatever is wrong inside it is a failed check.
    """
    if not folder.is_dir():
        message = f"{folder}: no such folder. Give the folder that a build delivered."
        raise OutputFault(message)
    delivery = Delivery(folder, final, spread)
    rules = SCHEDULE_RULES if delivery.scope == "schedules" else RULES if final else WITHOUT_PAGE
    return Certificate(tuple(judge(rule, delivery) for rule in counted(rules, told)))


def verify_page(folder: Path, certificate: Certificate) -> Certificate:
    """Prove the page of a candidate, which shows the certificate of all else, and add that to the certificate."""
    delivery = Delivery(folder, final=False)
    checks = (*certificate.checks, *(judge(rule, delivery) for rule in page.RULES))
    return Certificate(tuple(sorted(checks, key=order)))
