"""Reading curves of a Rhino model (.3dm), exactly (failure modes A1 to A7).

The reader, rhino3dm, is the extra `isomould[rhino]`; no other module imports it. What it reads strictly (files that
are cut off or damaged give nothing) is judged as strictly here as a DXF file.
"""

import importlib
from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from isomould.arrays import Floats
from isomould.curves.bspline import Nurbs
from isomould.curves.drawing_units import RHINO_SYSTEMS, FoundUnit, refuse_no_unit, unit_of
from isomould.curves.layer_names import layer_key, listed, quoted
from isomould.curves.layers import LayerContent, LayerDrawing
from isomould.curves.pieces import Ellipse, Line
from isomould.curves.spatial import Shape, Traced, shapes_of
from isomould.curves.tidy_splines import tidied_segments
from isomould.errors import Note, OutputFault, Refused
from isomould.units import LengthUnit

LARGEST_FILE = 100 * 2**20
"""Bytes; a model that is larger holds more than curves."""


class RhinoSource:
    """An opened model. Made by `open_rhino_source`."""

    def __init__(self, file: Any, unit: FoundUnit | None, notes: tuple[Note, ...], field: str) -> None:
        self._file, self._field = file, field
        self.unit, self.notes = unit, notes

    def layers(self) -> tuple[LayerContent, ...]:
        """Give every layer by its full path, with what the model shows on it and what lies elsewhere."""
        found = list[LayerContent]()
        for layer in sorted(self._file.Layers, key=lambda one: (one.FullPath.casefold(), one.Index)):
            kinds = Counter(_kind(item) for item in _modelled(self._file) if item.Attributes.LayerIndex == layer.Index)
            state = "off" if _switched_off(self._file, layer.Index) else ""
            elsewhere = _elsewhere(self._file, layer.Index)
            found.append(LayerContent(layer.FullPath, dict(sorted(kinds.items())), state, elsewhere))
        return tuple(found)

    def holds(self, layer: str) -> bool:
        """Tell whether the model shows anything on a layer."""
        key = layer_key(layer)
        indices = {one.Index for one in self._file.Layers if key in (layer_key(one.Name), layer_key(one.FullPath))}
        return any(item.Attributes.LayerIndex in indices for item in _modelled(self._file))

    def trace(self, layer: str | None, skip: Sequence[str] = (), name: str | None = None) -> LayerDrawing:
        """Give the curves that a layer (its name or full path `A::B`), or a name, holds, as shapes in space, mm.

        Raises
        ------
        Refused
            E-RHINO-UNITS, -LAYER, -NAME or -OBJECT; E-SPLINE-….
        """
        if self.unit is None:
            raise refuse_no_unit("E-RHINO-UNITS", "a model without units", self._field)
        chosen = _chosen(self._file, layer, name, self._field)
        left = Counter(_kind(item) for item in chosen if _kind(item) in skip)
        text = f"{', '.join(f'{count} {kind}' for kind, count in sorted(left.items()))} left out"
        notes = (Note("W-RHINO-LEFT-OUT", self._field, text),) if left else ()
        kept = [item for item in chosen if _kind(item) not in skip]
        return LayerDrawing([_traced(item, self.unit.mm, self._field) for item in kept], notes, 0.0)


def open_rhino_source(path: Path, units: LengthUnit | None, field: str) -> RhinoSource:
    """Open a model.

    Raises
    ------
    Refused
        E-RHINO-MISSING without the extra; E-RHINO-FILE, -UNITS.
    OutputFault
        If the system does not let the file be read.
    """
    file = _open(path, field)
    system = str(file.Settings.ModelUnitSystem.name)
    said = RHINO_SYSTEMS.get(system)
    if said is None and system not in {"None", "Unset"} and units is None:
        raise refuse_no_unit("E-RHINO-UNITS", f"model units {system}", field)
    unit, notes = unit_of(said, units, field)
    return RhinoSource(file, unit, notes, field)


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


# --- the objects


def _modelled(file: Any) -> list[Any]:
    """Give the objects that stand in the model: neither on paper nor in a block's definition."""
    placed = [item for item in file.Objects if not item.Attributes.IsInstanceDefinitionObject]
    return [item for item in placed if item.Attributes.ActiveSpace.name == "ModelSpace"]


def _elsewhere(file: Any, index: int) -> tuple[str, ...]:
    """Say what is on a layer and is not in the model."""
    here = [item for item in file.Objects if item.Attributes.LayerIndex == index]
    defined = Counter(_kind(item) for item in here if item.Attributes.IsInstanceDefinitionObject)
    others = Counter(_kind(item) for item in here if item.Attributes.ActiveSpace.name != "ModelSpace")
    places = ((defined, "in blocks"), (others, "on paper"))
    return tuple(
        f"{', '.join(f'{count} {kind}' for kind, count in sorted(kinds.items()))} {where}"
        for kinds, where in places
        if kinds
    )


def _kind(item: Any) -> str:
    return type(item.Geometry).__name__


def _chosen(file: Any, layer: str | None, name: str | None, field: str) -> list[Any]:
    """Give the model's objects on the layer and of the name; something must be there."""
    layers = [] if layer is None else [_layer(file, layer, field).Index]
    here = [item for item in _modelled(file) if not layers or item.Attributes.LayerIndex in layers]
    found = [item for item in here if name is None or layer_key(item.Attributes.Name) == layer_key(name)]
    if not found and name is not None:
        _refuse_absent("NAME", f"{field}.name", name, [item.Attributes.Name for item in here])
    if not found:
        _refuse_empty(file, layer or "", layers[0], field)
    for number in sorted({item.Attributes.LayerIndex for item in found}):
        _refuse_hidden(file, number, field)
    return found


def _refuse_empty(file: Any, layer: str, index: int, field: str) -> None:
    """Say what is there instead (intake K9)."""
    elsewhere = _elsewhere(file, index)
    paths = {one.Index: one.FullPath for one in file.Layers}
    filled = Counter(paths.get(item.Attributes.LayerIndex, "") for item in _modelled(file))
    found = f"nothing on layer {quoted(layer)} in the model" + (f": {'; '.join(elsewhere)}" if elsewhere else "")
    limit = f"one curve, as on {listed(filled)}" if filled else "a model with curves"
    _refuse("LAYER", f"{field}.layer", found, limit, "Check the layer's name.")


def _layer(file: Any, wanted: str, field: str) -> Any:
    """Give the one layer of a name or full path."""
    layers = list(file.Layers)
    key = layer_key(wanted)
    found = [layer for layer in layers if key in {layer_key(layer.Name), layer_key(layer.FullPath)}]
    if not found:
        _refuse_absent("LAYER", f"{field}.layer", wanted, [layer.FullPath for layer in layers])
    if len(found) > 1:
        paths = listed(layer.FullPath for layer in found)
        _refuse("LAYER", f"{field}.layer", f"{quoted(wanted)} names {paths}", "one layer", "Write its full path, A::B.")
    return found[0]


def _switched_off(file: Any, number: int) -> list[str]:
    """Give the paths of layers that are off: this one, and those that it lies in."""
    layers = {layer.Index: layer for layer in file.Layers}
    path = f"{layers[number].FullPath}::"
    return [one.FullPath for one in layers.values() if not one.Visible and path.startswith(f"{one.FullPath}::")]


def _refuse_hidden(file: Any, number: int, field: str) -> None:
    """Refuse a layer that is off, or lies in one that is."""
    off = _switched_off(file, number)
    if off:
        _refuse("LAYER", f"{field}.layer", f"layer {quoted(off[0])} is off", "a visible layer", "Turn it on.")


def _refuse_absent(what: str, field: str, wanted: str, names: list[str]) -> None:
    known = listed(name for name in names if name)
    limit = f"one of {known}" if known else "a model with named objects or layers"
    _refuse(what, field, f"nothing is called {quoted(wanted)}", limit, "Check the name.")


def _called(item: Any) -> str:
    name = f" {quoted(item.Attributes.Name)}" if item.Attributes.Name else ""
    return f"{_kind(item)}{name} {item.Attributes.Id}"


def _traced(item: Any, factor: float, field: str) -> Traced:
    name = _called(item)
    if not item.Attributes.Visible or item.Attributes.Mode.name == "Hidden":
        _refuse("OBJECT", field, f"{name} is hidden", "visible curves", "Show it, or move it to another layer.")
    _refuse_no_curve(item.Geometry, f"{field}, {name}")
    base = _point(item.Geometry.PointAtStart)
    drawn = _shapes(item.Geometry, base, f"{field}, {name}")
    shapes = [shape._replace(anchors=factor * shape.anchors) for shape in drawn]
    return Traced(name, shapes, says_closed=False, base=factor * base)


# --- the curves, their points measured from one of them, so that a site's coordinates lose nothing


def _shapes(curve: Any, base: Floats, name: str) -> list[Shape]:
    _refuse_no_curve(curve, name)
    return _TRACERS[type(curve).__name__](curve, base, name)


def _refuse_no_curve(curve: Any, name: str) -> None:
    if type(curve).__name__ not in _TRACERS or not curve.IsValid or curve.Dimension != 3:
        way_out = "Convert it to a curve, explode blocks, or move it to another layer."
        _refuse("OBJECT", name, type(curve).__name__, f"valid {', '.join(_TRACERS)} in space", way_out)


def _line(curve: Any, base: Floats, _: str) -> list[Shape]:
    return [Shape(Line, np.array([_point(curve.Line.From), _point(curve.Line.To)]) - base)]


def _polyline(curve: Any, base: Floats, _: str) -> list[Shape]:
    points = np.array([_point(curve.Point(k)) for k in range(curve.PointCount)]) - base
    return [Shape(Line, points[k : k + 2]) for k in range(len(points) - 1)]


def _arc(curve: Any, base: Floats, _: str) -> list[Shape]:
    arc = curve.Arc
    centre = _point(arc.Plane.Origin) - base
    axes = np.array([_point(arc.Plane.XAxis), _point(arc.Plane.YAxis)])
    tips = np.vstack([centre, centre + arc.Radius * axes])
    return [Shape(Ellipse, tips, (float(arc.StartAngle), float(arc.EndAngle)))]


def _nurbs(curve: Any, base: Floats, name: str) -> list[Shape]:
    """Take the spline over: its points are homogeneous, its knots lack the first and the last, which have no effect."""
    rows = [curve.Points[k] for k in range(len(curve.Points))]
    points = np.array([[row.X, row.Y, row.Z, row.W] for row in rows])
    knots = np.array(list(curve.Knots), float)
    full = np.concatenate([knots[:1], knots, knots[-1:]])
    with np.errstate(all="ignore"):
        spline = Nurbs(curve.Degree, points[:, :3] / points[:, 3:] - base, points[:, 3], full)
    return shapes_of(tidied_segments(spline, name))


def _polycurve(curve: Any, base: Floats, name: str) -> list[Shape]:
    return [shape for k in range(curve.SegmentCount) for shape in _shapes(curve.SegmentCurve(k), base, name)]


def _point(point: Any) -> Floats:
    return np.array([point.X, point.Y, point.Z], float)


_TRACERS: dict[str, Callable[[Any, Floats, str], list[Shape]]] = {
    "ArcCurve": _arc,
    "LineCurve": _line,
    "NurbsCurve": _nurbs,
    "PolyCurve": _polycurve,
    "PolylineCurve": _polyline,
}
"""Class of a Rhino curve to the function that traces it, in the direction it is drawn."""

RHINO_CURVES = frozenset(_TRACERS)
"""The classes that can be read."""


def _refuse(what: str, field: str, found: str, limit: str, way_out: str) -> Any:
    raise Refused(code=f"E-RHINO-{what}", field=field, found=found, limit=limit, way_out=way_out)
