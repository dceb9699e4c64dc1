"""Parts of drawings in part lists: their rows, their names where a drawing holds several, and what is said of them."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from string import ascii_lowercase
from typing import Any

from isomould.errors import Note
from isomould.intake.drawn_part import DrawnPart, PartDrawing
from isomould.intake.hole_rings import ring_around
from isomould.intake.instance import Instance
from isomould.intake.part_list import PartList
from isomould.intake.part_rows import Row
from isomould.intake.words import listed


def drawn_rows(table: Mapping[str, Any], drawing: PartDrawing, field: str) -> list[Row]:
    """Give a row for every part of a drawing, with what a list says of all of them: `id`, `quantity` and others."""
    return [({**table, "id": mark, "points": part.outline.tolist()}, field) for mark, part in _marked(table, drawing)]


def _marked(table: Mapping[str, Any], drawing: PartDrawing) -> Iterator[tuple[str, DrawnPart]]:
    """Name the parts of a drawing: by the id of its row, with a letter behind where there are several."""
    for number, part in enumerate(drawing.parts):
        yield str(table["id"]) if len(drawing.parts) == 1 else f"{table['id']}-{letters(number)}", part


def letters(number: int) -> str:
    """Count by letters.

    Examples
    --------
    >>> [letters(number) for number in (0, 1, 25, 26, 701, 702)]
    ['a', 'b', 'z', 'aa', 'zz', 'aaa']
    """
    text = ""
    number += 1
    while number:
        number, last = divmod(number - 1, len(ascii_lowercase))
        text = ascii_lowercase[last] + text
    return text


def with_drawings(instance: Instance, drawn: Mapping[str, PartDrawing | None], notes: tuple[Note, ...]) -> PartList:
    """Add the holes of drawings, which are named by the ids of their rows, and say what is not as drawn."""
    found = {mark: part for key, one in drawn.items() if one for mark, part in _marked({"id": key}, one)}
    holes = {part.id: found[str(part.id)].holes for part in instance.parts if str(part.id) in found}
    holes = {mark: cut for mark, cut in holes.items() if cut}
    rings = {mark: tuple(ring_around(hole) for hole in cut) for mark, cut in holes.items()}
    parts = tuple(replace(part, holes=rings.get(part.id, ())) for part in instance.parts)
    of_files = [note for one in drawn.values() if one for note in one.notes]
    return PartList(replace(instance, parts=parts), holes, (*notes, *of_files, *_remarks(found)))


def _remarks(found: Mapping[str, DrawnPart]) -> Iterator[Note]:
    """Say once of all parts what is the same of them."""
    alike = dict[tuple[str, str], list[str]]()
    for mark, part in found.items():
        for remark in part.remarks:
            alike.setdefault(remark, []).append(mark)
    for (code, text), marks in alike.items():
        yield Note(code, listed(marks), text)
