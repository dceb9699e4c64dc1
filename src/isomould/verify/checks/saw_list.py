"""V45g: the saw list on paper names every bar with its cuts in order, their lengths and what is left."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from isomould.verify.checks.cutting_plan import is_shown, says
from isomould.verify.delivery import Delivery
from isomould.verify.read.pdf import Book
from isomould.verify.read.tables import numbers, pairs, texts
from isomould.verify.rules import Measured, NotApplicable, Rule, faults

NOT_TURNED = "none"


@dataclass(frozen=True)
class Cut:
    """A piece of a bar; position and length in mm."""

    mark: str
    location: str
    position: float
    length: float
    turned: str


@dataclass(frozen=True)
class Bar:
    """A bar, what it is cut from, its cuts from the left, and what is left of it in mm."""

    name: str
    stock: str
    cuts: tuple[Cut, ...]
    offcut: float


def planned(delivery: Delivery) -> Measured:
    """Bars, cuts and offcuts on paper against the schedules."""
    if not delivery.design.raw.get("drawings", False):
        raise NotApplicable("the project asks for no drawings")
    if "bars" not in delivery.tables:
        raise NotApplicable("no bars in stock")
    return paper_faults(delivery.saw_plan, _scheduled(delivery))


def _scheduled(delivery: Delivery) -> list[Bar]:
    bars, instances = delivery.table("bars"), delivery.table("member_instances")
    lengths = {mark: float(text) for mark, text in pairs(delivery.table("members"), "mark", "cut_length_mm").items()}
    places = numbers(instances, "position_mm", blank=True).tolist()
    rows = zip(*(texts(instances, name) for name in ("bar", "mark", "location", "bar_turned")), places, strict=True)
    on: dict[str, list[Cut]] = {}
    for bar, mark, location, turned, position in rows:
        on.setdefault(bar, []).append(Cut(mark, location, position, lengths[mark], turned))
    named = zip(texts(bars, "bar"), texts(bars, "stock"), numbers(bars, "offcut_mm").tolist(), strict=True)
    return [
        Bar(name, stock, tuple(sorted(on.get(name, []), key=lambda cut: cut.position)), offcut)
        for name, stock, offcut in named
    ]


def paper_faults(book: Book, bars: Sequence[Bar]) -> Measured:
    """List what a saw list does not say, or says in another order."""
    shown = _segments(book, {bar.name: bar.stock for bar in bars})
    everywhere = [cut for bar in bars for cut in bar.cuts]
    located, turned = any(cut.location for cut in everywhere), any(cut.turned != NOT_TURNED for cut in everywhere)
    problems = [fault for bar in bars for fault in _bar_faults(bar, shown.get(bar.name, []), (located, turned))]
    return faults(len(bars) + len(everywhere), problems)


def _segments(book: Book, stock: Mapping[str, str]) -> dict[str, list[list[str]]]:
    """Give what stands behind name and stock of every bar, in the order of the pages, up to the next name."""
    found: dict[str, list[list[str]]] = {}
    for page in book.sheets:
        now = list[str]()
        for text, following in zip(page.texts, (*page.texts[1:], ""), strict=True):
            if text in stock and is_shown(stock[text], following):
                now = []
                found.setdefault(text, []).append(now)
            else:
                now.append(text)
    return found


def _bar_faults(bar: Bar, segments: list[list[str]], columns: tuple[bool, bool]) -> Iterator[str]:
    """Read the rows of a bar one after another; a table that goes on elsewhere names its bar again."""
    wanted = list(_rows(bar, columns))
    for segment in segments:
        at = 1  # behind the stock
        while wanted and _is_row(segment[at : at + len(wanted[0])], wanted[0]):
            at += len(wanted.pop(0))
    if wanted:
        row = " ".join(cell if isinstance(cell, str) else f"{cell:.3f}" for cell in wanted[0])
        yield f"{bar.name}: {row} is not where it should be"


def _rows(bar: Bar, columns: tuple[bool, bool]) -> Iterator[list[str | float]]:
    """Give the rows of texts and numbers: in the list of bars, then cut by cut, then the offcut."""
    yield [str(len(bar.cuts))]
    for number, cut in enumerate(bar.cuts, start=1):
        where = [cut.location] if columns[0] and cut.location else []
        yield [str(number), cut.mark, *where, cut.position, cut.length, *([cut.turned] if columns[1] else [])]
    yield ["Offcut (mm)", bar.offcut]


def _is_row(found: list[str], wanted: list[str | float]) -> bool:
    cells = zip(found, wanted, strict=False)
    return len(found) == len(wanted) and all(_is_cell(text, cell) for text, cell in cells)


def _is_cell(text: str, cell: str | float) -> bool:
    return is_shown(cell, text) if isinstance(cell, str) else says(text, cell, "length_mm")


RULES = (Rule("V45g", "the saw list shows every bar as scheduled", 0, "faults", planned),)
