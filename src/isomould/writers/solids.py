"""Solids as 3MF, which keeps topology and precision, and as STL, the convenience."""

from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np

from isomould.arrays import Floats, Ints
from isomould.errors import Refused
from isomould.writers.disk import write_bytes, zip_bytes

_CONTENT_TYPES = b"""<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>
<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>
</Types>
"""
_RELATIONSHIPS = b"""<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Target="/3D/3dmodel.model" Id="rel0"
 Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>
"""
_MODEL = """<?xml version="1.0" encoding="UTF-8"?>
<model unit="millimeter" xml:lang="en-US" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">
<resources>
<object id="1" type="model" name={name}>
<mesh>
<vertices>
{vertices}
</vertices>
<triangles>
{triangles}
</triangles>
</mesh>
</object>
</resources>
<build>
<item objectid="1"/>
</build>
</model>
"""
_STL_HEADER = b"isomould, lengths in mm".ljust(80)
_STL_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def write_3mf(path: Path, vertices: Floats, triangles: Ints, name: str) -> None:
    """Write one solid as core 3MF in mm.

    The package is written here rather than by lib3mf, which rounds to float32 and gives every file
    new UUIDs; the coordinates in the file are the very same floats.

    Parameters
    ----------
    path : Path
    vertices : (n, 3) float, mm
    triangles : (m, 3) int
        Counter-clockwise from outside.
    name : str

    Raises
    ------
    Refused
        If a coordinate is not finite or a triangle names no vertex.
    """
    check_triangles(vertices, triangles, name)
    model = _MODEL.format(name=quoteattr(name), vertices=_vertices(vertices), triangles=_triangles(triangles))
    parts = {
        "[Content_Types].xml": _CONTENT_TYPES,
        "_rels/.rels": _RELATIONSHIPS,
        "3D/3dmodel.model": model.encode(),
    }
    write_bytes(path, zip_bytes(parts))


def write_stl(path: Path, vertices: Floats, triangles: Ints) -> None:
    """Write one solid as binary STL in mm, float32 as the format has it."""
    check_triangles(vertices, triangles, path.stem)
    records = np.zeros(len(triangles), dtype=_STL_TRIANGLE)
    records["corners"] = vertices[triangles]
    records["normal"] = _normals(vertices[triangles])
    write_bytes(path, _STL_HEADER + np.uint32(len(triangles)).astype("<u4").tobytes() + records.tobytes())


def check_triangles(vertices: Floats, triangles: Ints, name: str) -> None:
    """Refuse triangles that no reader would take."""
    if not np.isfinite(vertices).all():
        raise Refused("E-OUT-06", f"solid {name}", "a coordinate that is no number", "finite numbers", _WAY_OUT)
    if len(triangles) == 0 or triangles.min() < 0 or triangles.max() >= len(vertices):
        raise Refused("E-OUT-07", f"solid {name}", f"{len(vertices)} vertices", "what its triangles name", _WAY_OUT)


_WAY_OUT = "Nothing was written; please report the project file."


def _vertices(vertices: Floats) -> str:
    return "\n".join(f'<vertex x="{x!r}" y="{y!r}" z="{z!r}"/>' for x, y, z in vertices.tolist())


def _triangles(triangles: Ints) -> str:
    return "\n".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in triangles.tolist())


def _normals(corners: Floats) -> Floats:
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    normals = np.cross(b - a, c - a)
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.divide(normals, lengths, out=np.zeros_like(normals), where=lengths > 0)
