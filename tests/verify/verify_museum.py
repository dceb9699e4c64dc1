"""Small good things to prove: meshes by the product formula, and deliveries that hold given values."""

import csv
import io
from dataclasses import replace
from pathlib import Path

import numpy as np

from isomould.verify.delivery import Delivery
from isomould.verify.read.design import Design, Line
from isomould.verify.read.mesh import Mesh
from isomould.verify.read.tables import Table
from isomould.verify.rules import judge

DEPTH = 200.0
DERIVED = ("folder", "final", "edge_slopes", "node_kinds")


def unit(theta):
    return np.stack([np.cos(theta), np.sin(theta)], axis=-1)


def tangent_line(centre, major, minor, theta, *, closed):
    """The tangent polygon of an elliptic arc with the directions θ; ends are feet of perpendiculars."""
    phi = np.unwrap(np.arctan2(-np.cos(theta) * minor, np.sin(theta) * major))
    start, end = (phi[0], phi[0] + 2 * np.pi) if closed else (phi[0], phi[-1])
    points = np.array(centre) + np.stack([major * np.cos(phi), minor * np.sin(phi)], axis=1)
    u = unit(theta)
    after_p, after_u = np.roll(points, -1, axis=0), np.roll(u, -1, axis=0)
    gap = after_p - points
    reach = (gap[:, 0] * after_u[:, 1] - gap[:, 1] * after_u[:, 0]) / (
        u[:, 0] * after_u[:, 1] - u[:, 1] * after_u[:, 0]
    )
    joints = points + reach[:, None] * u
    step = theta[1] - theta[0]
    if closed:
        vertices, turning = np.roll(joints, 1, axis=0), np.full(len(theta), step)
    else:
        vertices = np.vstack((points[:1], joints[:-1], points[-1:]))
        turning = np.array([np.nan, *np.full(len(theta) - 1, step), np.nan])
    piece = {
        "kind": "ellipse",
        "centre": list(centre),
        "major": [major, 0.0],
        "minor": [0.0, minor],
        "start": start,
        "end": end,
    }
    contacts = tuple((0, float((p - start) / (end - start))) for p in phi)
    return Line(closed, (piece,), vertices, theta, turning, float(step), ("tangent",) * len(theta), contacts)


def normals(line):
    u = unit(line.directions)
    return np.stack([u[:, 1], -u[:, 0]], axis=1)


def mitres(sides, *, closed):
    before = np.roll(sides, 1, axis=0) if closed else np.vstack((sides[:1], sides))
    after = sides if closed else np.vstack((sides, sides[-1:]))
    return (before + after) / (1 + (before * after).sum(axis=1))[:, None]


def product_mesh(design, koebe=None):
    rail, profile = design.rail, design.generatrix
    origin, x, y = design.plane
    world = np.array([x, y])
    R, A, C = (
        origin + rail.vertices @ world,
        mitres(normals(rail), closed=rail.closed) @ world,
        np.cross(x, y),
    )
    d, z = profile.vertices.T
    a, b = (mitres(normals(profile), closed=profile.closed) if koebe is None else koebe).T
    V = R + d[:, None, None] * A + z[:, None, None] * C
    axes = a[:, None, None] * A + b[:, None, None] * C
    axes /= np.linalg.norm(axes, axis=2)[..., None]
    return arrays(V, axes, (profile.closed, rail.closed))


def arrays(V, axes, closed):
    m, n = V.shape[:2]
    index = np.arange(m * n).reshape(m, n)
    i, j = (x.ravel() for x in np.indices((m, n)))
    up, along = (i < m - 1) | closed[0], (j < n - 1) | closed[1]

    def node(di, dj):
        return index[(i + di) % m, (j + dj) % n]

    generatrix, parallel = (
        np.stack((node(0, 0), node(1, 0)), 1)[up],
        np.stack((node(0, 0), node(0, 1)), 1)[along],
    )
    faces = np.stack((node(0, 0), node(0, 1), node(1, 1), node(1, 0)), 1)[up & along]

    def name(kind, keep):
        return np.array([f"{kind}-{a:02d}-{b:02d}" for a, b in zip(i[keep], j[keep], strict=True)])

    every = np.ones(m * n, dtype=bool)
    edges = np.vstack((generatrix, parallel))
    family = np.array(["generatrix"] * len(generatrix) + ["parallel"] * len(parallel))
    return Mesh(
        V.reshape(-1, 3),
        axes.reshape(-1, 3),
        np.stack((i, j), 1),
        np.array(["N01"] * m * n),
        name("N", every),
        edges,
        family,
        np.array(["M01"] * len(edges)),
        np.concatenate((name("MG", up), name("MP", along))),
        np.stack((i, j), 1)[up & along],
        np.array(["P01"] * len(faces)),
        name("P", up & along),
        faces.ravel(),
        np.arange(0, 4 * len(faces) + 1, 4),
    )


def raw_design(m, n, mesh):
    return {
        "member": {
            "depth": DEPTH,
            "density_kg_m3": 7850.0,
            "sections": {"FL200*12": {"kind": "plate", "depth": DEPTH, "thickness": 12.0}},
        },
        "limits": {"max_deviation_mm": None, "min_member_mm": 300.0},
        "tolerances": {"length_mm": 0.5, "angle_deg": 0.05},
        "node": {"detail": "slotted", "bore_mm": 20.0},
        "panel": {"thickness_mm": 12.0, "density_kg_m3": 2500.0},
        "nesting": {"gap_mm": 5.0, "kerf_mm": 3.0, "trim_mm": 20.0, "bar_kerf_mm": 3.0, "bar_trim_mm": 10.0},
        "counts": {
            "parallels": m,
            "generatrices": n,
            "nodes": len(mesh.nodes),
            "edges": len(mesh.edges),
            "faces": len(mesh.face_ij),
        },
    }


def holding(**parts):
    """A delivery whose files are given values."""
    delivery = Delivery(Path("nowhere"))
    vars(delivery).update(parts)
    return delivery


def deliver(kind, offset, rail, generatrix, koebe=None):
    plane = np.array([[1e4, -2e4, 3e3], [0.6, 0.8, 0.0], [-0.8 * 0.8, 0.6 * 0.8, 0.6]])
    design = Design(kind, offset, rail, generatrix, plane, {})
    mesh = product_mesh(design, koebe)
    raw = raw_design(len(generatrix.vertices), len(rail.vertices), mesh)
    return holding(mesh=mesh, design=replace(design, raw=raw))


def vault():
    """An open isogonal vault over an elliptic rail, its profile an elliptic arc, square ends."""
    rail = tangent_line((0, 0), 12e3, 9e3, np.linspace(0.3, 2.5, 12), closed=False)
    profile = tangent_line((-6e3, 0), 6e3, 7e3, np.linspace(0.9, 2.1, 8), closed=False)
    return deliver("isogonal", "face", rail, profile)


def ring():
    """A closed isogonal ring."""
    rail = tangent_line((100, 50), 12e3, 9e3, np.arange(24) * 2 * np.pi / 24 + 0.1, closed=True)
    profile = tangent_line((-2e3, 0), 2e3, 3e3, np.linspace(1.0, 2.0, 6), closed=False)
    return deliver("isogonal", "face", rail, profile)


def sphere():
    """An edge offset mesh: a closed circle rail of 24 and a circular profile on the Koebe lattice (geometry §5)."""
    rail = tangent_line((0, 0), 9e3, 9e3, np.arange(24) * 2 * np.pi / 24, closed=True)
    lam = 2 * np.arctan(np.tanh((np.arange(9) - 4) * np.arctanh(np.sin(np.pi / 24))))
    profile = tangent_line((-4e3, 0), 4e3, 4e3, (lam[1:] + lam[:-1]) / 2 + np.pi / 2, closed=False)
    turning = np.array([np.nan, *np.diff(profile.directions), np.nan])
    profile = replace(profile, declared=None, turning=turning)
    koebe = np.stack([np.cos(lam), np.sin(lam)], axis=1)
    return deliver("edge-offset", "edge", rail, profile, koebe)


def spoilt(delivery, what, **changes):
    """The same delivery with some fields of its mesh or design replaced."""
    kept = {name: value for name, value in vars(delivery).items() if name not in DERIVED}
    return holding(**{**kept, what: replace(getattr(delivery, what), **changes)})


def with_raw(delivery, **tables):
    """The same delivery with some keys of design.json replaced."""
    raw = {
        **delivery.design.raw,
        **{name: {**delivery.design.raw[name], **keys} for name, keys in tables.items()},
    }
    return spoilt(delivery, "design", raw=raw)


def with_rail(delivery, **changes):
    return spoilt(delivery, "design", rail=replace(delivery.design.rail, **changes))


def changed(array, at, by):
    """A copy of an array with something added at one place."""
    copy = array.copy()
    copy[at] += by
    return copy


def table(name, **columns):
    columns = {key: tuple(map(str, values)) for key, values in columns.items()}
    return Table(name, columns, len(next(iter(columns.values()))))


def status(rules, rule_id, delivery):
    """Status of one check on a delivery."""
    return judge(next(rule for rule in rules if rule.id == rule_id), delivery)


def edit_table(name, change):
    """Give a fault to seed in a folder: the rows of a table, changed in place and written as they were read."""

    def seed(folder):
        path = folder / "tables" / f"{name}.csv"
        rows = list(csv.DictReader(io.StringIO(path.read_bytes().decode(), newline="")))
        change(rows)
        buffer = io.StringIO(newline="")
        writer = csv.DictWriter(buffer, rows[0], lineterminator="\r\n")
        writer.writeheader()
        writer.writerows(rows)
        path.write_bytes(buffer.getvalue().encode())

    return seed
