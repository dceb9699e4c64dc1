"""Which columns of a table mean what: by the vocabulary of the trade, or as an option says."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from isomould.intake.part_rows import refuse
from isomould.intake.table_rows import Row, Rows
from isomould.intake.vocabulary import Heading, all_meanings, means, plain, read_heading

_FARTHEST = 60
"""Rows among which the heading stands."""

_UNSURE = 3
"""Rank of words that number rows, or name parts, rather than mark them."""

_SIZES = {"length", "width", "height", "section"}
"""What lists of parts and members say; two of them make a list."""

_SLOPES = {"b", "h", "ol", "orr"}
"""Letters that speak of a trapezoid where there is a column a, and else of width and height."""


@dataclass(frozen=True)
class Found:
    """The heading of a table: its columns by what they mean, and the rows before and behind it."""

    headings: tuple[Heading, ...]
    columns: Mapping[str, int]
    ranks: Mapping[str, int]
    line: int
    before: tuple[Row, ...]
    rows: tuple[Row, ...]
    separator: str


def find_heading(ways: Sequence[Rows], known: frozenset[str], asked: Mapping[str, str], file: str) -> Found:
    """Find the row of a table that names its columns: the one that says most in words that are known.

    Parameters
    ----------
    ways
        Ways to read the file.
    known
        What columns may mean here.
    asked
        Headings by what they mean, which is taken as said.

    Raises
    ------
    Refused
        E-NEST-11: no such row, a heading asked for that is not there, two columns for one thing, lists on several
        sheets of a workbook.
    """
    scored = [
        (len(_columns(list(map(read_heading, cells)), known, asked)), way, k)
        for way in ways
        for k, (_, cells) in enumerate(way.rows[:_FARTHEST])
    ]
    best, way, k = max(scored, key=lambda one: one[0], default=(0, None, 0))
    if way is None or best < min(2, len(known)):
        firsts = [way.rows[0][1] for way in ways if way.rows]
        seen = [cell for cell in max(firsts, key=len, default=[]) if plain(cell)]
        found = f"no heading that is known; the first line has {', '.join(seen[:12]) or 'nothing'}"
        limit = "a row with headings such as id, quantity, length, width"
        refuse(file, found, limit, "Name the columns, or say --column length=HEADING.")
    _refuse_rivals(way, ways, file)
    line, cells = way.rows[k]
    headings, rows = tuple(map(read_heading, cells)), tuple(way.rows[k + 1 :])
    field = f"{file}: line {line}"
    _refuse_unknown_names(asked, headings, field)
    columns = _columns(headings, known, asked)
    _refuse_twice(headings, {key: at for key, at in columns.items() if key not in asked}, field)
    columns = _settled(columns, asked, headings, rows, field)
    ranks = {meaning: means(headings[at].name).get(meaning, 0) for meaning, at in columns.items()}
    return Found(headings, columns, ranks, line, tuple(way.rows[:k]), rows, way.separator)


def _refuse_rivals(chosen: Rows, ways: Sequence[Rows], file: str) -> None:
    """Refuse a workbook with lists on several sheets: one alone would be cut."""
    rivals = [way.sheet for way in ways if way.sheet != chosen.sheet and _lists_sizes(way)]
    if rivals:
        found = f"lists on the sheets {', '.join(map(repr, [chosen.sheet, *rivals]))}"
        refuse(file, found, "one list in a workbook", "Save each as a file of its own, or put them below each other.")


def _lists_sizes(way: Rows) -> bool:
    named = [_columns(list(map(read_heading, cells)), all_meanings(), {}) for _, cells in way.rows[:_FARTHEST]]
    return any(len(_SIZES & {*columns}) > 1 for columns in named)


def _settled(
    columns: dict[str, int], asked: Mapping[str, str], headings: Sequence[Heading], rows: Sequence[Row], field: str
) -> dict[str, int]:
    """Settle what "No." means: pieces only beside a mark, and never where it counts the rows."""
    at = columns.get("quantity")
    if at is None or "quantity" in asked or means(headings[at].name).get("quantity") == 1:
        return columns
    mark = columns.get("id")
    marked = mark is not None and ("id" in asked or means(headings[mark].name).get("id", _UNSURE) < _UNSURE)
    if not marked:
        return {**{key: place for key, place in columns.items() if key != "quantity"}, "id": at}
    cells = [cells[at] for _, cells in rows if at < len(cells) and cells[at]]
    if len(cells) > 1 and cells == [str(number) for number in range(1, len(cells) + 1)]:
        name = headings[at].text
        found = f"{name!r} runs from 1 to {len(cells)}: it may number the rows or count pieces"
        refuse(field, found, "a heading that says which", f"Say --column quantity={name}, or rename it row.")
    return columns


def column_of(text: str) -> tuple[str, str]:
    """Give meaning and heading of a column that an option says: `mark=Label`.

    Raises
    ------
    ValueError
        If it is none.

    Examples
    --------
    >>> column_of("mark=Label"), column_of("Länge=Maß 1")
    (('id', 'Label'), ('length', 'Maß 1'))
    """
    name, _, heading = (part.strip() for part in text.partition("="))
    found = means(plain(name)) or {plain(name).replace(" ", "_"): 1}
    meaning = min(found, key=lambda word: found[word])
    if meaning not in all_meanings() or not heading:
        message = f"{text!r} names no column; one of {', '.join(sorted(all_meanings()))}, = and a heading"
        raise ValueError(message)
    return meaning, heading


def _columns(headings: Sequence[Heading], known: frozenset[str], asked: Mapping[str, str]) -> dict[str, int]:
    """Give the column of every meaning: as asked, then the surest, each column once."""
    columns = {meaning: at for meaning, name in asked.items() for at in _named(headings, name)[:1]}
    offers = [offer for at, heading in enumerate(headings) for offer in _offers(at, heading, headings, known)]
    for _, _, meaning, at in sorted(offers):
        if meaning not in columns and at not in columns.values():
            columns[meaning] = at
    return columns


def _offers(
    at: int, heading: Heading, headings: Sequence[Heading], known: frozenset[str]
) -> list[tuple[int, int, str, int]]:
    """Give what a column may mean, with how sure that is; where both are as sure, pieces come before a mark."""
    names = {other.name for other in headings}
    found = {meaning: rank for meaning, rank in means(heading.name).items() if meaning in known}
    if "a" not in names:
        found = {meaning: rank for meaning, rank in found.items() if meaning not in _SLOPES}
    elif "height" in found and "h" not in names:
        found = {"h": 1}
    return [(rank, int(meaning == "id"), meaning, at) for meaning, rank in found.items()]


def _named(headings: Sequence[Heading], name: str) -> list[int]:
    """Give the columns that are called so: letter by letter, or else as words are compared."""
    exact = [at for at, heading in enumerate(headings) if heading.text == name.strip()]
    word = plain(name)
    return exact or [at for at, heading in enumerate(headings) if word in (plain(heading.text), heading.name)]


def _refuse_unknown_names(asked: Mapping[str, str], headings: Sequence[Heading], field: str) -> None:
    texts = ", ".join(heading.text for heading in headings if heading.text)
    for meaning, name in asked.items():
        count = len(_named(headings, name))
        if count != 1:
            found = f"{count or 'no'} columns {name!r} among {texts}"
            refuse(f"--column {meaning}={name}", found, "the heading of one column", f"Correct it for {field}.")


def _refuse_twice(headings: Sequence[Heading], columns: Mapping[str, int], field: str) -> None:
    """Refuse two columns that are equally sure to mean one thing."""
    for meaning, at in columns.items():
        rank = means(headings[at].name).get(meaning)
        same = [other for other in headings if rank is not None and means(other.name).get(meaning) == rank]
        if len(same) > 1:
            twice = ", ".join(heading.text for heading in same)
            way_out = f"Rename one of them, or say --column {meaning}={same[0].text!r}."
            refuse(field, f"{twice}: two columns for {meaning}", "one", way_out)
