"""Rails in space proved anew: the frame turned from edge to edge, lines beside the rail, bisecting planes."""

from itertools import pairwise

import numpy as np

from isomould.verify.read.design import Design, edge_vectors
from isomould.verify.rules import Floats

SEAM = 0.01
"""mm: the shop's limit of V10 for frames of closed rails whose coordinates were rounded."""


def recomputed_in_space(design: Design) -> Floats:
    """Compute the grid of a rail in space anew, (m, n, 3) mm (geometry §3).

    The line through (d_i, z_i) of the frame of a rail edge meets the bisecting plane of the rail vertex at the edge's
    start, or a plane across the edge at an open end. The frame is turned on by the smallest rotation from edge to
    edge, where its maker reflects it.
    """
    along, frames = _along(design), _frames(design)
    closed = design.rail.closed
    after = along if closed else np.vstack((along, along[-1:]))
    before = np.roll(along, 1, axis=0) if closed else np.vstack((along[:1], along))
    across = frames[: len(along)] if closed else np.concatenate((frames, frames[-1:]))
    beside = np.einsum("ik,jkl->ijl", design.generatrix.vertices, across)
    plane = before + after
    slide = -(beside * plane).sum(axis=2) / (after * plane).sum(axis=1)
    return design.rail.vertices + beside + slide[..., None] * after


def frame_gap(design: Design) -> float:
    """Give how far, mm, the profile misses itself when its frame comes back to edge 0 of a closed rail."""
    first, last = _frames(design)[[0, -1]]
    return float(np.linalg.norm(design.generatrix.vertices @ (last - first), axis=1).max())


def _along(design: Design) -> Floats:
    vectors = edge_vectors(design.rail)
    return vectors / np.linalg.norm(vectors, axis=1)[:, None]


def _frames(design: Design) -> Floats:
    """Give the frames (U, W) of all edges, (e, 2, 3); of a closed rail edge 0 comes again at the end."""
    along, up = _along(design), np.array(design.raw["up"], dtype=np.float64)
    side = np.cross(along[0], up)
    side /= np.linalg.norm(side)
    frames = [np.stack((side, np.cross(side, along[0])))]
    path = np.vstack((along, along[:1])) if design.rail.closed else along
    for here, ahead in pairwise(path):
        frames.append(_turned(frames[-1], here, ahead))
    return np.array(frames)


def _turned(frame: Floats, here: Floats, ahead: Floats) -> Floats:
    """Turn vectors (2, 3) by the smallest rotation that takes one unit vector to another (Rodrigues)."""
    axis = np.cross(here, ahead)
    once = np.cross(axis, frame)
    return frame + once + np.cross(axis, once) / (1 + here @ ahead)
