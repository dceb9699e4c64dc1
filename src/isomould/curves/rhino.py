"""Reading curves of a Rhino model (.3dm), exactly (failure modes A1 to A7).

The reader, rhino3dm, is the extra `isomould[rhino]`; no other module imports it. What it reads strictly (files that
are cut off or damaged give nothing) is judged as strictly here as a DXF file.
"""

import importlib
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from isomould.arrays import Floats
from isomould.curves.bspline import Nurbs, segments
from isomould.curves.pieces import Ellipse, Line
from isomould.curves.spatial import Shape, Traced, shapes_of
from isomould.errors import OutputFault, Refused
from isomould.units import MM_PER_UNIT, LengthUnit

LARGEST_FILE = 100 * 2**20
"""Bytes; a model that is larger holds more than curves."""

_MM_PER_SYSTEM = {
    "Microns": 1e-3, "Millimeters": 1.0, "Centimeters": 10.0, "Decimeters": 100.0, "Meters": 1000.0, "Kilometers": 1e6,
    "Inches": 25.4, "Feet": 304.8, "Yards": 914.4,
}  # fmt: skip
_NAMED_LESS = 12


class Model(NamedTuple):
    """Which curve of which file: on a layer (its name or full path `A::B`), of a name, or both."""

    path: Path
    layer: str | None
    name: str | None
    units: LengthUnit | None
    """Of a model without units; otherwise they must agree."""


def trace_model(model: Model, field: str) -> list[Traced]:
    """Give the curves that a model's layer or name holds as shapes in space, mm.

    Raises
    ------
    Refused
        E-RHINO-MISSING without the extra; E-RHINO-FILE, -UNITS, -LAYER, -NAME or -OBJECT; E-SPLINE-….
    OutputFault
        If the system does not let the file be read.
    """
    file = _open(model.path, field)
    factor = _factor(file, model.units, field)
    return [_traced(item, factor, field) for item in _chosen(file, model, field)]


# --- the file


def _open(path: Path, field: str) -> Any:
    library = _library(field)
    file = library.File3dm.FromByteArray(_content(path, field))
    if file is None:
        found = f"{path.name} is damaged, cut off, or no Rhino model"
        _refuse("FILE", field, found, "a complete .3dm file", "Save it again in Rhino.")
    return file


def _library(field: str) -> Any:
    try:
        return importlib.import_module("rhino3dm")
    except ImportError:
        return _refuse(
            "MISSING",
            f"{field}.kind",
            "rhino, but rhino3dm is not installed",
            "the extra that reads .3dm files",
            'Install it with: pip install "isomould[rhino]", or save the curve as DXF.',
        )


def _content(path: Path, field: str) -> bytes:
    if not path.is_file():
        _refuse("FILE", field, f"{path} is no file", "an existing .3dm file", "Check the name and its folder.")
    try:
        if not 0 < path.stat().st_size <= LARGEST_FILE:
            found = f"{path.name} has {path.stat().st_size} bytes"
            _refuse("FILE", field, found, f"1 to {LARGEST_FILE}", "Save the curve alone.")
        return path.read_bytes()
    except OSError as error:
        message = f"{path}: {error.strerror}"
        raise OutputFault(message) from error


def _factor(file: Any, units: LengthUnit | None, field: str) -> float:
    """Give mm per unit of the model (failure mode A3)."""
    system = str(file.Settings.ModelUnitSystem.name)
    said, asked = _MM_PER_SYSTEM.get(system), MM_PER_UNIT.get(units or "")
    if said is None and system not in {"None", "Unset"}:
        limit = ", ".join(_MM_PER_SYSTEM)
        _refuse("UNITS", field, f"model units {system}", limit, "Change the model's units to millimetres.")
    if said is None and asked is None:
        _refuse("UNITS", f"{field}.units", "a model without units", "known units", 'Set units, such as "mm".')
    if said is not None and asked is not None and said != asked:
        found = f"{units} ({asked:g} mm), but the model says {system} ({said:g} mm)"
        _refuse("UNITS", f"{field}.units", found, "agreement", "Leave units out, or correct the model.")
    return said or asked or 1.0


# --- the objects


def _chosen(file: Any, model: Model, field: str) -> list[Any]:
    """Give the model's objects on the layer and of the name; something must be there."""
    layers = [] if model.layer is None else [_layer(file, model.layer, field).Index]
    placed = [item for item in file.Objects if not item.Attributes.IsInstanceDefinitionObject]
    modelled = [item for item in placed if item.Attributes.ActiveSpace.name == "ModelSpace"]
    here = [item for item in modelled if not layers or item.Attributes.LayerIndex in layers]
    found = [item for item in here if model.name is None or item.Attributes.Name == model.name]
    if not found and model.name is not None:
        _refuse_absent("NAME", f"{field}.name", model.name, [item.Attributes.Name for item in here])
    if not found:
        _refuse("LAYER", f"{field}.layer", f"nothing on layer {model.layer!r}", "one curve", "Check the layer's name.")
    for number in sorted({item.Attributes.LayerIndex for item in found}):
        _refuse_hidden(file, number, field)
    return found


def _layer(file: Any, wanted: str, field: str) -> Any:
    """Give the one layer of a name or full path."""
    layers = list(file.Layers)
    found = [layer for layer in layers if wanted.casefold() in {layer.Name.casefold(), layer.FullPath.casefold()}]
    if not found:
        _refuse_absent("LAYER", f"{field}.layer", wanted, [layer.FullPath for layer in layers])
    if len(found) > 1:
        listed = ", ".join(layer.FullPath for layer in found)
        _refuse("LAYER", f"{field}.layer", f"{wanted!r} names {listed}", "one layer", "Write its full path, A::B.")
    return found[0]


def _refuse_hidden(file: Any, number: int, field: str) -> None:
    """Refuse a layer that is off, or lies in one that is."""
    layers = {layer.Index: layer for layer in file.Layers}
    path = f"{layers[number].FullPath}::"
    off = [one.FullPath for one in layers.values() if not one.Visible and path.startswith(f"{one.FullPath}::")]
    if off:
        _refuse("LAYER", f"{field}.layer", f"layer {off[0]!r} is off", "a visible layer", "Turn it on.")


def _refuse_absent(what: str, field: str, wanted: str, names: list[str]) -> None:
    known = sorted({name for name in names if name})[:_NAMED_LESS]
    limit = f"one of {', '.join(known)}" if known else "a model with named objects or layers"
    _refuse(what, field, f"nothing is called {wanted!r}", limit, "Check the name.")


def _called(item: Any) -> str:
    name = f" {item.Attributes.Name!r}" if item.Attributes.Name else ""
    return f"{type(item.Geometry).__name__}{name} {item.Attributes.Id}"


def _traced(item: Any, factor: float, field: str) -> Traced:
    name = _called(item)
    if not item.Attributes.Visible or item.Attributes.Mode.name == "Hidden":
        _refuse("OBJECT", field, f"{name} is hidden", "visible curves", "Show it, or move it to another layer.")
    drawn = _shapes(item.Geometry, f"{field}, {name}")
    return Traced(name, [shape._replace(anchors=factor * shape.anchors) for shape in drawn], says_closed=False)


# --- the curves


def _shapes(curve: Any, name: str) -> list[Shape]:
    trace = _TRACERS.get(type(curve).__name__)
    if trace is None or not curve.IsValid or curve.Dimension != 3:
        way_out = "Convert it to a curve, explode blocks, or move it to another layer."
        _refuse("OBJECT", name, type(curve).__name__, f"valid {', '.join(_TRACERS)} in space", way_out)
    return trace(curve, name) if trace else []


def _line(curve: Any, _: str) -> list[Shape]:
    return [Shape(Line, np.array([_point(curve.Line.From), _point(curve.Line.To)]))]


def _polyline(curve: Any, _: str) -> list[Shape]:
    points = np.array([_point(curve.Point(k)) for k in range(curve.PointCount)])
    return [Shape(Line, points[k : k + 2]) for k in range(len(points) - 1)]


def _arc(curve: Any, _: str) -> list[Shape]:
    arc = curve.Arc
    centre, axes = _point(arc.Plane.Origin), np.array([_point(arc.Plane.XAxis), _point(arc.Plane.YAxis)])
    tips = np.vstack([centre, centre + arc.Radius * axes])
    return [Shape(Ellipse, tips, (float(arc.StartAngle), float(arc.EndAngle)))]


def _nurbs(curve: Any, name: str) -> list[Shape]:
    """Take the spline over: its points are homogeneous, its knots lack the first and the last, which have no effect."""
    rows = [curve.Points[k] for k in range(len(curve.Points))]
    points = np.array([[row.X, row.Y, row.Z, row.W] for row in rows])
    knots = np.array(list(curve.Knots), float)
    full = np.concatenate([knots[:1], knots, knots[-1:]])
    with np.errstate(all="ignore"):
        spline = Nurbs(curve.Degree, points[:, :3] / points[:, 3:], points[:, 3], full)
    return shapes_of(segments(spline, name))


def _polycurve(curve: Any, name: str) -> list[Shape]:
    return [shape for k in range(curve.SegmentCount) for shape in _shapes(curve.SegmentCurve(k), name)]


def _point(point: Any) -> Floats:
    return np.array([point.X, point.Y, point.Z], float)


_TRACERS: dict[str, Callable[[Any, str], list[Shape]]] = {
    "ArcCurve": _arc,
    "LineCurve": _line,
    "NurbsCurve": _nurbs,
    "PolyCurve": _polycurve,
    "PolylineCurve": _polyline,
}
"""Class of a Rhino curve to the function that traces it, in the direction it is drawn."""


def _refuse(what: str, field: str, found: str, limit: str, way_out: str) -> Any:
    raise Refused(code=f"E-RHINO-{what}", field=field, found=found, limit=limit, way_out=way_out)
