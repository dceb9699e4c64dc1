"""Draw the corpus's shapes as Rhino models: `python make_rhino.py SHAPES.json FOLDER`."""

import json
import sys
from math import cos, pi, radians, sin
from pathlib import Path

import rhino3dm as rh


def point(x, y):
    return rh.Point3d(x, y, 0)


def curve(entity):
    kind, *rest = entity
    if kind == "line":
        return rh.LineCurve(point(*rest[:2]), point(*rest[2:]))
    if kind == "polyline":
        return rh.PolylineCurve(rh.Point3dList([point(*p) for p in rest[0] + (rest[0][:1] if rest[1] else [])]))
    if kind == "ellipse":
        return quarters(*rest)
    return rh.NurbsCurve.Create(False, 3, [point(*p) for p in rest[0]])


def quarters(x, y, a, b, turn, start, end):
    """A rational spline of degree 2, a quarter a span."""
    count = round((end - start) / (pi / 2))
    spline = rh.NurbsCurve(3, True, 3, 2 * count + 1)
    c, s = cos(turn), sin(turn)
    for k in range(2 * count + 1):
        angle, weight = start + k * pi / 4, 1.0 if k % 2 == 0 else cos(pi / 4)
        u, v = a * cos(angle) / (1 if k % 2 == 0 else weight), b * sin(angle) / (1 if k % 2 == 0 else weight)
        place = (x + c * u - s * v, y + s * u + c * v)
        spline.Points[k] = rh.Point4d(weight * place[0], weight * place[1], 0, weight)
    for k in range(2 * count + 2):
        spline.Knots[k] = float(k // 2)
    return spline


def add(objects, entity):
    kind, *rest = entity
    if kind == "circle":
        objects.AddCircle(rh.Circle(point(*rest[:2]), rest[2]))
    elif kind == "arc":
        x, y, radius, start, end = rest
        angles = [radians(start + share * ((end - start) % 360)) for share in (0, 0.5, 1)]
        objects.AddArc(rh.Arc(*(point(x + radius * cos(a), y + radius * sin(a)) for a in angles)))
    else:
        objects.AddCurve(curve(entity))


shapes, folder = json.loads(Path(sys.argv[1]).read_text()), Path(sys.argv[2])
for name, entities in shapes.items():
    model = rh.File3dm()
    model.Settings.ModelUnitSystem = rh.UnitSystem.Millimeters
    layer = rh.Layer()
    layer.Name = "RAIL"
    model.Layers.Add(layer)
    for entity in entities:
        add(model.Objects, entity)
    model.Write(str(folder / f"rhino-{name}.3dm"), 7)
