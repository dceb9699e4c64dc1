"""The readers refuse what is not right."""

import zipfile

import ezdxf
import numpy as np
import pytest
from verify_museum import vault

from isomould.verify.read.dxf import area, one_outline, read_dxf
from isomould.verify.read.mesh import read_mesh
from isomould.verify.read.solid import read_3mf, read_stl
from isomould.verify.read.tables import numbers, read_table, texts
from isomould.verify.read.text import read_json
from isomould.verify.rules import Unreadable


@pytest.mark.parametrize("text", ['{"a": NaN}', '{"a": 1, "a": 2}', "[1]", "{", "", '{"a": Infinity}'])
def test_json_is_strict(tmp_path, text):
    (tmp_path / "x.json").write_text(text)
    with pytest.raises(Unreadable, match=r"x\.json"):
        read_json(tmp_path / "x.json")


BAD_TABLES = [
    b"a,b\n1,2\n",
    b"\xef\xbb\xbfa\r\n1\r\n",
    b"a,a\r\n1,2\r\n",
    b"a,b\r\n1\r\n",
    b"\xff\r\n",
    b"",
    b'a\r\n"1\r\n',
]


@pytest.mark.parametrize("content", BAD_TABLES)
def test_broken_tables_are_refused(tmp_path, content):
    (tmp_path / "t.csv").write_bytes(content)
    with pytest.raises(Unreadable):
        read_table(tmp_path / "t.csv")


def test_tables_are_read(tmp_path):
    (tmp_path / "t.csv").write_bytes(b'a,b_mm,c\r\nx,1.5,\'=1+1\r\n"y,""z",-2,\r\n')
    table = read_table(tmp_path / "t.csv")
    assert texts(table, "a") == ("x", 'y,"z')
    assert texts(table, "c") == ("=1+1", "")
    assert numbers(table, "b_mm").tolist() == [1.5, -2.0]
    for column in ("a", "c", "none"):
        with pytest.raises(Unreadable):
            numbers(table, column)


@pytest.mark.parametrize("text", ["nan", "inf", "1,5", "1_0", " 1", "0x1", "1e999"])
def test_odd_numbers_are_refused(tmp_path, text):
    (tmp_path / "t.csv").write_bytes(f'a\r\n"{text}"\r\n'.encode())
    with pytest.raises(Unreadable):
        numbers(read_table(tmp_path / "t.csv"), "a")


MESH_FAULTS = {
    "nodes": lambda a: np.where(np.arange(len(a))[:, None] == 3, np.nan, a),
    "node_axes": lambda a: 1.01 * a,
    "node_ij": lambda a: a[:-1],
    "edges": lambda a: a + 1,
    "faces": lambda a: -a,
    "face_offsets": lambda a: a[::-1],
    "edge_location": lambda a: np.repeat(a[:1], len(a)),
    "face_mark": lambda a: a.astype(object),
    "node_location": lambda a: None,
}


@pytest.mark.parametrize("name", [None, *MESH_FAULTS])
def test_broken_meshes_are_refused(tmp_path, name):
    arrays = dict(vars(vault().mesh))
    if name:
        arrays[name] = MESH_FAULTS[name](arrays[name])
    np.savez(tmp_path / "geometry.npz", **{key: value for key, value in arrays.items() if value is not None})
    if name is None:
        assert len(read_mesh(tmp_path / "geometry.npz").nodes) == len(arrays["nodes"])
    else:
        with pytest.raises(Unreadable):
            read_mesh(tmp_path / "geometry.npz")


def drawing_file(path, bulges=(0, 0, 0, 0)):
    document = ezdxf.new("R2010", units=4)
    points = [(0, 0), (2, 0), (2, 1), (0, 1)]
    document.modelspace().add_lwpolyline(
        [(*p, b) for p, b in zip(points, bulges, strict=True)],
        format="xyb",
        close=True,
        dxfattribs={"layer": "CUT"},
    )
    document.saveas(path)


def test_drawings_are_read_with_their_arcs(tmp_path):
    drawing_file(tmp_path / "d.dxf", (0, 1, 0, 0))
    assert area(one_outline(read_dxf(tmp_path / "d.dxf"))) == pytest.approx(2 + np.pi / 8)
    with pytest.raises(Unreadable, match="0 outlines"):
        one_outline(read_dxf(tmp_path / "d.dxf"), "CUT_INNER")


def test_truncated_drawings_are_refused(tmp_path):
    drawing_file(tmp_path / "d.dxf")
    content = (tmp_path / "d.dxf").read_bytes()
    for share in (0.0, 0.2, 0.5, 0.8, 0.99):
        (tmp_path / "d.dxf").write_bytes(content[: int(share * len(content))])
        with pytest.raises(Unreadable):
            read_dxf(tmp_path / "d.dxf")


MODEL = (
    '<model unit="{unit}" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources><object id="1">'
    '<mesh><vertices>{vertices}</vertices><triangles><triangle v1="0" v2="1" v3="{last}"/></triangles></mesh></object>'
    '</resources><build><item objectid="1"{transform}/></build></model>'
)


@pytest.mark.parametrize(
    ("change", "good"),
    [
        ({}, True),
        ({"unit": "inch"}, False),
        ({"last": 9}, False),
        ({"x": "NaN"}, False),
        ({"transform": ' transform="1 0 0 0 1 0 0 0 1 5 0 0"'}, False),
    ],
)
def test_3mf_is_read_in_its_own_frame(tmp_path, change, good):
    given = {"unit": "millimeter", "last": 2, "x": "1", "transform": "", **change}
    vertices = "".join(f'<vertex x="{given["x"]}" y="{k}" z="0"/>' for k in range(3))
    with zipfile.ZipFile(tmp_path / "n.3mf", "w") as package:
        package.writestr("3D/3dmodel.model", MODEL.format(vertices=vertices, **given))
    if good:
        assert read_3mf(tmp_path / "n.3mf").triangles.tolist() == [[0, 1, 2]]
    else:
        with pytest.raises(Unreadable):
            read_3mf(tmp_path / "n.3mf")


def test_stl_of_another_length_is_refused(tmp_path):
    (tmp_path / "n.stl").write_bytes(bytes(80) + (1).to_bytes(4, "little") + bytes(49))
    with pytest.raises(Unreadable, match="1 triangles"):
        read_stl(tmp_path / "n.stl")
