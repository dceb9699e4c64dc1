"""The scene of a page: every part is there once, says what it is, and stands where the mesh stands."""

from itertools import pairwise

import numpy as np
import pytest

from isomould.documents.scene import make_scene
from museum import changed, design, sphere


@pytest.fixture(scope="module")
def ball():
    return design(changed(sphere(15, 90), surface={"pole": "cap"})).kit


def area(vertices, triangles):
    a, b, c = np.moveaxis(vertices[triangles], 1, 0)
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2


def test_every_part_is_in_the_scene_once(ball):
    scene = make_scene(ball)
    assert len(set(scene.panels.texts)) == len(ball.mesh.face_ij)
    assert sum(len(strokes.texts) for strokes in scene.members) == len(ball.mesh.edges)
    assert scene.nodes.texts[7] == f"{ball.nodes.marks[ball.nodes.classes.of[7]]} {ball.nodes.locations[7]}"
    assert scene.nodes.places == pytest.approx(ball.mesh.nodes / 1000)


def test_panels_are_drawn_in_their_faces_by_the_same_share(ball):
    """Triangles and caps of many corners too: areas shrink by (1 - 0.04) squared, and no triangle is left out."""
    panels, mesh = make_scene(ball).panels, ball.mesh
    assert len(panels.triangles) == int((mesh.sizes - 2).sum())
    faces = np.split(mesh.faces, mesh.face_offsets[1:-1])
    fans = np.array([(face[0], *pair) for face in faces for pair in pairwise(face[1:])])
    assert area(panels.vertices, panels.triangles) == pytest.approx(0.96**2 * area(mesh.nodes / 1000, fans))


def test_triangles_of_one_panel_have_one_colour_and_one_text(ball):
    panels = make_scene(ball).panels
    texts = np.array(panels.texts)[panels.triangles]
    assert (texts == texts[:, :1]).all()
    colours = dict(zip(texts[:, 0].tolist(), panels.colours, strict=True))
    assert [colours[text] for text in texts[:, 0].tolist()] == list(panels.colours)
