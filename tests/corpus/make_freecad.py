"""Export the corpus's shapes from FreeCAD: `SHAPES=… FOLDER=… freecadcmd make_freecad.py`."""

import json
import os
from math import degrees
from pathlib import Path

import FreeCAD
import Import
import Part
from FreeCAD import Vector

UP = Vector(0, 0, 1)


def edges(entity):
    kind, *rest = entity
    if kind == "line":
        return [Part.LineSegment(Vector(*rest[:2]), Vector(*rest[2:])).toShape()]
    if kind == "arc":
        return [Part.makeCircle(rest[2], Vector(*rest[:2]), UP, rest[3], rest[4] + 360 * (rest[4] < rest[3]))]
    if kind == "circle":
        return [Part.makeCircle(rest[2], Vector(*rest[:2]))]
    if kind == "ellipse":
        x, y, a, b, turn, start, end = rest
        ellipse = Part.Ellipse(Vector(x, y), a, b)
        ellipse.rotate(FreeCAD.Placement(Vector(), FreeCAD.Rotation(UP, degrees(turn)), Vector(x, y)))
        return [ellipse.toShape() if end - start > 6.28 else ellipse.toShape(start, end)]
    if kind == "spline":
        curve, count = Part.BSplineCurve(), len(rest[0])
        inner = [k / (count - 3) for k in range(count - 2)]
        poles = [Vector(*point) for point in rest[0]]
        curve.buildFromPolesMultsKnots(poles, [4] + [1] * (len(inner) - 2) + [4], inner, False, 3)
        return [curve.toShape()]
    points = [Vector(*point) for point in rest[0] + (rest[0][:1] if rest[1] else [])]
    return Part.makePolygon(points).Edges


for name, entities in json.loads(Path(os.environ["SHAPES"]).read_text()).items():
    document = FreeCAD.newDocument("Corpus")
    body = document.addObject("Part::Feature", "RAIL")
    body.Shape = Part.makeCompound([edge for entity in entities for edge in edges(entity)])
    document.recompute()
    Import.writeDXFObject([body], str(Path(os.environ["FOLDER"]) / f"freecad-{name}.dxf"), 14, False)
    FreeCAD.closeDocument(document.Name)
