"""The building in its picture: everything inside the sheet, measurable, and the same as PNG."""

import io

import numpy as np
import pytest
from PIL import Image

import isomould
from isomould.delivery.pictures import design_picture
from isomould.documents.camera import make_camera
from isomould.documents.picture import Caption, Dot, Frame, Shape
from isomould.documents.surroundings import compass, person, scale_bar
from isomould.errors import Refused
from isomould.writers.png import png_bytes
from isomould.writers.svg import svg_text
from museum import SMALL, changed, design


@pytest.fixture(scope="module")
def small():
    return design(SMALL)


def seen(design_, **how):
    return design_picture(design_, isomould.Seen(style="building", **how))


@pytest.mark.parametrize("view", ["axonometry", "plan", "front", "side", "section"])
def test_everything_lies_inside_the_sheet(small, view):
    picture = seen(small, view=view)
    places = np.concatenate([item.points for item in picture.items if isinstance(item, Shape)])
    assert places.min() >= -0.5
    assert np.all(places.max(axis=0) <= [picture.width + 0.5, picture.height + 0.5])
    assert not [item for item in picture.items if isinstance(item, Dot)]
    assert {"0", "y" if view == "side" else "x"} <= {item.text for item in picture.items if isinstance(item, Caption)}


def test_every_pane_is_glass_and_bars_are_as_deep_as_they_are(small):
    picture = seen(small, view="front")
    panes = [item for item in picture.items if isinstance(item, Shape) and item.opacity < 1]
    assert len(panes) == len(small.kit.panels.locations)
    assert all(0.3 < pane.opacity <= 0.9 for pane in panes)


def test_a_section_shows_the_half_behind_the_middle(small):
    whole, half = seen(small, view="front"), seen(small, view="section")
    panes = [sum(isinstance(i, Shape) and i.opacity < 1 for i in picture.items) for picture in (whole, half)]
    assert 0 < panes[1] < panes[0]
    depth = small.kit.mesh.nodes @ np.array([0.0, -1.0, 0.0])
    middle = (depth.min() + depth.max()) / 2
    faces = np.split(depth[small.kit.mesh.faces], small.kit.mesh.face_offsets[1:-1])
    assert panes[1] == sum(face.mean() <= middle for face in faces)


@pytest.mark.parametrize("elevation", [0.0, 32.0, 60.0])
def test_a_person_and_the_scale_are_measured_alike(elevation):
    camera, frame = make_camera("axonometry", 20.0, elevation), Frame(0.05, (0.0, 0.0), 800.0)
    ground = np.array([[0, 0, 0], [9000, 0, 0], [9000, 7000, 0], [0, 7000, 0]], dtype=float)
    (shape,) = person(ground, camera, frame)
    assert np.ptp(shape.points[:, 1]) == pytest.approx(1750 * 0.05 * np.cos(np.radians(elevation)), abs=1e-6)
    bars = [item for item in scale_bar(frame, (10.0, 10.0)) if isinstance(item, Shape)]
    label = [item.text for item in scale_bar(frame, (10.0, 10.0)) if isinstance(item, Caption)][-1]
    length = max(bar.points[:, 0].max() for bar in bars) - 10.0
    assert length == pytest.approx(float(label.removesuffix(" m")) * 1000 * 0.05)


@pytest.mark.parametrize(("rotation", "expected"), [(0.0, (0, 1)), (90.0, (1, 0)), (30.0, (0.5, np.sqrt(3) / 2))])
def test_north_is_where_the_datum_says(rotation, expected):
    """A project whose x axis points north, 90 degrees counter-clockwise from east, has its north along x."""
    items = compass(make_camera("plan"), (0.0, 0.0), rotation)
    line = [item for item in items if isinstance(item, Shape) and not item.closed][-1]
    direction = line.points[1] - line.points[0]
    assert direction / np.linalg.norm(direction) == pytest.approx(expected, abs=1e-9)


def test_png_shows_what_svg_shows(small):
    picture = seen(small, view="front")
    content = png_bytes(picture)
    assert content == png_bytes(picture)
    image = Image.open(io.BytesIO(content)).convert("RGB")
    assert (
        image.size == (2 * round(picture.width), 2 * round(picture.height))
        or abs(image.size[1] - 2 * picture.height) < 2
    )
    sky, ground = image.getpixel((4, 4)), image.getpixel((4, image.size[1] - 4))
    assert sky[2] > sky[0] + 20
    assert abs(ground[0] - 0xDF) < 4
    assert svg_text(picture).count("<path") == sum(isinstance(item, Shape) for item in picture.items)


def test_draw_writes_png_from_any_side(tmp_path, project_file):
    path = project_file(SMALL)
    turned = isomould.Seen(style="building", azimuth_deg=200.0, elevation_deg=10.0)
    isomould.draw(path, tmp_path / "a.png", seen=turned)
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize("how", [{"view": "plan", "azimuth_deg": 3.0}, {"elevation_deg": 100.0}, {"view": "developed"}])
def test_angles_of_views_that_have_their_own_are_refused(small, how):
    with pytest.raises(Refused, match="E-DRAW-ANGLES"):
        seen(small, **how)


def test_an_axonometry_of_a_turned_site_shows_its_north(small):
    turned = design(changed(SMALL, project={"datum": {"rotation_deg": 90.0}}))
    straight, other = (seen(each, view="plan").items for each in (small, turned))
    north = [next(i.position for i in items if getattr(i, "text", "") == "N") for items in (straight, other)]
    assert north[0] != north[1]
