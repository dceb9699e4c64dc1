"""Three offsets of one surface: faces, nodes or edges at a constant distance (geometry §4, paper §3.4–3.6).

Each is `V + t·O` with a parallel mesh `O = a·A + b·C`: what is sought are the numbers (a_i, b_i) of the profile.
"""

from dataclasses import replace
from typing import Literal

import numpy as np

from isomould.arrays import Floats
from isomould.errors import Refused
from isomould.form.assemble import Form
from isomould.form.polygon import CurvePolygon
from isomould.form.profile import Profile, face_offset
from isomould.form.surface import Surface, make_surface, stretch

Constant = Literal["face", "vertex", "edge"]
"""What keeps its distance."""


def offset_surface(form: Form, constant: Constant, distance: float, field: str = "deliver.double_layer") -> Surface:
    """Give the surface at a distance (mm, positive to the outside) with all edges parallel to the first one's.

    Raises
    ------
    Refused
        If the design has no such offset, or an edge would flip.
    """
    surface, (a, b) = form.surface, offset_field(form, constant, field)
    profile = surface.profile
    field_of = replace(profile, a=a, b=b, d=profile.d + distance * a, z=profile.z + distance * b)
    moved = replace(field_of, lengths=profile.lengths + distance * stretch(field_of))
    result = make_surface(surface.rail, moved)
    _refuse_flip(surface, result, distance, field)
    return result


def offset_field(form: Form, constant: Constant, field: str = "deliver.double_layer") -> tuple[Floats, Floats]:
    """Give (a, b), each (m,), of the offset field (geometry §4).

    Raises
    ------
    Refused
        For vertices if the rail's turning angle varies or the profile is closed; for edges if the design is no
        edge offset mesh.
    """
    profile = form.surface.profile
    if constant == "face":
        return face_offset(form.generatrix, profile.latitude)
    if constant == "edge":
        return _refuse_no_edge_offset(profile, field)
    _refuse_no_vertex_offset(form, field)
    return _vertex_offset(profile, _angle(form) or 0.0)


def _angle(form: Form) -> float | None:
    return form.rail.angle if isinstance(form.rail, CurvePolygon) else None


def _vertex_offset(profile: Profile, angle: float) -> tuple[Floats, Floats]:
    """`a = c·cos ψ`, `b = sin ψ` with ψ_{i+1} = 2 m_i − ψ_i and ψ_0 by least squares at the inner vertices."""
    c = np.cos(angle / 2)
    m = profile.latitude + np.arctan2(
        np.sin(profile.latitude) * (1 - c) * np.cos(profile.latitude),
        c * np.cos(profile.latitude) ** 2 + np.sin(profile.latitude) ** 2,
    )
    sign = (-1.0) ** np.arange(len(m) + 1)
    walk = np.concatenate([[0.0], sign[1:] * np.cumsum(-2 * sign[:-1] * m)])
    middle = (m[1:] + m[:-1]) / 2
    start = float(np.mean(sign[1:-1] * (middle - walk[1:-1])))
    psi = walk + sign * start
    return c * np.cos(psi), np.sin(psi)


def _refuse_no_edge_offset(profile: Profile, field: str) -> tuple[Floats, Floats]:
    if profile.offset != "edge":
        raise Refused(
            "E-OFFSET-EDGE",
            f"{field}.offset",
            "'edge' for a mesh whose edges have no offset at a constant distance",
            "surface.kind = 'edge-offset'",
            "Use that kind with generatrix.divide = {phase = 'centre'}, or offset = 'face'.",
        )
    return profile.a, profile.b


def _refuse_no_vertex_offset(form: Form, field: str) -> None:
    if _angle(form) is None or form.surface.profile.closed or len(form.surface.profile.latitude) < 2:
        raise Refused(
            "E-OFFSET-VERTEX",
            f"{field}.offset",
            "'vertex' for a rail that turns by different angles, a closed profile or a profile of one edge",
            "one turning angle |α| at all rail nodes and an open profile",
            "Divide the rail by nodes or angle_deg, or use offset = 'face'.",
        )


def _refuse_flip(surface: Surface, moved: Surface, distance: float, field: str) -> None:
    """Refuse offsets at which an edge vanishes or flips, naming the distance at which the first one does."""
    closed = surface.profile.closed, surface.rail.closed
    shares = [_share(*(_edges(each.V, axis, closed[axis]) for each in (surface, moved))) for axis in (0, 1)]
    if min(shares) > 1:
        return
    family = ("generatrix", "parallel")[int(np.argmin(shares))]
    raise Refused(
        "E-OFFSET-FLIP",
        f"{field}.distance",
        f"{distance:g} mm, at which {family} edges flip",
        f"nearer than {distance * min(shares):.3f} mm",
        "Lower the distance, or offset to the other side.",
    )


def _edges(nodes: Floats, axis: int, closed: bool) -> Floats:
    """Edges of nodes (m, n, 3) along an axis, that from the last to the first with them where it is closed."""
    edges = np.roll(nodes, -1, axis=axis) - nodes
    return edges if closed else np.delete(edges, -1, axis=axis)


def _share(edges: Floats, moved: Floats) -> float:
    """Share of the way from edges to moved ones, parallel to them, at which the first of them vanishes."""
    whole, left = (np.einsum("ijk,ijk->ij", edges, each) for each in (edges, moved))
    shrinking = left < whole
    return float((whole[shrinking] / (whole - left)[shrinking]).min(initial=np.inf))
