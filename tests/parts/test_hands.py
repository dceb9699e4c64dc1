"""Letters of chiral nodes: the same however a design lies in space (geometry §7, oracle H)."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from isomould.form.mesh import make_mesh
from isomould.parts.arms import find_arms
from isomould.parts.nodes import classify_nodes
from isomould.parts.settings import CongruenceSettings
from museum import MONGE, VAULT, design, dome, trimmed

CASES = {"vault": VAULT, "monge": MONGE, "dome": trimmed(dome(5.2, nodes=5))}


def letters(mesh):
    """Letter of every node, by that of its class."""
    nodes = classify_nodes(mesh, find_arms(mesh), CongruenceSettings())
    return [nodes.handed[kind] for kind in nodes.classes.of]


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("seed", range(4))
def test_a_rigid_motion_changes_no_letter(name, seed):
    mesh = design(CASES[name]).kit.mesh
    turn = Rotation.random(random_state=seed).as_matrix()
    moved = replace(mesh, nodes=mesh.nodes @ turn.T + 1e5, axes=mesh.axes @ turn.T)
    assert letters(moved) == letters(mesh)


@pytest.mark.parametrize("noise", [1e-3, 1e-2])
def test_nodes_that_are_a_little_off_keep_their_letters(noise):
    """Nodes moved by far less than the tolerance of classes, at the same lengths: noise, and no more, is added."""
    mesh = make_mesh(design(MONGE).form.surface)
    random = np.random.default_rng(5)
    shaken = replace(mesh, nodes=mesh.nodes + noise * random.uniform(-1, 1, mesh.nodes.shape))
    assert letters(shaken) == letters(mesh)
