"""What was asked and decided, as plain data for `model/design.json`: what a verifier cannot see in the mesh."""

import math
from typing import Any

from isomould.arrays import Floats
from isomould.curves.curve import PlanarCurve
from isomould.curves.space_curve import SpatialCurve
from isomould.design import Design
from isomould.form.assemble import RailInSpace
from isomould.form.polygon import CurvePolygon, Role
from isomould.form.profile import Caps
from isomould.form.spatial import SpatialPolygon
from isomould.form.trim import make_cut
from isomould.nesting.settings import StockSettings
from isomould.parts.catalogue import AnySection, PlateSection
from isomould.parts.settings import BasePlateSettings


def describe_design(design: Design, stock: StockSettings) -> dict[str, Any]:
    """Give the content of `model/design.json`; lengths in mm, angles in rad."""
    project = design.project
    return {
        "schema": 1,
        "kind": project.surface.kind,
        "offset": design.form.surface.profile.offset,
        **_describe_rail(design),
        "generatrix": _describe_line(design.generatrix, design.form.generatrix),
        **_trim(design),
        **_caps(design),
        "ends": project.rail.ends or ("mitred" if project.surface.kind == "edge-offset" else "square"),
        "member": _member(design),
        "node": _node(design),
        "panel": _panel(design),
        "limits": {
            "max_deviation_mm": project.tolerances.max_deviation,
            "min_member_mm": project.tolerances.min_member,
        },
        "tolerances": {"length_mm": project.tolerances.length, "angle_deg": project.tolerances.angle_deg},
        "nesting": {
            "gap_mm": stock.gap,
            "kerf_mm": stock.kerf,
            "trim_mm": stock.trim,
            "guillotine": stock.guillotine,
            "bar_kerf_mm": stock.bar_kerf,
            "bar_trim_mm": stock.bar_trim,
        },
        "layers": dict(project.deliver.layers),
        "drawings": project.deliver.drawings,
        "solids": list(project.deliver.solids),
        "parquet": project.deliver.parquet,
        "dxf": list(project.deliver.dxf),
        "nc1": _nc1(design),
        "labels": project.deliver.labels,
        "datum": project.project.datum.model_dump(),
        "counts": _counts(design),
        "shapes": [shape.slug for shape in project.shapes],
    }


def _describe_rail(design: Design) -> dict[str, Any]:
    """Give rail and plane; a rail in space has no plane, but a direction up."""
    drawn = design.rail
    line = _describe_line(drawn.curve, design.form.rail)
    if isinstance(drawn, RailInSpace):
        return {"plane": None, "up": drawn.up.tolist(), "rail": line}
    plane = {name: getattr(drawn.plane, name).tolist() for name in ("origin", "x_axis", "y_axis")}
    return {"plane": plane, "rail": line}


def _trim(design: Design) -> dict[str, Any]:
    """Planes by a point and the unit normal towards what was kept; nothing for a surface that was not trimmed."""
    asked = design.project.surface
    cuts = [make_cut(table, number) for number, table in enumerate(asked.trim)]
    planes = [{"origin": cut.origin.tolist(), "normal": cut.normal.tolist()} for cut in cuts]
    return {"trim": planes, "sill": asked.sill} if planes else {}


def _caps(design: Design) -> dict[str, Any]:
    """Rows of panels without members beside them, and parallels under one panel; nothing if no pole is capped."""
    caps = design.form.surface.profile.caps
    return {"caps": {"rows": caps.rows, "lids": caps.lids}} if caps != Caps() else {}


def _describe_line(curve: PlanarCurve | SpatialCurve, polygon: CurvePolygon | SpatialPolygon) -> dict[str, Any]:
    return {
        "closed": polygon.closed,
        "curve": curve.describe(),
        "vertices": polygon.vertices.tolist(),
        "turning": _with_nulls(polygon.turning),
        "deviation_mm": polygon.deviation,
        **(_describe_chords(polygon) if isinstance(polygon, SpatialPolygon) else _describe_edges(polygon)),
    }


def _describe_edges(polygon: CurvePolygon) -> dict[str, Any]:
    edges = polygon.edges
    contacts = zip(edges.role, edges.piece.tolist(), edges.parameter.tolist(), strict=True)
    return {
        "directions": edges.direction.tolist(),
        "declared": polygon.angle,
        "edges": [
            {"role": role.value, "contact": None if role is Role.GAP else [piece, t]} for role, piece, t in contacts
        ],
    }


def _describe_chords(polygon: SpatialPolygon) -> dict[str, Any]:
    """Give the edges of a rail in space: no angle says their directions."""
    contacts = zip(polygon.piece.tolist(), polygon.parameter.tolist(), strict=True)
    edges = [{"role": Role.CHORD.value, "contact": [piece, t]} for piece, t in contacts]
    return {"directions": None, "declared": None, "edges": edges}


def _with_nulls(values: Floats) -> list[float | None]:
    return [None if math.isnan(value) else value for value in values.tolist()]


def _member(design: Design) -> dict[str, Any]:
    asked, shapes = design.project.members, design.kit.members.shapes
    used = {shape.section.name: shape.section for shape in shapes}
    return {
        "depth": asked.section.depth,
        "density_kg_m3": asked.density,
        "sections": {name: _section(used[name]) for name in sorted(used)},
    }


def _section(section: AnySection) -> dict[str, Any]:
    if isinstance(section, PlateSection):
        return {"kind": "plate", "depth": section.depth, "thickness": section.thickness}
    outer, inner = section.radii
    walls = {"wall": section.wall, "outer_radius": outer, "inner_radius": inner}
    return {"kind": "rhs", "depth": section.depth, "width": section.width, **walls}


def _node(design: Design) -> dict[str, Any]:
    asked, joint = design.project.nodes, design.kit.joints[0]
    return {
        "detail": asked.detail,
        "density_kg_m3": asked.density,
        "drum_diameter_mm": joint.diameter,
        "bore_mm": joint.bore,
        "min_web_mm": asked.min_web,
        "min_core_mm": asked.min_core,
        **joint.sizes,
        "base_plate": _base_plate(asked.base_plate),
    }


def _base_plate(asked: BasePlateSettings | None) -> dict[str, Any] | None:
    if asked is None:
        return None
    return {
        "thickness_mm": asked.thickness,
        "stem_thickness_mm": asked.stem_thickness,
        "holes": asked.holes,
        "hole_diameter_mm": asked.hole_diameter,
        "edge_distance_mm": asked.edge_distance,
        "clearance_mm": asked.clearance,
    }


def _nc1(design: Design) -> dict[str, str]:
    """Order, drawing and phase of NC1 files, the units of their mass, and the grade of plates."""
    project = design.project
    info, deliver = project.project, project.deliver
    units = {"mass": deliver.mass_unit("bar"), "plate_mass": deliver.mass_unit("plate")}
    grade = project.members.grade
    return {"order": info.number, "drawing": info.drawing, "phase": info.phase, "grade": grade, **units}


def _panel(design: Design) -> dict[str, Any]:
    asked = design.project.panels
    return {
        "thickness_mm": asked.thickness,
        "density_kg_m3": asked.density,
        "gap_mm": asked.gap,
        "underside_mm": design.kit.panels.underside,
        "makeup": asked.makeup,
        "min_bearing_mm": asked.min_bearing,
        "smallest_bearing_mm": float(design.kit.panels.bearing.min()),
        "flippable": asked.flippable,
        "coating": asked.coating,
        "orientation_mark": asked.orientation_mark,
    }


def _counts(design: Design) -> dict[str, int]:
    mesh = design.kit.mesh
    return {
        "parallels": mesh.shape[0],
        "generatrices": mesh.shape[1],
        "nodes": len(mesh.nodes),
        "edges": len(mesh.edges),
        "faces": len(mesh.face_ij),
    }
