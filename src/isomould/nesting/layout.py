"""Parts and members to nest, and the layouts that place them: the values of this room."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

import shapely

from isomould.arrays import Floats
from isomould.nesting.material import Grain, Material

Id = int | str
"""The name of a part: the mark in the pipeline, whatever the file says in a part list of others."""

Status = Literal["complete", "interrupted", "incomplete"]
BoundKind = Literal["area", "lp"]

Turned = Literal["none", "end_for_end", "upside_down", "both"]
"""How a piece lies on its bar compared with its member: turned by 180 degrees in its plane, mirrored top to bottom."""

CutTree = dict[str, Any]
"""Guillotine cuts of a piece: `{"lines": [[[x, y], [x, y]], ...], "pieces": [tree, ...]}`, in cutting order.

Line k has pieces 0 to k at its left, looking from its first point to its second, and the others at its
right. An offcut is `{}`, a part `{"placement": index}`. The trim is cut off first.
"""

NO_MATERIAL = Material()

BLANK = "blank"
"""Stock name of blanks to order."""


@dataclass(frozen=True, eq=False)
class Part:
    """One class of parts.

    Attributes
    ----------
    outline : (n, 2) float, mm
        Simple polygon, vertices multiples of 0.001.
    locations
        One per piece, or none at all.
    holes : tuple of (n, 2) float, mm
        Rings inside the outline that hold what is cut out of it: other parts may lie there.
    material
        Parts of one sheet share it.
    grain
        None where the part may be turned as the stock allows.
    """

    id: Id
    outline: Floats
    quantity: int = 1
    row: Id | None = None
    locations: tuple[str, ...] = ()
    holes: tuple[Floats, ...] = ()
    material: Material = NO_MATERIAL
    grain: Grain | None = None

    @cached_property
    def polygon(self) -> shapely.Polygon:
        """The part without its holes."""
        return shapely.Polygon(self.outline, self.holes)


@dataclass(frozen=True)
class Sheet:
    """A sheet taken from stock, or a blank to order; trim included. Lengths in mm."""

    id: str
    stock: str
    width: float
    height: float
    material: Material = NO_MATERIAL


@dataclass(frozen=True, eq=False)
class Placement:
    """One piece on its sheet; `points` (n, 2) float, mm, in the order of the part's outline."""

    id: Id
    location: str | None
    sheet: str
    points: Floats
    rotation_deg: int
    turned_over: bool = False


@dataclass(frozen=True)
class Unplaced:
    """One piece without a place, and the room that it needs: width and height in mm, trim excluded."""

    id: Id
    reason: str
    needs: tuple[float, float]
    location: str | None = None


@dataclass(frozen=True)
class Offcut:
    """A rectangle of a sheet that the cutting leaves in one piece; `x`, `y` its lower left corner. Lengths in mm."""

    sheet: str
    x: float
    y: float
    width: float
    height: float


@dataclass(frozen=True, eq=False)
class Layout:
    """Sheets with their placements, and a lower bound for the number of sheets.

    Attributes
    ----------
    bound, price_bound
        No nesting of the placed parts, guillotine or not, uses fewer sheets, or costs less than that. Kind "area"
        compares areas grown by half the gap, "lp" shares them out among several sizes in whole sheets.
    pattern_bound
        No layout of strips and zones of the kind that the search makes, measured on its grid, costs less than that many
        of the largest or dearest sheets; None if the search did not generate columns.
    price
        Of all sheets.
    cut_trees
        Names for every sheet id the guillotine cuts in order; empty if the layout has none.
    no_cuts
        Why it has none.
    cuts, cut_length
        Straight cuts of the trees, the trim's not counted, and their length in mm.
    offcut
        The largest rectangle left over; `yield_with_offcut_percent` does not count it as bought.
    """

    sheets: tuple[Sheet, ...]
    placements: tuple[Placement, ...]
    unplaced: tuple[Unplaced, ...]
    bound: int
    bound_kind: BoundKind
    yield_percent: float
    cut_trees: dict[str, CutTree]
    status: Status = "complete"
    reproducible: bool = True
    pattern_bound: int | None = None
    price: float = 0.0
    price_bound: float = 0.0
    cuts: int = 0
    cut_length: float = 0.0
    offcut: Offcut | None = None
    yield_with_offcut_percent: float = 0.0
    no_cuts: str | None = None

    @property
    def gap_to_bound(self) -> int:
        """Sheets above the lower bound."""
        return len(self.sheets) - self.bound


@dataclass(frozen=True)
class Member:
    """One class of members of one section; `length` in mm, `locations` one per piece or none.

    A part of a flat bar has an `outline`, x along the bar from 0 to its length and y over the whole width of the bar:
    its ends may be nested head to tail, and it may be turned. All others are cut square.
    """

    id: Id
    section: str
    length: float
    quantity: int = 1
    locations: tuple[str, ...] = ()
    outline: tuple[tuple[float, float], ...] = ()


@dataclass(frozen=True)
class Cut:
    """One piece of a bar; `start` is the distance of its left end in mm from the bar's left end."""

    id: Id
    location: str | None
    start: float
    length: float
    turned: Turned = "none"


@dataclass(frozen=True)
class Bar:
    """A stock bar with its pieces, left to right; `rest` is the offcut in mm, end trims excluded."""

    id: str
    section: str
    length: float
    cuts: tuple[Cut, ...]
    rest: float


@dataclass(frozen=True)
class BarLayout:
    """Bars of every section.

    Attributes
    ----------
    bounds
        No cutting of the placed pieces takes fewer bars of a section. Kind "area" compares lengths, long pieces
        counted apart; "lp" shares the pieces out among patterns, in fractions of bars, for one section at least.
    price, price_bound
        Of all bars, and the least that any cutting of the placed pieces costs; 0 without prices.
    """

    bars: tuple[Bar, ...]
    unplaced: tuple[Unplaced, ...]
    bounds: dict[str, int]
    bound_kind: BoundKind
    price: float = 0.0
    price_bound: float = 0.0
    status: Status = "complete"
    reproducible: bool = True

    @property
    def bound(self) -> int:
        """Lower bound for the number of bars."""
        return sum(self.bounds.values())

    @property
    def gap_to_bound(self) -> int:
        """Bars above the lower bound."""
        return len(self.bars) - self.bound
