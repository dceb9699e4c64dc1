"""Corners of panels clear of caps, by hand and through a whole delivery."""

import numpy as np
import pytest

import isomould
import museum
from isomould.design import kit_settings
from isomould.errors import Refused
from isomould.form.mesh import grid_mesh
from isomould.parts.corners import Stacks, Undersides, chamfer_legs, chamfered
from isomould.parts.outline import area
from isomould.parts.panels import make_panels
from isomould.verify import verify_folder

GAP = 15.0


def flat_quad(lean=0.0):
    """One square metre whose corners lie half a gap inside the nodes' axes, which lean in x; underside at 100."""
    nodes = np.array([[[0, 0, 0], [0, 1000, 0]], [[1000, 0, 0], [1000, 1000, 0.0]]]).transpose(1, 0, 2)
    axes = np.broadcast_to([np.sin(lean), 0.0, np.cos(lean)], nodes.shape).copy()
    mesh = grid_mesh(nodes, axes, np.zeros((2, 2), dtype=int), (False, False))
    inset = np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]]) * GAP / 2
    corners = np.column_stack([mesh.nodes[mesh.faces][:, :2] + inset, np.full(4, 100.0)])
    return mesh, Undersides(corners, np.tile([0.0, 0.0, 1.0], (4, 1)), 12.0)


def stacks(top, radius=45.0):
    return Stacks(radius, np.full(4, top))


def test_a_chamfer_by_hand():
    """The line at 45° keeps 50 mm from the axis: √2 · 50 from the node along the sides, less half the gap twice."""
    mesh, panels = flat_quad()
    legs = chamfer_legs(mesh, panels, stacks(110.0), 5.0)
    assert legs == pytest.approx(np.full(4, np.sqrt(2) * 50.0 - GAP), abs=1e-9)


def test_a_leaning_axis_pushes_the_chamfer_on():
    """An axis that leans by φ in x is off by z tan φ, and its cylinder is wider by 1/cos φ in x, at 112 as at 100."""
    lean = np.radians(10.0)
    mesh, panels = flat_quad(lean)
    legs = chamfer_legs(mesh, panels, stacks(200.0), 5.0)
    spread = 50 * np.sqrt((1 + 1 / np.cos(lean) ** 2) / 2)
    ahead, behind = (level * np.tan(lean) / np.sqrt(2) for level in (112.0, 100.0))
    here = (spread + ahead) * np.sqrt(2) - GAP
    there = (spread - behind) * np.sqrt(2) - GAP
    assert legs == pytest.approx([here, there, there, here], abs=1e-9)


@pytest.mark.parametrize(("top", "cut"), [(94.9, False), (95.1, True), (-np.inf, False)])
def test_what_ends_below_the_panels_cuts_nothing(top, cut):
    assert chamfer_legs(*flat_quad(), stacks(top), 5.0).any() == cut


def test_a_chamfered_outline():
    square = np.array([[0.0, 0.0], [1000.0, 0.0], [1000.0, 1000.0], [0.0, 1000.0]])
    cut = chamfered(square, np.array([30.0, 0.0, 20.0, 0.0]))
    assert area(cut) == pytest.approx(1e6 - 450 - 200)
    assert cut[0].tolist() == [30.0, 0.0]
    assert cut[1].tolist() == [1000.0, 0.0]


def test_caps_too_wide_for_the_panels_are_refused():
    design = museum.design(museum.SMALL)
    mesh, settings = design.kit.mesh, kit_settings(design.project)
    wide = Stacks(500.0, np.full(len(mesh.nodes), 200.0))
    with pytest.raises(Refused, match=r"E-PANEL-CORNER .*side [a-d] of P-"):
        make_panels(mesh, 200.0, settings.panels, settings.tolerance, wide)


def test_new_corners_are_rounded_to_the_inside():
    """Of blanks with slanted sides: what is cut lies within them, to the last bit of what is on a line."""
    blank = np.array([[0.0, 0.0], [1003.127, 0.0], [911.331, 777.777], [88.888, 777.777]])
    for leg in np.linspace(20, 60, 41):
        cut = chamfered(blank, np.full(4, leg))
        side = np.roll(blank, -1, axis=0) - blank
        inward = np.stack([-side[:, 1], side[:, 0]], axis=-1) / np.linalg.norm(side, axis=1)[:, None]
        assert np.einsum("nki,ki->nk", cut[:, None] - blank, inward).min() > -2e-9
        assert np.abs(np.sort(np.linalg.norm(cut[:, None] - blank, axis=2).min(axis=1)) - leg).max() < 1.5e-3


@pytest.mark.slow
def test_chamfered_panels_are_nested_uncut_and_delivered_cut(tmp_path):
    caps = {"retention": "lipped-cap", "cap": {"thickness": 30}}
    data = museum.changed(museum.SMALL, stock={"turn_over": True}, panels={"flippable": True}, nodes=caps)
    data["deliver"] = {"drawings": False}
    project = museum.write_project(tmp_path / "p.toml", data)
    built = isomould.build(project, tmp_path / "out", run=isomould.Run(effort="quick", jobs=1))
    panels = built.design.kit.panels
    assert {len(outline) for outline in panels.outlines} - {4}
    assert all(area(o) <= area(b) for o, b in zip(panels.outlines, panels.blanks, strict=True))
    found = {check.id: check.status for check in verify_folder(built.folder).checks}
    assert {found[rule] for rule in ("V24", "V26", "V26b", "V27", "V31b", "V32", "V33", "V40e")} == {"pass"}
