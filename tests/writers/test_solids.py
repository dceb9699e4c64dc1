import struct
import zipfile

import lib3mf
import numpy as np
import pytest
from manifold3d import Manifold

from isomould.errors import Refused
from isomould.writers.solids import write_3mf, write_stl


@pytest.fixture(scope="module")
def drum():
    solid = Manifold.cylinder(100.1234567890123, 60.0, circular_segments=48)
    mesh = (solid - Manifold.cylinder(300, 11.0).translate([0, 0, -50])).to_mesh64()
    return np.array(mesh.vert_properties[:, :3]), np.array(mesh.tri_verts, dtype=np.int64)


def read_strictly(path):
    model = lib3mf.get_wrapper().CreateModel()
    reader = model.QueryReader("3mf")
    reader.SetStrictModeActive(True)
    reader.ReadFromFile(str(path))
    assert reader.GetWarningCount() == 0
    return model


def test_3mf_passes_the_strict_reader(drum, tmp_path):
    write_3mf(tmp_path / "N01.3mf", *drum, 'N01 "<&')
    model = read_strictly(tmp_path / "N01.3mf")
    meshes = model.GetMeshObjects()
    assert meshes.MoveNext()
    mesh = meshes.GetCurrentMeshObject()
    assert (mesh.GetName(), mesh.IsManifoldAndOriented()) == ('N01 "<&', True)
    assert (mesh.GetVertexCount(), mesh.GetTriangleCount()) == tuple(map(len, drum))
    assert model.GetUnit() == lib3mf.ModelUnit.MilliMeter


def test_3mf_holds_the_very_same_floats(drum, tmp_path):
    write_3mf(tmp_path / "N01.3mf", *drum, "N01")
    text = zipfile.ZipFile(tmp_path / "N01.3mf").read("3D/3dmodel.model").decode()
    found = [line.split('"')[1::2] for line in text.splitlines() if line.startswith("<vertex ")]
    assert np.array_equal(np.array(found, dtype=float), drum[0])


def test_stl_parses_back(drum, tmp_path):
    write_stl(tmp_path / "N01.stl", *drum)
    data = (tmp_path / "N01.stl").read_bytes()
    (count,) = struct.unpack_from("<I", data, 80)
    assert (count, len(data)) == (len(drum[1]), 84 + 50 * len(drum[1]))
    assert not data.startswith(b"solid")
    records = np.frombuffer(data, dtype="(3,)<f4,(3,3)<f4,<u2", offset=84)
    corners = records["f1"].astype(float)
    assert np.allclose(corners, drum[0][drum[1]], atol=1e-4)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert np.allclose(normals / np.linalg.norm(normals, axis=1, keepdims=True), records["f0"], atol=1e-4)


def test_volume_survives_in_stl(drum, tmp_path):
    write_stl(tmp_path / "N01.stl", *drum)
    corners = np.frombuffer((tmp_path / "N01.stl").read_bytes(), dtype="(3,)<f4,(3,3)<f4,<u2", offset=84)["f1"]
    a, b, c = np.moveaxis(corners.astype(float), 1, 0)
    exact = np.einsum("ij,ij->", drum[0][drum[1][:, 0]], np.cross(drum[0][drum[1][:, 1]], drum[0][drum[1][:, 2]])) / 6
    assert np.einsum("ij,ij->", a, np.cross(b, c)) / 6 == pytest.approx(exact, rel=1e-6)
    assert exact > 0


@pytest.mark.parametrize("write", [lambda *args: write_3mf(*args, "N01"), write_stl])
@pytest.mark.parametrize("fault", ["nan", "index", "empty"])
def test_broken_meshes_are_refused(drum, write, fault, tmp_path):
    vertices, triangles = drum[0].copy(), drum[1].copy()
    if fault == "nan":
        vertices[3, 1] = np.nan
    if fault == "index":
        triangles[0, 0] = len(vertices)
    with pytest.raises(Refused, match=r"E-OUT-0[67] solid N01"):
        write(tmp_path / "N01.any", vertices, triangles[: 0 if fault == "empty" else None])
    assert not list(tmp_path.iterdir())
