"""How large panels are, and whether they can be made, carried and handled."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from isomould.arrays import Floats, Ints, read_only
from isomould.errors import Gathering, Note, Refused
from isomould.parts.outline import area
from isomould.parts.panels import PanelParts
from isomould.parts.settings import PanelLimits, PanelSettings

TRADE = PanelLimits(max_panel=(6000.0, 3210.0), max_panel_mass=400.0, max_aspect=6.0, min_corner_deg=30.0)
"""What trade can follow: jumbo sheets of float glass, vacuum lifters, cutting tables, corners that do not chip."""


@dataclass(frozen=True, eq=False)
class PanelSizes:
    """Sizes of the panel classes, blanks without chamfers.

    Attributes
    ----------
    of : (f,) int
        Class of every panel.
    width, height : (k,) float, mm
        Of the smallest rectangle around the class, the longer side first.
    area : (k,) float, m²
    mass : (k,) float, kg
    corner_deg : (k,) float
        The sharpest inner angle.
    """

    of: Ints
    marks: tuple[str, ...]
    locations: tuple[str, ...]
    width: Floats
    height: Floats
    area: Floats
    mass: Floats
    corner_deg: Floats

    def __post_init__(self) -> None:
        for value in vars(self).values():
            if isinstance(value, np.ndarray):
                read_only(value)

    @property
    def aspect(self) -> Floats:
        """Longer side by shorter side of the rectangles (k,)."""
        return self.width / self.height

    def where(self, number: int) -> str:
        """Name a class and the first place of it.

        The order of panels is that of the mesh, so that the place is the same on every machine.
        """
        first = int(np.flatnonzero(self.of == number)[0])
        return f"{self.marks[number]} at {self.locations[first]}"


def measure_panels(panels: PanelParts, settings: PanelSettings) -> PanelSizes:
    """Measure the classes of panels."""
    boxes = np.array([_box(blank) for blank in panels.blanks])
    areas = np.array([abs(area(blank)) for blank in panels.blanks]) / 1e6
    return PanelSizes(
        of=panels.classes.of.copy(),
        marks=panels.marks,
        locations=panels.locations,
        width=boxes[:, 0].copy(),
        height=boxes[:, 1].copy(),
        area=areas,
        mass=areas * settings.thickness / 1e3 * settings.density,
        corner_deg=np.array([_sharpest_deg(blank) for blank in panels.blanks]),
    )


def _box(outline: Floats) -> Floats:
    """Sides (2,) of the smallest rectangle around a convex outline (n, 2), the longer first.

    One of its sides lies along a side of the outline (Freeman and Shapira 1975).
    """
    sides = np.roll(outline, -1, axis=0) - outline
    along = sides / np.linalg.norm(sides, axis=1)[:, None]
    across = np.stack([-along[:, 1], along[:, 0]], axis=1)
    spans = np.stack([np.ptp(outline @ along.T, axis=0), np.ptp(outline @ across.T, axis=0)], axis=1)
    best = spans[int(np.round(spans.prod(axis=1), 3).argmin())]
    return np.sort(best)[::-1]


def _sharpest_deg(outline: Floats) -> float:
    ahead = np.roll(outline, -1, axis=0) - outline
    behind = np.roll(outline, 1, axis=0) - outline
    sine = np.abs(ahead[:, 0] * behind[:, 1] - ahead[:, 1] * behind[:, 0])
    cosine = (ahead * behind).sum(axis=1)
    return float(np.degrees(np.arctan2(sine, cosine)).min())


@dataclass(frozen=True)
class _Excess:
    """A class beyond a limit: key of `[limits]`, what was found where, the limit."""

    key: str
    found: str
    limit: str
    way_out: str


def refuse_panel_sizes(sizes: PanelSizes, limits: PanelLimits) -> None:
    """Refuse panels beyond the limits of the project.

    Raises
    ------
    Refused
        E-PANEL-LIMIT for every limit that is not held, together, each with the worst panel and its place.
    """
    with Gathering() as faults:
        for excess in _excesses(sizes, limits):
            faults.run(_refuse, excess)


def _refuse(excess: _Excess) -> None:
    raise Refused("E-PANEL-LIMIT", f"limits.{excess.key}", excess.found, excess.limit, excess.way_out)


def trade_notes(sizes: PanelSizes, limits: PanelLimits) -> tuple[Note, ...]:
    """Note panels that trade cannot follow, where the project has no limit of its own."""
    open_ = {key: None if getattr(limits, key) is not None else value for key, value in TRADE}
    return tuple(
        Note("W-PANEL-TRADE", "panels", f"{excess.found}; what trade can follow: {excess.limit}. {excess.way_out}")
        for excess in _excesses(sizes, PanelLimits.model_construct(**open_))
    )


def _excesses(sizes: PanelSizes, limits: PanelLimits) -> Iterator[_Excess]:
    """Find what goes beyond each limit that is given."""
    if limits.max_panel is not None:
        yield from _too_large(sizes, max(limits.max_panel), min(limits.max_panel))
    if limits.max_panel_mass is not None:
        yield from _too_heavy(sizes, limits.max_panel_mass)
    if limits.max_aspect is not None:
        yield from _too_slender(sizes, limits.max_aspect)
    if limits.min_corner_deg is not None:
        yield from _too_sharp(sizes, limits.min_corner_deg)


_SLACK = 1 + 1e-9
"""What rounding may add to a size that is just the limit."""

_DIVIDE = "Divide the curves more finely, or give max_edge."
_EVEN = "Divide the curve along the longer sides more finely, or give its max_edge."
_BLUNT = "Move the planes that trim the surface, or keep away from the pole."


def _worst_of(values: Floats) -> int:
    """Give the first class with the largest value; noise does not decide between equal ones."""
    return int(np.round(values, 6).argmax())


def _too_large(sizes: PanelSizes, long: float, short: float) -> Iterator[_Excess]:
    """Hold the rectangles against a sheet, either way round."""
    over = np.maximum(sizes.width / long, sizes.height / short)
    worst = _worst_of(over)
    if over[worst] > _SLACK:
        count = int(np.count_nonzero((over > _SLACK)[sizes.of]))
        size = f"{sizes.width[worst]:.1f} × {sizes.height[worst]:.1f} mm"
        text = f"a panel of {size} ({sizes.where(worst)}), {count} panels in all"
        yield _Excess("max_panel", text, f"at most {long:g} × {short:g} mm", _DIVIDE)


def _too_heavy(sizes: PanelSizes, most: float) -> Iterator[_Excess]:
    worst = _worst_of(sizes.mass)
    if sizes.mass[worst] > most * _SLACK:
        text = f"a panel of {sizes.mass[worst]:.1f} kg ({sizes.where(worst)})"
        yield _Excess("max_panel_mass", text, f"at most {most:g} kg", _DIVIDE)


def _too_slender(sizes: PanelSizes, most: float) -> Iterator[_Excess]:
    worst = _worst_of(sizes.aspect)
    if sizes.aspect[worst] > most * _SLACK:
        text = f"a panel of 1:{sizes.aspect[worst]:.1f} ({sizes.where(worst)})"
        yield _Excess("max_aspect", text, f"at most 1:{most:g}", _EVEN)


def _too_sharp(sizes: PanelSizes, least: float) -> Iterator[_Excess]:
    worst = _worst_of(-sizes.corner_deg)
    if sizes.corner_deg[worst] * _SLACK < least:
        text = f"a corner of {sizes.corner_deg[worst]:.2f}° ({sizes.where(worst)})"
        yield _Excess("min_corner_deg", text, f"at least {least:g}°", _BLUNT)
