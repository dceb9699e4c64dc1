"""V20-V25 on a square tube, whole and spoilt."""

import numpy as np
import pytest
from verify_museum import holding, status, table, vault, with_raw

from isomould.verify.checks.solids import RULES, components, genus, leaks, volume
from isomould.verify.read.dxf import Drawing, Entity, Outline
from isomould.verify.read.solid import Solid

FACET = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
SQUARE = np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]], dtype=float)
VOLUME = (100.0**2 - 20.0**2) * 40


def tube(outer=50.0, inner=10.0, height=40.0):
    """Four rings of corners (outer and inner, bottom and top), joined by quads cut in two."""
    rings = [(outer, 0.0), (outer, height), (inner, height), (inner, 0.0)]
    vertices = np.vstack([np.column_stack((r * SQUARE, np.full(4, z))) for r, z in rings])
    quads = [
        (4 * a + k, 4 * a + (k + 1) % 4, 4 * ((a + 1) % 4) + (k + 1) % 4, 4 * ((a + 1) % 4) + k)
        for a in range(4)
        for k in range(4)
    ]
    triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    return Solid(vertices, np.array(triangles))


def delivery(solid=None, record=(), volume_cm3=384.0, mass=3.014, member_mass=9.42, section="FL200*12", **raw):
    given = {
        "status": "NoError",
        "components": 1,
        "genus": 1,
        "volume_mm3": VOLUME,
        "analytic_volume_mm3": VOLUME,
        "inclusion_exclusion": 1e-15,
        "commutativity": 0.0,
        **dict(record),
    }
    plate = Outline("CUT", np.array([[0, 0], [1000, 0], [1000, 100.0], [0, 100]]), np.zeros(4), True)
    hole = Entity("CIRCLE", "DRILL", ((50, 50, 0),), 10.0)
    found = {
        "nodes": table(
            "nodes",
            mark=["N01"],
            kind=["interior"],
            solid_file=["nodes/N01.3mf"],
            volume_cm3=[volume_cm3],
            mass_kg=[mass],
        ),
        "members": table("members", mark=["M01"], section=[section], mass_kg=[member_mass]),
    }
    found["panels"] = table("panels", mark=["P01"], mass_kg=[raw.pop("panel_mass", 3.0)])
    drawing = Drawing("M01", 4, (), (plate,), (hole,) if raw.pop("drilled", False) else ())
    return with_raw(
        holding(
            design=vault().design,
            solids={"N01": solid or tube()},
            solid_records={"N01": given},
            tables=found,
            members={"M01": drawing},
            panels={"P01": Drawing("P01", 4, (), (plate,), ())},
        ),
        **raw,
    )


def test_a_tube_is_counted_right():
    assert volume(tube()) == pytest.approx(VOLUME, rel=1e-14)
    assert (genus(tube()), components(tube()), leaks(tube())) == (1, 1, [])


@pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule.id)
def test_good_solids_pass(rule):
    assert status(RULES, rule.id, delivery()).status == ("not_applicable" if rule.id == "V23d" else "pass")


def turned():
    return Solid(tube().vertices, tube().triangles[:, ::-1])


def one_turned():
    triangles = tube().triangles.copy()
    triangles[3] = triangles[3, ::-1]
    return Solid(tube().vertices, triangles)


def holed():
    return Solid(tube().vertices, tube().triangles[1:])


def doubled():
    return Solid(tube().vertices, np.vstack((tube().triangles, tube().triangles[:1])))


def twice():
    far = tube().vertices + 1000
    return Solid(np.vstack((tube().vertices, far)), np.vstack((tube().triangles, tube().triangles + 16)))


def squashed():
    vertices = tube().vertices.copy()
    vertices[1] = vertices[0]
    return Solid(vertices, tube().triangles)


def moved():
    vertices = tube().vertices.copy()
    vertices[2] *= 1.0001
    return Solid(vertices, tube().triangles)


FAULTS = [
    ("V20", {"solid": twice()}),
    ("V20", {"record": {"status": "NotManifold"}}),
    ("V20", {"record": {"genus": 0}}),
    ("V20", {"record": {"components": 2}}),
    ("V20", {"node": {"bore_mm": 0}}),
    ("V21", {"record": {"inclusion_exclusion": 2e-9}}),
    ("V21", {"record": {"inclusion_exclusion": float("nan")}}),
    ("V22", {"record": {"commutativity": -2e-9}}),
    ("V23", {"solid": one_turned()}),
    ("V23", {"solid": holed()}),
    ("V23", {"solid": doubled()}),
    ("V23", {"solid": squashed()}),
    ("V23b", {"solid": turned()}),
    ("V23b", {"solid": moved()}),
    ("V23b", {"record": {"analytic_volume_mm3": VOLUME * (1 + 2e-9)}}),
    ("V23c", {"volume_cm3": 384.001}),
    ("V25", {"mass": 3.016}),
    ("V25", {"member_mass": 9.421}),
    ("V25", {"drilled": True}),
    ("V25b", {"panel_mass": 3.002}),
]


@pytest.mark.parametrize(("rule", "fault"), FAULTS, ids=map(str, range(len(FAULTS))))
def test_faults_are_found(rule, fault):
    assert status(RULES, rule, delivery(**fault)).status == "fail"


def test_a_missing_solid_is_found():
    assert status(RULES, "V20", holding(**{**vars(delivery()), "solids": {}})).status == "fail"


def test_stl_twins_are_compared(tmp_path):
    (tmp_path / "nodes").mkdir()
    corners = tube().vertices[tube().triangles].astype("<f4")

    def write(values):
        rows = np.zeros(len(values), FACET)
        rows["corners"] = values
        (tmp_path / "nodes" / "N01.stl").write_bytes(bytes(80) + len(values).to_bytes(4, "little") + rows.tobytes())

    for values, expected in ((corners, "pass"), (corners * 1.0001, "fail"), (corners[1:], "fail")):
        write(values)
        assert status(RULES, "V23d", holding(**{**vars(delivery()), "folder": tmp_path})).status == expected
