"""V1-V4: every panel is a plane convex quadrilateral with two parallel sides (geometry §3)."""

import numpy as np

from isomould.verify.delivery import Delivery
from isomould.verify.grid import grid_of, whole_faces
from isomould.verify.read.mesh import faces_by_size
from isomould.verify.rules import Floats, Ints, Measured, NotApplicable, Rule, faults, worse, worst_of

LENGTH = 1e-6
EQUAL_TURNING = 1e-11
PARALLEL = 1e-10


def planarity(delivery: Delivery) -> Measured:
    """Distance of the other vertices from the plane of the widest three consecutive ones."""
    mesh = delivery.mesh
    groups = [(faces, mesh.nodes[corners]) for faces, corners in faces_by_size(mesh)]
    limit = max(LENGTH, 1e-9 * max(float(np.ptp(points, axis=1).max()) for _, points in groups)) + delivery.seam[0]
    found = [worst_of(_off_plane(points), mesh.face_location[faces], limit=limit) for faces, points in groups]
    return worse(*found)


def _off_plane(points: Floats) -> Floats:
    crosses = np.cross(points - np.roll(points, 1, axis=1), np.roll(points, -1, axis=1) - points)
    areas = np.linalg.norm(crosses, axis=2)
    rows, widest = np.arange(len(points)), areas.argmax(axis=1)
    normal = crosses[rows, widest] / areas[rows, widest][:, None]
    return abs(((points - points[rows, widest][:, None]) * normal[:, None]).sum(axis=2)).max(axis=1)


def parallels(delivery: Delivery) -> Measured:
    """Sine of the angle between the two sides that follow the rail."""
    faces, points = _quads(delivery)
    a, c = points[:, 1] - points[:, 0], points[:, 2] - points[:, 3]
    sine = np.linalg.norm(np.cross(a, c), axis=1) / np.linalg.norm(a, axis=1) / np.linalg.norm(c, axis=1)
    opposed = np.where((a * c).sum(axis=1) > 0, sine, 1.0)
    return worst_of(opposed, delivery.mesh.face_location[faces], limit=PARALLEL + delivery.seam[1])


def _quads(delivery: Delivery) -> tuple[Ints, Floats]:
    faces, corners = whole_faces(delivery.mesh, grid_of(delivery.mesh, delivery.design))
    return faces, delivery.mesh.nodes[corners]


def isosceles(delivery: Delivery) -> Measured:
    """Difference of the legs, of the diagonals, and distance of a corner from the circle of the others."""
    if delivery.design.plane is None:
        raise NotApplicable("a spatial rail has no turning angles of one plane")
    faces, points = _quads(delivery)
    turning = delivery.design.rail.turning
    strips = delivery.mesh.face_ij[faces, 1]
    alike = abs(turning[strips] - np.roll(turning, -1)[strips]) <= EQUAL_TURNING  # NaN at open ends: not alike
    found = _asymmetry(points[alike])
    names = delivery.mesh.face_location[faces[alike]]
    return worst_of(found, names, none="no strip lies between rail nodes of the same signed angle")


def _asymmetry(points: Floats) -> Floats:
    a, b, c, d = np.moveaxis(points, 1, 0)
    legs = np.linalg.norm(d - a, axis=1) - np.linalg.norm(c - b, axis=1)
    diagonals = np.linalg.norm(c - a, axis=1) - np.linalg.norm(d - b, axis=1)
    return np.max(abs(np.stack((legs, diagonals, _off_circle(a, b, c, d)))), axis=0)


def _off_circle(a: Floats, b: Floats, c: Floats, d: Floats) -> Floats:
    u, v = b - a, c - a
    normal = np.cross(u, v)
    uu, vv, nn = ((w * w).sum(axis=1)[:, None] for w in (u, v, normal))
    centre = (vv * np.cross(normal, u) + uu * np.cross(v, normal)) / (2 * nn)
    return np.linalg.norm(d - a - centre, axis=1) - np.linalg.norm(centre, axis=1)


def convexity(delivery: Delivery) -> Measured:
    """Faces that are not convex, simple (turning once) and counter-clockwise against their node axes."""
    mesh = delivery.mesh
    problems: list[str] = []
    for faces, corners in faces_by_size(mesh):
        good = _is_sound(mesh.nodes[corners], mesh.node_axes[corners])
        problems += list(mesh.face_location[faces[~good]])
    return faults(len(mesh.face_ij), problems)


def _is_sound(points: Floats, axes: Floats) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    into, out = points - np.roll(points, 1, axis=1), np.roll(points, -1, axis=1) - points
    corner = np.cross(into, out)
    normal = corner.sum(axis=1)
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    sine, cosine = (corner * normal[:, None]).sum(axis=2), (into * out).sum(axis=2)
    once = abs(np.arctan2(sine, cosine).sum(axis=1) - 2 * np.pi) < 1e-9
    outside = ((axes * normal[:, None]).sum(axis=2) > 0).all(axis=1)
    return (sine > 0).all(axis=1) & once & outside


RULES = (
    Rule("V1", "panels are plane", LENGTH, "mm", planarity),
    Rule("V2", "panels are trapezoids", PARALLEL, "sin", parallels),
    Rule("V3", "panels between equal rail nodes are isosceles and concyclic", LENGTH, "mm", isosceles),
    Rule("V4", "panels are simple, convex, counter-clockwise from outside", 0, "panels", convexity),
)
