"""From where a building is looked at: parallel projection, so that lengths can be measured."""

from dataclasses import dataclass

import numpy as np

from isomould.arrays import Floats, read_only
from isomould.documents.viewing import SpaceView

AZIMUTH_DEG, ELEVATION_DEG = -58.0, 32.0


@dataclass(frozen=True, eq=False)
class Camera:
    """Right, up and towards the eye: perpendicular unit vectors (3,)."""

    right: Floats
    up: Floats
    eye: Floats

    def __post_init__(self) -> None:
        for value in vars(self).values():
            read_only(value)

    def flat(self, points: Floats) -> Floats:
        """Give the places (…, 2) on the picture plane, mm, of points (…, 3)."""
        return points @ np.stack([self.right, self.up], axis=1)

    def depth(self, points: Floats) -> Floats:
        """Give how near points (…, 3) are to the eye, mm."""
        return points @ self.eye

    @property
    def level(self) -> bool:
        """Whether the eye looks along the ground."""
        return abs(float(self.eye[2])) < 1e-9

    @property
    def from_above(self) -> bool:
        """Whether the eye looks straight down."""
        return abs(float(self.right[2])) + abs(float(self.up[2])) < 1e-9


def make_camera(view: SpaceView, azimuth_deg: float = AZIMUTH_DEG, elevation_deg: float = ELEVATION_DEG) -> Camera:
    """Place the camera of a view; the angles are those of axonometries, where the eye stands.

    The azimuth counts from x towards y, the elevation from the ground up.

    >>> make_camera("axonometry", 0, 90).from_above, make_camera("front").eye
    (True, array([ 0., -1.,  0.]))
    """
    match view:
        case "plan":
            return _camera((1, 0, 0), (0, 1, 0), (0, 0, 1))
        case "front" | "elevation" | "section":
            return _camera((1, 0, 0), (0, 0, 1), (0, -1, 0))
        case "side":
            return _camera((0, 1, 0), (0, 0, 1), (1, 0, 0))
        case "axonometry":
            return _oblique(np.radians(azimuth_deg), np.radians(elevation_deg))


def _camera(*axes: tuple[float, float, float]) -> Camera:
    return Camera(*(np.array(axis, dtype=np.float64) for axis in axes))


def _oblique(turn: float, rise: float) -> Camera:
    eye = np.array([np.cos(turn) * np.cos(rise), np.sin(turn) * np.cos(rise), np.sin(rise)], dtype=np.float64)
    eye = eye.round(12)  # straight down is straight down
    right = np.array([-np.sin(turn), np.cos(turn), 0.0])
    return Camera(right, np.cross(eye, right), eye)
