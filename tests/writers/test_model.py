import numpy as np
import pytest
import trimesh

from isomould.errors import Refused
from isomould.writers.model import Instance, write_glb, write_npz, write_obj

CORNERS = np.array([[0, 0, 0], [1000, 0, 0], [1000, 800, 0], [0, 800, 0], [0, 0, 50], [0, 0, -1e-9]], float)
TETRAHEDRON = (CORNERS[[0, 1, 3, 4]], np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]))


def move(x, y, z):
    return np.vstack([np.column_stack([np.eye(3), [x, y, z]]), [0, 0, 0, 1]])


def test_npz_reads_back_without_pickles(tmp_path):
    arrays = {
        "nodes": CORNERS,
        "node_mark": np.array(["N01", "N02"]),
        "node_ij": np.array([[0, 1]], np.int32),
    }
    write_npz(tmp_path / "geometry.npz", arrays)
    with np.load(tmp_path / "geometry.npz", allow_pickle=False) as found:
        assert sorted(found) == sorted(arrays)
        for name, array in arrays.items():
            assert found[name].dtype == array.dtype
            assert np.array_equal(found[name], array)


@pytest.mark.parametrize("array", [np.array([1.0, np.nan]), np.array([np.inf]), np.array([None, "a"], dtype=object)])
def test_npz_refuses_nan_and_objects(array, tmp_path):
    with pytest.raises(Refused, match="E-OUT-08 array nodes"):
        write_npz(tmp_path / "geometry.npz", {"nodes": array})


def test_obj_holds_polygons_in_named_groups(tmp_path):
    faces, offsets = np.array([0, 1, 2, 3, 0, 1, 4]), np.array([0, 4, 7])
    write_obj(tmp_path / "mesh.obj", CORNERS, faces, offsets, ["P01 P-00-00", "P02 P-00-01"])
    lines = (tmp_path / "mesh.obj").read_text(encoding="utf-8").splitlines()
    assert [line for line in lines if line[0] in "gf"] == [
        "g P01 P-00-00",
        "f 1 2 3 4",
        "g P02 P-00-01",
        "f 1 2 5",
    ]
    assert lines[2] == "v 1000 0 0"
    assert lines[6] == "v 0 0 0"


def test_glb_names_its_parts_and_stands_upright_in_metres(tmp_path):
    parts = [Instance("N01", f"N-00-{k:02d}", move(1000.0 * k, 0, 2000.0)) for k in range(3)]
    write_glb(tmp_path / "model.glb", {"N01": TETRAHEDRON}, parts)
    scene = trimesh.load_scene(tmp_path / "model.glb")
    assert set(scene.graph.nodes_geometry) == {"N01 N-00-00", "N01 N-00-01", "N01 N-00-02"}
    assert len(scene.geometry) == 1
    assert np.allclose(scene.bounds, [[0, 2.0, -0.8], [3.0, 2.05, 0.0]])
    assert sum(mesh.volume for mesh in scene.dump()) == pytest.approx(3 * 0.8 * 0.05 / 6, rel=1e-6)


def test_glb_refuses_nan(tmp_path):
    with pytest.raises(Refused, match="E-OUT-06"):
        write_glb(tmp_path / "model.glb", {"N01": (TETRAHEDRON[0] * np.nan, TETRAHEDRON[1])}, [])
