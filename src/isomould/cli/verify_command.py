"""The command `verify`: a delivery, or the layout of a nest, proved again."""

from pathlib import Path
from typing import Any

import click

import isomould
from isomould.cli.console import say
from isomould.verify import Check

_STATUS = {"pass": "pass", "fail": "FAIL", "not_applicable": "none"}


@click.command()
@click.argument("folder", type=click.Path(path_type=Path))
@click.option("--sheets", type=click.Path(path_type=Path), help="Of a layout file: the folder of its sheets.")
@click.option("--plan", type=click.Path(path_type=Path), help="Of a layout file: its cutting plan (PDF).")
@click.option("--saw-list", type=click.Path(path_type=Path), help="Of a layout file of bars: its saw list.")
def verify(folder: Path, **nested: Any) -> None:
    """Prove a delivered folder, or the layout file of a nest, again from its files alone."""
    certificate = isomould.verify(folder, **nested)
    passed = sum(check.status == "pass" for check in certificate.checks)
    click.echo(f"{folder}: {passed} checks passed, {len(certificate.failures)} failed")
    for check in certificate.failures:
        click.echo(f"failed: {check.id} {check.what}: {check.reason or check.where}")
    for one in certificate.checks:
        say(f"{_STATUS[one.status]}  {one.id:<5} {one.what}\n{_measured(one)}")
    if not certificate.passed:
        raise isomould.CertificateFailed(f"E-CERTIFICATE {folder}: {len(certificate.failures)} checks failed")


def _measured(check: Check) -> str:
    """Say below a check what it found, or why it could not; two short lines fit every terminal."""
    worst = "" if check.worst is None else f"worst {f'{check.worst:.3g} {check.unit}'.strip()}"
    limit = "" if check.limit is None or check.worst is None else f"limit {check.limit:.3g}"
    counted = f"{check.count} tested" if check.count else ""
    where = f"at {check.where}" if check.where and check.worst else ""
    said = ", ".join(part for part in (f"{worst} {where}".strip(), limit, counted, check.reason) if part)
    return f"{'':<12}{said}"
