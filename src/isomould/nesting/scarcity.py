"""Stock that is too small in all: known from areas and lengths, without any search."""

from collections.abc import Sequence

from isomould.errors import Gathering, Refused
from isomould.nesting.bar_task import kinds_of, pieces_of
from isomould.nesting.bound import too_few
from isomould.nesting.layout import Member, Part
from isomould.nesting.settings import StockSettings
from isomould.nesting.shapes import UM

_WAY_OUT = "Raise the quantities, or add stock."


def refuse_scarce_sheets(parts: Sequence[Part], stock: StockSettings) -> None:
    """Refuse parts that need more area than all sheets have on which they fit.

    Raises
    ------
    Refused
        E-STOCK, with both areas.
    """
    if all(sheet.quantity is None for sheet in stock.sheets):
        return
    found = too_few([part.polygon for part in parts for _ in range(part.quantity)], stock)
    if found is not None:
        need, room = (area / 1e6 for area in found)
        need_text, room_text = f"parts and their gaps need {need:.2f} m²", f"the sheets that hold them, {room:.2f} m²"
        raise Refused("E-STOCK", "stock.sheets", need_text, room_text, _WAY_OUT)


def refuse_scarce_bars(members: Sequence[Member], stock: StockSettings) -> None:
    """Refuse members that need more length than all bars of their section have: each such section is named.

    Raises
    ------
    Refused
        E-STOCK, with both lengths.
    """
    with Gathering() as faults:
        for section in dict.fromkeys(member.section for member in members):
            faults.run(_refuse_scarce, section, [m for m in members if m.section == section], stock)


def _refuse_scarce(section: str, members: Sequence[Member], stock: StockSettings) -> None:
    kinds = kinds_of(section, stock)
    if any(kind.bar.quantity is None for kind in kinds):
        return
    kerf = int(stock.bar_kerf * UM + 1e-6)
    need = sum(piece.blank.least + kerf for member in members for piece in pieces_of(member, stock))
    # One kerf less than pieces on every bar: its last piece ends where the bar does.
    room = sum((kind.room + kerf) * (kind.bar.quantity or 0) for kind in kinds)
    if need > room:
        need_text, room_text = (f"{length / UM / 1000:.2f} m" for length in (need, room))
        raise Refused("E-STOCK", "stock.bars", f"{section}: members need {need_text}", f"bars of {room_text}", _WAY_OUT)
