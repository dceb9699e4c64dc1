"""Draw the corpus's shapes with the ezdxf that is installed: `python make_ezdxf.py SHAPES.json FOLDER VERSION WORD`."""

import json
import sys
from math import cos, sin
from pathlib import Path

import ezdxf


def draw(space, entity, version):
    kind, *rest = entity
    at = {"layer": "RAIL"}
    if kind == "line":
        space.add_line(rest[:2], rest[2:], dxfattribs=at)
    elif kind == "arc":
        space.add_arc(rest[:2], *rest[2:], dxfattribs=at)
    elif kind == "circle":
        space.add_circle(rest[:2], rest[2], dxfattribs=at)
    elif kind == "ellipse":
        x, y, a, b, turn, start, end = rest
        space.add_ellipse((x, y), (a * cos(turn), a * sin(turn)), b / a, start, end, dxfattribs=at)
    elif kind == "spline":
        space.add_open_spline(rest[0], 3, dxfattribs=at)
    elif version == "R12":
        space.add_polyline2d(rest[0], close=rest[1], dxfattribs=at)
    else:
        space.add_lwpolyline(rest[0], close=rest[1], dxfattribs=at)


if __name__ == "__main__":
    shapes, folder, version, word = json.loads(Path(sys.argv[1]).read_text()), Path(sys.argv[2]), *sys.argv[3:5]
    for name, entities in shapes.items():
        if version == "R12" and entities[0][0] in ("spline", "ellipse"):
            continue
        document = ezdxf.new(version)
        if version != "R12":
            document.header["$INSUNITS"] = 4
        for entity in entities:
            draw(document.modelspace(), entity, version)
        document.saveas(folder / f"{word}-{name}.dxf")
