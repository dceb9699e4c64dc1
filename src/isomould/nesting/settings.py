"""The `[stock]` table: what lies in the rack, and how it may be cut."""

from collections import Counter
from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import AfterValidator

from isomould.nesting.material import Grain, Material
from isomould.settings import Name, Settings, Text
from isomould.units import Count, Flag, NonNegativeLength, NonNegativeNumber, PositiveLength

Turning = Literal["none", "half", "quarter"]
"""Rotations that a part may take: 0; 0 and 180; every multiple of 90 degrees."""

BarEnds = Literal["head-to-tail", "square"]
"""Slanted ends of flat bars beside each other, or every piece as long as the box around it."""

ROTATIONS_DEG: dict[Turning, tuple[int, ...]] = {"none": (0,), "half": (0, 180), "quarter": (0, 90, 180, 270)}

StockName = Name
"""Quoted in formulas of the workbook, which hold 255 characters."""


def _at_least_one(value: int) -> int:
    if value < 1:
        message = f"{value} of them; at least 1, or no quantity where there are as many as are needed"
        raise ValueError(message)
    return value


Quantity = Annotated[Count, AfterValidator(_at_least_one)]
"""How many there are."""


class SheetStock(Settings):
    """A stock sheet. `quantity` None is unlimited; a sheet with a grain takes no quarter turns.

    The grain runs along the width. A sheet that says its material, grade or thickness holds parts of those only.
    """

    name: StockName
    width: PositiveLength
    height: PositiveLength
    price: NonNegativeNumber = 0.0
    quantity: Quantity | None = None
    grain: Flag = False
    material: Text = ""
    grade: Text = ""
    thickness: PositiveLength | None = None

    @property
    def made_of(self) -> Material:
        """What is said of its material."""
        return Material(self.material, self.grade, self.thickness)


class BarStock(Settings):
    """A stock bar of one section. `quantity` None is unlimited; one that says its grade is for members of that."""

    section: StockName
    length: PositiveLength
    price: NonNegativeNumber = 0.0
    quantity: Quantity | None = None
    grade: Text = ""


class StockSettings(Settings):
    """Sheets and bars, and what is lost between the parts (fabrication, "Nesting panels in sheets").

    `gap` is the clear distance of finished outlines and includes the kerf; `trim` is lost along every edge
    of a sheet, `bar_trim` at each end of a bar. Without sheets the panels are nested in blanks to order of
    at most `max_blank_length`.
    """

    sheets: tuple[SheetStock, ...] = ()
    bars: tuple[BarStock, ...] = ()
    gap: NonNegativeLength = 5.0
    kerf: NonNegativeLength = 0.0
    trim: NonNegativeLength = 0.0
    turning: Turning = "quarter"
    turn_over: Flag = False
    guillotine: Flag = True
    max_blank_length: PositiveLength = 6000.0
    bar_kerf: NonNegativeLength = 3.0
    bar_trim: NonNegativeLength = 0.0
    bar_ends: BarEnds = "square"

    @property
    def scored(self) -> bool:
        """Tell whether nothing is lost between parts: glass is scored and broken, not cut."""
        return self.gap == 0

    def conflicts(self) -> Iterator[str]:
        """Say which values of the stock do not go together."""
        if self.gap < self.kerf:
            yield f"gap {self.gap:g} mm is too narrow; at least the kerf of {self.kerf:g} mm that it includes"
        yield from self._trims()
        names = [sheet.name for sheet in self.sheets]
        if len(set(names)) < len(names):
            yield "two stock sheets have the same name; a name of its own for every sheet"
        yield from self._twin_bars()

    def _trims(self) -> Iterator[str]:
        """Name the stock of which the trim leaves nothing."""
        for sheet in self.sheets:
            if 2 * self.trim >= min(sheet.width, sheet.height):
                yield f"trim {self.trim:g} mm leaves nothing of sheet {sheet.name!r}; less than half of its sides"
        for bar in self.bars:
            if 2 * self.bar_trim >= bar.length:
                yield f"bar_trim {self.bar_trim:g} mm leaves nothing of a bar; less than half of its {bar.length:g} mm"

    def _twin_bars(self) -> Iterator[str]:
        """Name the bars of one section that are as long as another."""
        known = Counter((bar.section, bar.length, bar.grade) for bar in self.bars)
        for section, length, _ in (bar for bar, count in known.items() if count > 1):
            yield (
                f"two stock bars of {section} are {length:g} mm long; one entry for every length and section "
                "(a remnant as long as a new bar may be a millimetre shorter)"
            )


def allowed_rotations_deg(
    stock: StockSettings, sheet: SheetStock | None, grain: Grain | None = None
) -> tuple[int, ...]:
    """Give the rotations that a part may take on a sheet (None: on a blank to order), ascending.

    A grain across the part's x axis lies along the sheet's after a quarter turn, to either side.
    """
    if grain == "across":
        return (90, 270)
    straight = grain == "along" or (sheet is not None and sheet.grain)
    return tuple(turn for turn in ROTATIONS_DEG[stock.turning] if not straight or turn % 180 == 0)
