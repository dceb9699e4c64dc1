"""The certificate: what was checked on a delivered folder, the worst value found, and whether it holds."""

import json
from dataclasses import asdict, dataclass
from typing import Literal

Status = Literal["pass", "fail", "not_applicable"]


@dataclass(frozen=True)
class Check:
    """One line of the certificate: `worst` is the worst value found, `where` its mark or location.

    `worst` is None when nothing finite was measured: the check could not run, or does not apply.
    `limit` is None when the value is only reported.
    """

    id: str
    what: str
    count: int
    worst: float | None
    where: str
    limit: float | None
    unit: str
    status: Status
    reason: str = ""


@dataclass(frozen=True)
class Certificate:
    """All checks of one folder, in the order of their ids."""

    checks: tuple[Check, ...]

    @property
    def failures(self) -> tuple[Check, ...]:
        """The checks that failed."""
        return tuple(check for check in self.checks if check.status == "fail")

    @property
    def passed(self) -> bool:
        """Whether something was checked and nothing failed."""
        return bool(self.checks) and not self.failures

    def to_json(self) -> str:
        """Give the text of `certificate.json`."""
        content = {"schema": 1, "passed": self.passed, "checks": [asdict(check) for check in self.checks]}
        return json.dumps(content, indent=1, allow_nan=False, ensure_ascii=False) + "\n"
