"""Curves drawn in CAD: the way from what is drawn to one curve."""

from pathlib import Path
from typing import NoReturn

import numpy as np
from scipy.spatial import KDTree

from isomould.arrays import Floats
from isomould.curves.chains import Chain, P, Stroke, tips_of
from isomould.curves.doubles import overlapping, without_doubles
from isomould.curves.drawn_settings import DrawnSettings, DxfSettings
from isomould.curves.dxf import open_dxf_source
from isomould.curves.joining import join_tolerance, joined, place_text
from isomould.curves.layers import LayerDrawing
from isomould.curves.origins import origin_of, seen_from
from isomould.curves.plane import Plane
from isomould.curves.rhino import open_rhino_source
from isomould.curves.shapes import Draft
from isomould.curves.smoothing import smoothed
from isomould.curves.spatial import laid_flat
from isomould.errors import Note, Refused


def read_drawn(settings: DrawnSettings, base_dir: Path, plane: Plane | None, field: str) -> Draft:
    """Read the one planar curve that a table names.

    Raises
    ------
    Refused
        As `open_source`, `Source.trace`, `laid_flat` and `joined`; E-DRAWN-PLANE without a plane to project on,
        E-DRAWN-CURVES for more than one curve, or one that is drawn twice or turns back on itself.
    OutputFault
        If the system does not let the file be read.
    """
    if settings.drawn == "world" and plane is None:
        raise Refused(
            code="E-DRAWN-PLANE",
            field=f"{field}.drawn",
            found='"world" for a curve without a plane',
            limit="a plane to project on",
            way_out='Give the plane, or draw the curve flat and set drawn = "flat".',
        )
    drawing = trace_drawn(settings, base_dir, field)
    origin = origin_of(drawing.traced)
    join = join_tolerance(settings.join, drawing.printed)
    ground, offset = _seen_from(plane, origin) if settings.drawn == "world" and plane else (None, origin[:2])
    strokes, flattened = laid_flat(seen_from(drawing.traced, origin), ground, field, join)
    chain, moved = the_one_chain(strokes, join, field)
    pieces, smooth = smoothed(chain.pieces, chain.closed, join, field)
    away = (float(offset[0]), float(offset[1]))
    return Draft(pieces, chain.closed, (*drawing.notes, *flattened, *moved, *smooth), away)


def trace_drawn(settings: DrawnSettings, base_dir: Path, field: str) -> LayerDrawing:
    """Give what a table names as shapes in space, mm, object by object, with all notes so far."""
    path = base_dir / settings.file
    if isinstance(settings, DxfSettings):
        dxf = open_dxf_source(path, settings.units, field)
        drawing = dxf.trace(settings.layer)
        return drawing._replace(notes=(*dxf.notes, *drawing.notes))
    model = open_rhino_source(path, settings.units, field)
    drawing = model.trace(settings.layer, name=settings.name)
    return drawing._replace(notes=(*model.notes, *drawing.notes))


def the_one_chain(strokes: list[Stroke[P]], join: float, field: str) -> tuple[Chain[P], tuple[Note, ...]]:
    """Join strokes to the one curve that they form.

    Raises
    ------
    Refused
        E-DRAWN-CURVES if they form none or several, are drawn twice, or turn back.
    """
    _refuse_doubled(strokes, join, field)
    chains, notes = joined(strokes, join, field)
    first = next(iter(chains), None)
    if first is None:
        _refuse("only points", "one curve", "Draw a curve on the layer.", field)
    if len(chains) > 1:
        _refuse_several(chains, join, field)
    _refuse_turning_back(first, field)
    return first, notes


def _seen_from(plane: Plane, origin: Floats) -> tuple[Plane, Floats]:
    """Give the plane as seen from an origin (3,), its own moved near it, and by how much in its coordinates."""
    if not origin.any():
        return plane, np.zeros(2)
    axes = np.column_stack([plane.x_axis, plane.y_axis])
    offset = (origin - plane.origin) @ axes
    return Plane(plane.origin - origin + axes @ offset, plane.x_axis, plane.y_axis), offset


def _refuse_doubled(strokes: list[Stroke[P]], join: float, field: str) -> None:
    _, doubled = without_doubles(strokes, join)
    if doubled:
        kept, copy = doubled[0]
        more = f", and {len(doubled) - 1} more" if len(doubled) > 1 else ""
        way_out = "Delete what is drawn twice, such as by OVERKILL in AutoCAD or SelDup in Rhino."
        _refuse(f"{kept} and {copy} lie on each other{more}", "each entity once", way_out, field)


def _refuse_several(chains: tuple[Chain[P], ...], join: float, field: str) -> None:
    listed = "; ".join(_listed(chain.names) for chain in chains[:_NAMED]) + ("; …" if len(chains) > _NAMED else "")
    found = f"{len(chains)} curves ({listed}); their nearest ends are {_nearest_gap(chains):.6g} mm apart"
    doubled = overlapping([stroke for chain in chains for stroke in chain.strokes], join)
    if doubled:
        found += f"; {doubled[0][0]} and {doubled[0][1]} lie on each other"
    way_out = f"Keep one curve on the layer, its entities joined end to end within {join:g} mm (join)."
    _refuse(found, "one curve", way_out, field)


_NAMED = 8


def _listed(names: tuple[str, ...]) -> str:
    return ", ".join(names[:_NAMED]) + (f" and {len(names) - _NAMED} more" if len(names) > _NAMED else "")


def _nearest_gap(chains: tuple[Chain[P], ...]) -> float:
    first, *others = [tips_of([chain.strokes[0], chain.strokes[-1]])[[0, 1], [0, 1]] for chain in chains]
    return float(np.min(KDTree(first).query(np.concatenate(others))[0]))


def _refuse_turning_back(chain: Chain[P], field: str) -> None:
    """Refuse a curve that goes back along itself, where a copy lies on it or a line was drawn inside another."""
    pieces = chain.pieces
    names = [stroke.name for stroke in chain.strokes for _ in stroke.pieces]
    pairs = [(k, (k + 1) % len(pieces)) for k in range(len(pieces) - (not chain.closed))]
    for before, after in pairs:
        arriving = pieces[before].derivative(np.ones(1))[0]
        leaving = pieces[after].derivative(np.zeros(1))[0]
        size = float(np.linalg.norm(arriving) * np.linalg.norm(leaving))
        if size and float(arriving @ leaving) < -size * np.cos(_TURNED_BACK):
            place = place_text(pieces[after].point(np.zeros(1))[0])
            both = names[before] if names[before] == names[after] else f"{names[before]} and {names[after]}"
            way_out = "Delete what lies on another entity, or draw it once."
            _refuse(f"the curve turns back on itself at ({place}): {both}", "a curve that goes on", way_out, field)


_TURNED_BACK = 1e-4
"""Directions this near to opposite turn back, rad."""


def _refuse(found: str, limit: str, way_out: str, field: str) -> NoReturn:
    raise Refused("E-DRAWN-CURVES", field, found, limit, way_out)
