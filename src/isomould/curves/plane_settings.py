"""The `plane` of a rail in the project file."""

from typing import Literal

from isomould.settings import Settings
from isomould.units import Length, Number


class PlaneTable(Settings):
    """A plane by its origin (lengths) and two perpendicular directions of any length."""

    origin: tuple[Length, Length, Length] = (0.0, 0.0, 0.0)
    x_axis: tuple[Number, Number, Number]
    y_axis: tuple[Number, Number, Number]


PlaneSettings = Literal["xy", "xz", "yz"] | PlaneTable
