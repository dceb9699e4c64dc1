"""What a check is: a rule with a limit, a function that measures, and the judge who compares the two."""

import math
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from isomould.errors import OutputFault
from isomould.verify.certificate import Check, Status

if TYPE_CHECKING:
    from isomould.verify.delivery import Delivery

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]
Texts = Sequence[str] | NDArray[np.str_]


class Unreadable(OutputFault):
    """A delivered file that is missing, broken or not what its format says."""


class NotApplicable(Exception):
    """The check has nothing to say about this design; the message says why."""


@dataclass(frozen=True)
class Measured:
    """What a check found: how many things, the worst value and where; a scale-aware check gives its limit."""

    count: int
    worst: float
    where: str = ""
    limit: float | None = None
    reason: str = ""


@dataclass(frozen=True)
class Rule:
    """A line of the registry. The check passes when the measured worst value is not above the limit."""

    id: str
    what: str
    limit: float
    unit: str
    measure: "Callable[[Delivery], Measured]"


def order(rule: Rule | Check) -> tuple[int, str]:
    """Sort by number, then by letter."""
    return int(re.sub(r"\D", "", rule.id)), rule.id


def worst_of(values: ArrayLike, names: Texts, *, limit: float | None = None, none: str = "") -> Measured:
    """Give the largest of the values (NaN counts as the largest) and its name.

    With no values at all the check is not applicable if `none` says why, and cannot run otherwise.
    """
    found = np.asarray(values, dtype=np.float64).ravel()
    if found.size == 0:
        raise NotApplicable(none) if none else Unreadable("nothing to test")
    at = int(np.argmax(np.where(np.isnan(found), np.inf, found)))
    return Measured(found.size, float(found[at]), str(names[at]), limit)


def faults(count: int, problems: Sequence[str]) -> Measured:
    """Judge an exact check by its number of problems; the reason quotes the first three."""
    where = problems[0] if problems else ""
    return Measured(count, float(len(problems)), where, reason="; ".join(problems[:3]))


def worse(*found: Measured) -> Measured:
    """Join measurements of one limit: all counts, the worst value and where it is."""
    worst = max(found, key=lambda m: math.inf if math.isnan(m.worst) else m.worst)
    return Measured(sum(m.count for m in found), worst.worst, worst.where, worst.limit, worst.reason)


def judge(rule: Rule, delivery: "Delivery") -> Check:
    """Run one rule. Whatever keeps it from running is a failure with a reason, never a check left out."""
    try:
        with np.errstate(all="ignore"):  # NaN is looked for in the result
            return _compare(rule, rule.measure(delivery))
    except NotApplicable as answer:
        return _without_value(rule, "not_applicable", str(answer))
    except Exception as fault:  # whatever it is, the check did not prove anything
        return _without_value(rule, "fail", f"could not run: {_name(fault)}{fault}")


def _compare(rule: Rule, found: Measured) -> Check:
    limit = rule.limit if found.limit is None else found.limit
    status: Status = "pass" if found.count > 0 and found.worst <= limit else "fail"
    reason = found.reason or ("" if status == "pass" else _complaint(rule, found, limit))
    worst, bound = _finite(found.worst), _finite(limit)
    return Check(rule.id, rule.what, found.count, worst, found.where, bound, rule.unit, status, reason)


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _complaint(rule: Rule, found: Measured, limit: float) -> str:
    if not found.count:
        return "nothing tested"
    return f"{found.worst:.6g} {rule.unit} at {found.where or '?'}, limit {limit:g}"


def _without_value(rule: Rule, status: Status, reason: str) -> Check:
    return Check(rule.id, rule.what, 0, None, "", rule.limit, rule.unit, status, reason)


def _name(fault: Exception) -> str:
    return "" if isinstance(fault, Unreadable) else f"{type(fault).__name__}: "
