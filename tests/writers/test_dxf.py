import ezdxf
import numpy as np
import pyogrio
import pytest
import shapely
from ezdxf import options

from isomould.documents.cut_sheets import PartOnSheet, part_drawing, sheet_drawing
from isomould.documents.drawing import Circle, CutDrawing, Label, Polyline, Segment3D, signed_area
from isomould.errors import Refused
from isomould.writers.dxf import write_dxf

OUTLINE = np.array([[0, 0], [1200.123, 0], [1100.456, 900.789], [150.001, 900.789]])
SLOT = Polyline(
    "CUT_INNER",
    np.array([[400, 100], [800, 100], [800, 140], [400, 140]], float),
    True,
    np.array([0, 1, 0, 1.0]),
)
HOLE = Circle("DRILL", (600.0, 700.0), 9.0)


@pytest.fixture
def drawing():
    part = part_drawing("P07", OUTLINE, inner=[SLOT], note="ü 680 × 12 mm")
    axis = (
        Segment3D("INFO", (0.0, 1.5, 2.5), (3.0, 4.0, 5.5)),
        Label("INFO", "MG-00-01", (1.0, 2.0, 3.0), 50.0),
    )
    return CutDrawing((*part.entities, HOLE, *axis))


@pytest.fixture(params=["R2010", "R12"])
def version(request):
    return request.param


def test_units_layers_and_audit(drawing, tmp_path):
    write_dxf(tmp_path / "P07.dxf", drawing)
    document = ezdxf.readfile(tmp_path / "P07.dxf")
    auditor = document.audit()
    assert (len(auditor.errors), len(auditor.fixes)) == (0, 0)
    assert (document.dxfversion, document.header["$INSUNITS"], document.header["$MEASUREMENT"]) == (
        "AC1024",
        4,
        1,
    )
    assert all(entity.dxf.color == 256 and entity.dxf.linetype == "BYLAYER" for entity in document.modelspace())


def test_contours_read_back_exactly(drawing, tmp_path):
    write_dxf(tmp_path / "P07.dxf", drawing)
    space = ezdxf.readfile(tmp_path / "P07.dxf").modelspace()
    (cut,), (slot,) = (space.query(f'LWPOLYLINE[layer=="{layer}"]') for layer in ("CUT", "CUT_INNER"))
    assert cut.closed
    assert [tuple(point) for point in cut.get_points("xy")] == [tuple(point) for point in OUTLINE]
    read = Polyline("CUT_INNER", np.array(slot.get_points("xy")), True, np.array(slot.get_points("b"), float).ravel())
    assert signed_area(read) == pytest.approx(-signed_area(SLOT), rel=1e-14)


def test_entities_of_both_versions(drawing, version, tmp_path):
    write_dxf(tmp_path / "P07.dxf", drawing, version=version)
    space = ezdxf.readfile(tmp_path / "P07.dxf").modelspace()
    line, circle = space.query("LINE").first, space.query("CIRCLE").first
    assert (line.dxf.layer, line.dxf.start, line.dxf.end) == ("INFO", (0, 1.5, 2.5), (3, 4, 5.5))
    assert (circle.dxf.layer, circle.dxf.radius) == ("DRILL", 9.0)
    assert {text.dxf.text for text in space.query("TEXT")} == {"P07 ü 680 × 12 mm", "MG-00-01"}
    assert len(space.query("LWPOLYLINE" if version == "R2010" else "POLYLINE")) == 2 + len(engraved(drawing))


def engraved(drawing):
    return [entity for entity in drawing.entities if entity.layer == "ENGRAVE"]


def test_gdal_reads_the_same_areas(tmp_path):
    placed = [PartOnSheet("P07", f"P-00-{k:02d}", OUTLINE + np.array([20 + 1250 * k, 20])) for k in range(2)]
    write_dxf(tmp_path / "S001.dxf", sheet_drawing(3210, 2250, placed))
    meta, _, shapes, fields = pyogrio.raw.read(tmp_path / "S001.dxf", columns=["Layer"])
    assert list(meta["fields"]) == ["Layer"]
    lines = shapely.from_wkb(shapes)
    areas = [shapely.Polygon(line.coords).area for line, layer in zip(lines, fields[0], strict=True) if layer == "CUT"]
    assert areas == pytest.approx([shapely.Polygon(OUTLINE).area] * 2, rel=1e-12)


def test_layer_names_of_the_shop(drawing, tmp_path):
    write_dxf(tmp_path / "P07.dxf", drawing, {"CUT": "SCHNITT"})
    space = ezdxf.readfile(tmp_path / "P07.dxf").modelspace()
    assert len(space.query('*[layer=="SCHNITT"]')) == 1
    assert not space.query('*[layer=="CUT"]')


def test_nan_is_refused_before_writing(tmp_path):
    broken = CutDrawing((Polyline("CUT", OUTLINE * [1, np.nan], True),))
    with pytest.raises(Refused, match="E-OUT-02"):
        write_dxf(tmp_path / "P07.dxf", broken)
    assert not list(tmp_path.iterdir())


def test_the_global_option_is_left_as_it_was(drawing, tmp_path):
    write_dxf(tmp_path / "P07.dxf", drawing)
    assert options.write_fixed_meta_data_for_testing is False
