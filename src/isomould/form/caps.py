"""Caps: flat panels that close a surface over its poles, where no member leads (geometry §5, paper §4.3, Fig. 17).

Between the last parallels on the two sides of a pole a ring of trapezoids closes the gap. Where one last parallel goes
round the pole, it is the outline of a single flat panel, a **lid**.
"""

import numpy as np

from isomould.arrays import Floats, Ints
from isomould.errors import Note, Refused
from isomould.form.poles import Strips, half_of
from isomould.form.polygon import FLAT, CurvePolygon, unit
from isomould.form.profile import Caps

_FIELD = "surface.pole"


def find_caps(strips: Strips, polygon: CurvePolygon, rail: CurvePolygon, min_member: float) -> Caps:
    """Tell what closes the poles that a generatrix passes or ends at.

    Parameters
    ----------
    strips, polygon
        The stretches of the generatrix between poles, and the polygon that they were chained to.
    rail
        The divided rail.
    min_member
        mm: no cap is narrower.

    Raises
    ------
    Refused
        If the generatrix ends at a pole without a last parallel that goes round it, or if a cap would be too narrow.
    """
    rows = tuple(np.flatnonzero(polygon.gap).tolist())
    ends = (0, len(polygon.vertices) - 1)
    if strips.closed:
        caps = Caps((*rows, ends[1]), ())
    else:
        caps = Caps(rows, tuple(end for end, cut in zip(ends, strips.cut, strict=True) if cut))
        for end, strip in zip(ends, (strips.spans[0], strips.spans[-1]), strict=True):
            if end in caps.lids and not (half_of(strip) == 0 and _goes_round(rail)):
                _refuse_lid(rail)
    _refuse_narrow(polygon, caps, min_member)
    return caps


def cap_notes(caps: Caps, rail: CurvePolygon) -> tuple[Note, ...]:
    """Say what closes the poles."""
    count = len(rail.lengths)
    found = [f"{len(caps.rows) * count} trapezoids"] if caps.rows else []
    found += [f"{len(caps.lids)} of {count} sides"] if caps.lids else []
    text = f"panels without members between them close poles: {' and '.join(found)}"
    return (Note("W-SURFACE-CAP", _FIELD, text),) if found else ()


def _goes_round(rail: CurvePolygon) -> bool:
    """Whether the rail's parallels are the outlines of convex panels that lie inside them."""
    return rail.closed and bool((rail.turning > FLAT).all())


def _refuse_lid(rail: CurvePolygon) -> None:
    raise Refused(
        "E-SURFACE-CAP",
        _FIELD,
        "'cap', but the generatrix ends at a pole, and its last parallel is no outline of a convex panel over it"
        if rail.closed
        else "'cap', but the generatrix ends at a pole, and the last parallel of an open rail does not go round it",
        "a generatrix that goes on behind the pole, or a convex closed rail that it leads inwards from",
        "Draw the generatrix on, end it before surface.min_pole_angle_deg, or leave a gap: surface.pole = 'open'.",
    )


def _refuse_narrow(polygon: CurvePolygon, caps: Caps, min_member: float) -> None:
    """Refuse caps that run backwards or are narrower than a member is long."""
    rows = np.array(caps.rows, dtype=np.int64)
    if not len(rows):
        return
    width = _widths(polygon, rows)
    if width.min() < min_member:
        raise Refused(
            "E-SURFACE-CAP",
            _FIELD,
            f"'cap', but parallel {rows[np.argmin(width)]} and the next, beyond a pole, are {width.min():.3f} mm apart",
            f"tolerances.min_member = {min_member:g} mm",
            "Raise surface.min_pole_angle_deg, so that fewer rows lead to the pole.",
        )


def _widths(polygon: CurvePolygon, rows: Ints) -> Floats:
    """Widths (r,) mm of caps, in the direction half-way between those of the edges on their two sides."""
    count = len(polygon.vertices)
    before, after = polygon.edges.direction[rows - 1], polygon.edges.direction[(rows + 1) % count]
    between = unit(before) + unit(after)
    step = polygon.vertices[(rows + 1) % count] - polygon.vertices[rows]
    return np.einsum("ij,ij->i", step, between) / np.linalg.norm(between, axis=1)
