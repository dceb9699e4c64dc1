"""Parts that take each other's space are refused; parts that touch are not."""

from dataclasses import replace

import manifold3d as m3
import numpy as np
import pytest

import museum
from isomould.design import kit_settings
from isomould.errors import Refused
from isomould.parts.building import make_shapes, place_parts
from isomould.parts.clash import overlap_depth, refuse_clashes
from isomould.parts.features import Hole
from isomould.parts.outline import area
from isomould.parts.plates import extrude, hole_contour
from isomould.parts.solid import make_solids

BOX = np.array([[0.0, 0.0], [100.0, 0.0], [100.0, 40.0], [0.0, 40.0]])


def box(x=0.0, turn=0.0):
    return m3.Manifold.cube((100.0, 40.0, 20.0)).rotate((0, 0, turn)).translate((x, 0.0, 0.0))


@pytest.mark.parametrize(("shift", "depth"), [(99.5, 0.5), (100.0, 0.0), (100.2, 0.0), (85.0, 15.0), (99.996, 0.004)])
def test_depth_of_boxes(shift, depth):
    assert overlap_depth(box(), box(shift)) == pytest.approx(depth, abs=1e-9)
    assert overlap_depth(box(turn=33), box(shift * np.cos(np.radians(33)), 33).translate(
        (0, shift * np.sin(np.radians(33)), 0))) == pytest.approx(depth, abs=1e-6)  # fmt: skip


def volume(shape):
    a, b, c = np.moveaxis(shape.vertices[shape.triangles], 1, 0)
    return float((a * np.cross(b, c)).sum() / 6)


def test_plates_have_holes_and_slots():
    slot = hole_contour(Hole(50.0, 20.0, 10.0, lengthening=12.0))
    assert np.ptp(slot, axis=0) == pytest.approx([22.0, 10.0])
    assert area(slot) == pytest.approx(np.pi * 25 + 120, rel=1e-3)
    assert area(slot) < np.pi * 25 + 120
    bored = extrude(BOX, -6.0, 6.0, [slot, slot[::-1] + np.array([30.0, 0.0])])
    assert volume(bored) == pytest.approx((4000 - 2 * area(slot)) * 12, rel=1e-9)
    assert bored.vertices[:, 2].min() == -6.0


def parts(data):
    design = museum.design(data)
    settings = kit_settings(design.project)
    solids = make_solids(design.kit.nodes, design.kit.joints)
    return design.kit, settings, make_shapes(design.kit, settings, solids)


@pytest.fixture(scope="module")
def small():
    return parts(museum.SMALL)


def test_a_sound_design_is_free_of_clashes(small):
    refuse_clashes(*small)


def test_slots_without_clearance_are_contact_and_no_clash():
    refuse_clashes(*parts(museum.changed(museum.SMALL, nodes={"clearance": 0, "end_gap": 0})))


@pytest.mark.parametrize("mark", ["M01", "P01", "N01"])
def test_a_part_that_is_too_large_is_refused_with_names_and_depth(small, mark):
    kit, settings, shapes = small
    vertices = shapes[mark].vertices
    thicker = vertices + np.sign(vertices - vertices.mean(axis=0)) * [0.0, 0.0, 40.0]
    grown = {**shapes, mark: replace(shapes[mark], vertices=thicker)}
    with pytest.raises(Refused, match=rf"{mark} [NMP].*overlap by \d+\.\d\d\d mm at node N-"):
        refuse_clashes(kit, settings, grown)


def test_a_member_longer_than_its_slots_is_refused(small):
    kit, settings, shapes = small
    mark = kit.members.marks[0]
    long = shapes[mark].vertices.copy()
    long[long[:, 0] > long[:, 0].mean(), 0] += settings.nodes.end_gap + 0.25
    with pytest.raises(Refused, match=r"overlap by 0\.24\d mm"):
        refuse_clashes(kit, settings, {**shapes, mark: replace(shapes[mark], vertices=long)})


def test_panels_turned_over_stand_where_the_others_do(small):
    """Undersides of all panels lie on the seats' side, whichever way up their class is cut."""
    kit, settings, _ = parts(museum.changed(museum.template("barrel-vault"), panels={"flippable": True}))
    assert kit.panels.turned_over.any()
    poses, height = place_parts(kit, settings)[2].poses, settings.panels.thickness
    corners = kit.panels.corners[kit.mesh.face_offsets[:-1]]
    levels = np.einsum("fij,zj->fzi", poses[:, :3], [[0, 0, 0.0, 1], [0, 0, height, 1]]) - corners[:, None]
    above = np.sort(np.einsum("fzi,fi->fz", levels, kit.panels.normals), axis=1)
    assert above == pytest.approx(np.tile([0.0, height], (len(above), 1)), abs=1e-9)
