"""Pictures of a kit: axonometry, plan and elevation by painter's order, and the developed strips."""

import numpy as np

from isomould.arrays import Floats, Ints
from isomould.documents.camera import Camera, make_camera
from isomould.documents.picture import Caption, Dot, Frame, Item, Picture, Shape, blend, colour, fit
from isomould.documents.surroundings import compass
from isomould.documents.viewing import SpaceView
from isomould.errors import Refused
from isomould.form.mesh import Mesh, NodeKind
from isomould.parts.arms import normalised
from isomould.parts.kit import Kit
from isomould.parts.strips import Strip, unroll_strips
from isomould.ties import FINE, in_order

WIDTH, MARGIN, FOOT = 960.0, 24.0, 30.0
_INSIDE, _OUTSIDE, _SHADE = "#e9dfc9", "#fbfcfd", "#8fa3b5"
_LIGHT = np.array([0.35, -0.55, 0.76])


def space_picture(
    kit: Kit, name: str, view: SpaceView, camera: Camera | None = None, north_deg: float = 0.0
) -> Picture:
    """Give the mesh seen from far away: panels from back to front, nodes coloured by class, axes and north.

    Outsides of panels are white, insides sand-coloured.

    Parameters
    ----------
    camera
        That of the view, if None.
    north_deg
        Angle of the project's x axis from the site's (east), counter-clockwise.
    """
    camera = camera or make_camera(view)
    eye = camera.eye
    flat, depth = camera.flat(kit.mesh.nodes), camera.depth(kit.mesh.nodes)
    frame = fit(flat, WIDTH, MARGIN, FOOT)
    placed = frame.place(flat)
    near = np.maximum.reduceat(depth[kit.mesh.faces], kit.mesh.face_offsets[:-1])
    middle = np.add.reduceat(depth[kit.mesh.faces], kit.mesh.face_offsets[:-1]) / np.diff(kit.mesh.face_offsets)
    items: list[Item] = [*_panels(kit.mesh, placed, eye), *_dots(kit, placed, frame)]
    order = in_order(np.concatenate([middle, _in_front(kit.mesh, depth, near)]))
    axes = compass(camera, (WIDTH - 60.0, FOOT), north_deg)
    return Picture(f"{name}, {view}", WIDTH, frame.height, (*(items[k] for k in order), _caption(kit, name), *axes))


def developed_picture(kit: Kit, name: str) -> Picture:
    """Give the strips between generatrices unrolled into the plane, side by side (paper §3.3).

    Raises
    ------
    Refused
        If the mesh is no whole grid of trapezoids.
    """
    _refuse_ragged(kit.mesh)
    strips = [_upwards(strip) for strip in unroll_strips(kit.mesh, "generatrix")]
    quads = np.concatenate(_side_by_side(strips))
    frame = fit(quads.reshape(-1, 2), WIDTH, MARGIN, FOOT)
    of = kit.panels.classes.of.reshape(-1, len(strips)).T.ravel()
    shapes = [
        Shape(frame.place(quad), True, blend(colour(number), "#ffffff", 0.55), width=0.4)
        for quad, number in zip(quads, of.tolist(), strict=True)
    ]
    return Picture(f"{name}, developed strips", WIDTH, frame.height, (*shapes, _caption(kit, name)))


def _panels(mesh: Mesh, placed: Floats, eye: Floats) -> list[Shape]:
    corner = [mesh.nodes[mesh.faces[mesh.face_offsets[:-1] + k]] for k in range(3)]
    normal = normalised(np.cross(corner[1] - corner[0], corner[2] - corner[0]))
    outside, light = normal @ eye >= -FINE, normal @ _LIGHT
    share = np.clip(0.5 - 0.5 * np.where(outside, light, -light), 0.0, 1.0)
    fills = [blend(_OUTSIDE if out else _INSIDE, _SHADE, s) for out, s in zip(outside, share.tolist(), strict=True)]
    outlines = np.split(placed[mesh.faces], mesh.face_offsets[1:-1])
    return [Shape(points, True, fill, width=0.5) for points, fill in zip(outlines, fills, strict=True)]


def _dots(kit: Kit, placed: Floats, frame: Frame) -> list[Dot]:
    """Nodes coloured by class; those of the boundary are small."""
    spacing = frame.scale * float(np.median([shape.system_length for shape in kit.members.shapes]))
    radius = np.where(kit.mesh.kind == NodeKind.BOUNDARY, 0.09, 0.13) * min(spacing, 26.0)
    fills = [colour(number) for number in kit.nodes.classes.of.tolist()]
    return [Dot((float(x), float(y)), float(r), fill) for (x, y), r, fill in zip(placed, radius, fills, strict=True)]


def _in_front(mesh: Mesh, depth: Floats, near: Floats) -> Floats:
    """Depth (n,) at which nodes are painted: just in front of the panels that they touch."""
    result, face = depth.copy(), np.repeat(np.arange(len(near)), np.diff(mesh.face_offsets))
    middle = np.add.reduceat(depth[mesh.faces], mesh.face_offsets[:-1]) / np.diff(mesh.face_offsets)
    np.maximum.at(result, mesh.faces, middle[face])
    return result


def _upwards(strip: Strip) -> Floats:
    """Corners (k, 4, 2) of a strip's panels, the walk along it turned upwards."""
    left, right = (np.stack([-side[:, 1], side[:, 0]], axis=-1) for side in (strip.left, strip.right))
    return np.stack([left[:-1], right[:-1], right[1:], left[1:]], axis=1)


def _side_by_side(strips: list[Floats]) -> list[Floats]:
    """Move strips (k, 4, 2) to the right, one beside the other."""
    gap = 0.01 * max(float(np.ptp(strip[..., 1])) for strip in strips)
    width = np.array([np.ptp(strip[..., 0]) for strip in strips]) + gap
    place = np.concatenate([[0.0], np.cumsum(width)[:-1]])
    return [strip + np.array([x - strip[..., 0].min(), 0.0]) for strip, x in zip(strips, place.tolist(), strict=True)]


def _refuse_ragged(mesh: Mesh) -> None:
    cells = (mesh.shape[0] - (not mesh.closed[0])) * (mesh.shape[1] - (not mesh.closed[1]))
    if len(mesh.nodes) != mesh.shape[0] * mesh.shape[1] or len(mesh.faces) != 4 * cells:
        raise Refused(
            "E-DRAW-DEVELOPED",
            "--view developed",
            "a trimmed or capped mesh",
            "a whole grid of trapezoids",
            "Draw it untrimmed, or choose another view.",
        )


def _caption(kit: Kit, name: str) -> Caption:
    return Caption(f"{name}: {counts_text(kit)}", (MARGIN, 0.45 * FOOT), 13.0)


def counts_text(kit: Kit) -> str:
    """Say how many parts of how many kinds there are."""
    counts: list[tuple[str, int, Ints]] = [
        ("nodes", len(kit.nodes.marks), kit.nodes.classes.of),
        ("members", len(kit.members.marks), kit.members.classes.of),
        ("panels", len(kit.panels.marks), kit.panels.classes.of),
    ]
    return ", ".join(f"{len(of)} {word} of {classes} kinds" for word, classes, of in counts)
