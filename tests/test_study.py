"""Form finding: a study says what `check` says, leaves itself as it is, and refuses what cannot be made."""

import numpy as np
import pytest

import isomould
from isomould.errors import Refused
from museum import FAMILY, SMALL


@pytest.fixture
def study(project_file):
    return isomould.explore(project_file(SMALL))


def test_a_study_says_what_check_says(study, project_file):
    changed = study.with_changes({"rail.curve.rise": "2 m", "generatrix.divide.per_arc": 4})
    checked = isomould.check(project_file(SMALL), ["rail.curve.rise=2000", "generatrix.divide.per_arc=4"])
    assert changed.facts == {item: value for item, value, _ in checked.facts}
    assert changed.nodes.tolist() == checked.design.form.surface.V.tolist()
    assert changed.nodes.shape == (10, 6, 3)


def test_changes_add_up_and_leave_the_first_study_alone(study):
    before = study.nodes.copy()
    once = study.with_changes({"rail.curve.rise": 2000})
    twice = once.with_changes({"generatrix.origin": [200, 0]})
    assert np.ptp(twice.nodes[..., 2]) != np.ptp(once.nodes[..., 2]) != np.ptp(study.nodes[..., 2])
    assert study.nodes.tolist() == before.tolist()
    assert study.with_changes({}).facts == study.facts


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [("rail.curve.ris", 3, "rail.curve.ris"), ("rail.divide.nodes", 0, "at least 1"), ("schema.x", 1, "is a value")],
)
def test_what_cannot_be_is_refused(study, key, value, words):
    with pytest.raises(Refused, match=words):
        study.with_changes({key: value})


def test_of_several_shapes_the_first_is_studied(project_file):
    path = project_file(FAMILY)
    assert isomould.explore(path).facts["Nodes"] == len(isomould.check(path).design.kit.mesh.nodes)
