"""The judge: nothing passes that did not run."""

import json

import numpy as np
import pytest
from verify_museum import holding

from isomould.errors import OutputFault
from isomould.verify import Certificate, verify_folder
from isomould.verify.folder import RULES
from isomould.verify.rules import Measured, NotApplicable, Rule, Unreadable, faults, judge, worse, worst_of


def judged(measure, limit=1.0):
    return judge(Rule("V0", "a test", limit, "mm", measure), holding())


def answer(error):
    def measure(_):
        raise error

    return measure


@pytest.mark.parametrize(
    ("values", "status"), [([0.5, 1.0], "pass"), ([0.5, 1.1], "fail"), ([0.5, np.nan], "fail"), ([], "fail")]
)
def test_worst_value_decides(values, status):
    assert judged(lambda _: worst_of(values, "ab")).status == status


def test_the_worst_is_named_and_nan_is_the_worst():
    assert worst_of([1, 3, 2], ["a", "b", "c"]).where == "b"
    assert worst_of([1, np.inf, np.nan, 2], "abcd").where == "b"
    assert judged(lambda _: worst_of([1, np.nan], "ab")).worst is None
    assert worse(worst_of([1], "a"), worst_of([np.nan], "n"), worst_of([2], "b")).where == "n"


@pytest.mark.parametrize("error", [Unreadable("gone"), KeyError("x"), ZeroDivisionError(), StopIteration()])
def test_a_check_that_cannot_run_fails_with_a_reason(error):
    check = judged(answer(error))
    assert check.status == "fail"
    assert "could not run" in check.reason


def test_not_applicable_says_why():
    check = judged(answer(NotApplicable("no bars")))
    assert (check.status, check.reason) == ("not_applicable", "no bars")


def test_nothing_tested_is_no_pass():
    assert judged(lambda _: Measured(0, 0.0)).status == "fail"
    assert judged(lambda _: faults(0, [])).status == "fail"
    assert judged(lambda _: faults(3, ["x", "y"]), 0).reason == "x; y"
    assert not Certificate(()).passed


def test_certificate_is_json_without_nan():
    certificate = Certificate((judged(lambda _: worst_of([np.nan], "a")), judged(lambda _: worst_of([0.1], "a"))))
    content = json.loads(certificate.to_json(), parse_constant=pytest.fail)
    assert [check["status"] for check in content["checks"]] == ["fail", "pass"]
    assert not certificate.passed


def test_an_empty_folder_fails_every_check(tmp_path):
    certificate = verify_folder(tmp_path)
    assert {check.status for check in certificate.checks} == {"fail"}
    assert all(check.reason for check in certificate.checks)


def test_a_missing_folder_is_refused(tmp_path):
    with pytest.raises(OutputFault, match="no such folder"):
        verify_folder(tmp_path / "none")


def test_ids_are_unique_and_complete():
    ids = [rule.id for rule in RULES]
    assert len(set(ids)) == len(ids)
    asked = [*range(1, 13), *range(20, 24), 25, *range(31, 37), 40, 41, 43, 44, 50]
    assert {f"V{number}" for number in asked} <= set(ids)
