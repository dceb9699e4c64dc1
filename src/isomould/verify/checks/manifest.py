"""V50: the manifest lists exactly the files that are there, with their hashes."""

import re

from isomould.verify.delivery import Delivery
from isomould.verify.rules import Measured, Rule, faults

OWN = "manifest.json"
CERTIFICATE = "certificate.json"
LATER = frozenset((CERTIFICATE, "report.html"))
"""What a candidate folder does not hold yet."""

SCHEDULES = {CERTIFICATE, "schedules.xlsx", "model/geometry.npz", "model/design.json"}
"""What a folder of schedules holds beside its tables."""


def manifest(delivery: Delivery) -> Measured:
    """Compare names, sizes and hashes; a candidate's certificate and page may still be missing."""
    rows = delivery.manifest["files"]
    listed = {row["path"]: (row["sha256"], row["size"]) for row in rows}
    found = {path: value for path, value in delivery.hashes.items() if path != OWN}
    if not delivery.final:
        listed, found = ({path: row for path, row in rows.items() if path not in LATER} for rows in (listed, found))
    problems = [f"{path} is not listed" for path in sorted(found.keys() - listed.keys())]
    problems += [f"{path} is missing" for path in sorted(listed.keys() - found.keys())]
    problems += [f"{path} is changed" for path in sorted(found.keys() & listed.keys()) if found[path] != listed[path]]
    problems += [f"{path} is no schedule" for path in sorted(found) if _beyond(delivery, path)]
    problems += ["a file is listed twice"] * (len(rows) > len({row["path"] for row in rows}))
    if delivery.final and CERTIFICATE not in found:
        problems.append(f"{CERTIFICATE} is missing")
    return faults(len(rows), problems)


def _beyond(delivery: Delivery, path: str) -> bool:
    """Tell whether a file needs more proof than a folder of schedules gets."""
    return (
        delivery.scope == "schedules" and path not in SCHEDULES and not re.fullmatch(r"tables/\w+\.(csv|parquet)", path)
    )


RULES = (Rule("V50", "the manifest lists exactly the files that are there", 0, "files", manifest),)
