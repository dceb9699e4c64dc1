"""Pictures: what is in front hides what is behind, every part is there, and the gallery is up to date."""

import re
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

import isomould
from isomould.documents.graph import curvature_picture
from isomould.documents.picture import Caption, Dot, Shape, fit
from isomould.documents.views import developed_picture, space_picture
from isomould.errors import Refused
from isomould.form.polygon import cross
from isomould.templates import template_folder, template_names
from isomould.writers.svg import svg_text
from museum import SMALL, VAULT, design, sphere

DOCS = Path(__file__).parents[2] / "docs"
SVG = "{http://www.w3.org/2000/svg}"


def is_panel(item):
    """The arrows of the axes are open lines and heads without a stroke."""
    return isinstance(item, Shape) and item.closed and item.stroke is not None


@pytest.fixture(scope="module")
def ball():
    return design(sphere(15, 30))


@pytest.mark.parametrize("view", ["axonometry", "plan", "elevation"])
def test_every_panel_and_node_is_painted_inside_the_sheet(ball, view):
    picture = space_picture(ball.kit, "Ball", view)
    shapes = [item for item in picture.items if is_panel(item)]
    dots = [item for item in picture.items if isinstance(item, Dot)]
    assert (len(shapes), len(dots)) == (len(ball.kit.mesh.face_ij), len(ball.kit.mesh.nodes))
    places = np.concatenate([shape.points for shape in shapes])
    assert places.min() >= 0
    assert np.all(places.max(axis=0) <= [picture.width, picture.height])


def test_the_near_side_is_painted_last_and_shows_its_outside(ball):
    shapes = [item for item in space_picture(ball.kit, "Ball", "elevation").items if is_panel(item)]
    area = [sum(cross(shape.points, np.roll(shape.points, -1, axis=0))) for shape in shapes]
    assert all(a > 0 for a in area[-8:])
    assert all(a < 0 for a in area[:8])


def test_developed_strips_keep_lengths_and_do_not_overlap(ball):
    mesh = ball.kit.mesh
    picture = developed_picture(ball.kit, "Ball")
    shapes = [item.points for item in picture.items if isinstance(item, Shape)]
    assert len(shapes) == len(mesh.face_ij)
    rows = mesh.shape[0] - 1
    corner = mesh.nodes[mesh.table(mesh.faces).reshape(rows, -1, 4)].swapaxes(0, 1).reshape(-1, 4, 3)
    true = np.linalg.norm(corner - np.roll(corner, -1, axis=1), axis=2)
    drawn = np.array([np.linalg.norm(p - np.roll(p, -1, axis=0), axis=1) for p in shapes])
    assert drawn / drawn[0, 0] == pytest.approx(true / true[0, 0], rel=1e-9)
    right = [max(p[:, 0].max() for p in shapes[k : k + rows]) for k in range(0, len(shapes), rows)]
    left = [min(p[:, 0].min() for p in shapes[k : k + rows]) for k in range(0, len(shapes), rows)]
    assert all(a < b for a, b in zip(right[:-1], left[1:], strict=True))


def test_curvature_graph_has_a_dot_for_every_edge_on_its_line():
    vault = design(VAULT)
    picture = curvature_picture(vault.rail.curve, vault.form.rail, "Vault")
    dots = np.array([item.centre for item in picture.items if isinstance(item, Dot)])
    line = max((item.points for item in picture.items if isinstance(item, Shape)), key=len)
    assert len(dots) == len(vault.form.rail.edges.index)
    assert np.interp(dots[:, 0], line[:, 0], line[:, 1]) == pytest.approx(dots[:, 1], abs=0.1)
    assert dots[:, 1].argmax() == len(dots) // 2
    area = np.diff(np.interp(dots[:, 0], line[:, 0], np.append(0, np.cumsum(_areas(line)))))
    assert area == pytest.approx(area.mean(), rel=2e-3)


def _areas(line):
    floor = line[:, 1] - 64.0
    return np.diff(line[:, 0]) * (floor[1:] + floor[:-1]) / 2


def test_fit_keeps_the_shape():
    points = np.array([[0.0, 0.0], [400.0, 100.0]])
    placed = fit(points, 960, 24, 30).place(points)
    assert np.diff(placed, axis=0)[0] == pytest.approx([912.0, 228.0])
    assert placed[0] == pytest.approx([24.0, 54.0])


def test_svg_is_well_formed_and_text_is_escaped():
    data = {**SMALL, "project": {"name": "<Small> & more"}}
    picture = space_picture(design(data).kit, data["project"]["name"], "plan")
    root = ElementTree.fromstring(svg_text(picture))
    assert root.find(f"{SVG}title").text.startswith("<Small> & more")
    captions = [item for item in picture.items if isinstance(item, Caption)]
    assert [text.text for text in root.iter(f"{SVG}text")] == [caption.text for caption in captions]
    assert len(list(root.iter(f"{SVG}path"))) == 35 + 2 * len({"x", "y", "N"})


def test_draw_writes_every_view_the_same_twice(tmp_path, project_file):
    path = project_file(SMALL)
    for view in ("axonometry", "plan", "elevation", "developed", "curvature"):
        files = [tmp_path / f"{view}-{k}.svg" for k in range(2)]
        for file in files:
            isomould.draw(path, file, view)
        assert files[0].read_bytes() == files[1].read_bytes()
        assert files[0].stat().st_size > 1000


def test_other_formats_are_refused(tmp_path, project_file):
    with pytest.raises(Refused, match="E-DRAW-FILE"):
        isomould.draw(project_file(SMALL), tmp_path / "picture.pdf")


GALLERY = (DOCS / "gallery.md").read_text(encoding="utf-8")
SECTIONS = re.findall(r"^## `([\w-]+)`.*?\n(.*?)(?=^## |\Z)", GALLERY, re.MULTILINE | re.DOTALL)


PICTURES = [
    (template, name, re.findall(r"--(\w+) (\S+)", how))
    for template, text in SECTIONS
    for name, how in re.findall(r"\]\(pictures/([\w-]+)\.svg\)(?:<!--(.*?)-->)?", text)
]


@pytest.mark.parametrize(("template", "name", "how"), PICTURES)
def test_the_gallery_shows_what_the_program_draws(template, name, how, tmp_path):
    options = dict(how)
    view = name.removeprefix(f"{template}-") if not how else "axonometry"
    project = template_folder() / f"{template}.toml"
    changes = [options["set"]] if "set" in options else []
    picture = isomould.draw(project, tmp_path / "now.svg", view, changes, options.get("shape", "main"))
    now, then = (path.read_text() for path in (tmp_path / "now.svg", DOCS / "pictures" / f"{name}.svg"))
    assert re.findall(r"<(\w+)", now) == re.findall(r"<(\w+)", then)
    counts = [item.text.partition(": ")[2] for item in picture.items if isinstance(item, Caption)]
    said = re.sub(r"\s+", " ", dict(SECTIONS)[template])
    assert all(text in said for text in counts if " nodes of " in text)


def test_the_gallery_shows_every_template_with_its_counts():
    assert {template for template, _ in SECTIONS} == set(template_names())
    assert all("](pictures/" in text and re.search(r"\d nodes of", text) for _, text in SECTIONS)
    assert {path.stem for path in (DOCS / "pictures").glob("*.svg")} == {name for _, name, _ in PICTURES}
