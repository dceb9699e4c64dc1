"""A DXF file taken apart: its header, layers, blocks and entities, as records that nobody has interpreted yet."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple, NoReturn

from isomould.curves.drawing_units import INSUNITS
from isomould.curves.dxf_records import DamagedFile, Record, TagLines, header_of, records_of
from isomould.curves.layer_names import layer_key
from isomould.errors import Note, OutputFault, Refused

LARGEST_FILE = 100 * 2**20
"""Bytes; a drawing of one curve is far smaller."""

_SUB_ENTITIES = {"VERTEX", "ATTRIB", "SEQEND"}
_XREF = 4 | 8 | 16
"""Flags of a block that stands for another file."""


class LayerState(NamedTuple):
    """A layer as the table of layers has it."""

    name: str
    state: str
    """"", "off" or "frozen"."""


class Entity(NamedTuple):
    """What can be told of an entity without interpreting it."""

    kind: str
    layer: str
    number: int
    """Of its record in the file."""
    block: str | None
    """Of an INSERT: the key of the block that it places."""


class Block(NamedTuple):
    """A block's definition."""

    name: str
    base: tuple[float, float, float]
    entities: tuple[Entity, ...]
    is_reference: bool
    """Whether it stands for another file."""


class _Spaces(NamedTuple):
    """Entities of the model, and of paper."""

    model: tuple[Entity, ...]
    paper: tuple[Entity, ...]


@dataclass(frozen=True, eq=False)
class DxfFile:
    """The parts of a file that drawings are read from."""

    path: Path
    lines: TagLines
    cleaned: tuple[str, ...]

    @cached_property
    def header(self) -> dict[str, str]:
        """The variables that the file's own HEADER holds."""
        return header_of(self.lines.codes, self.lines.values)

    @cached_property
    def layers(self) -> dict[str, LayerState]:
        """The table of layers by key."""
        found = dict[str, LayerState]()
        for number in self._section("TABLES"):
            if self.lines.kind(number) == "LAYER":
                record = self.lines.record(number)
                name = record.first(2)
                found[layer_key(name)] = LayerState(name, _state(record))
        return found

    @cached_property
    def blocks(self) -> dict[str, Block]:
        """The blocks by key."""
        numbers = list(self._section("BLOCKS"))
        heads = [k for k, number in enumerate(numbers) if self.lines.kind(number) == "BLOCK"]
        found = dict[str, Block]()
        for head, after in pairwise([*heads, len(numbers)]):
            inner = [n for n in numbers[head + 1 : after] if self.lines.kind(n) != "ENDBLK"]
            block = self._block(self.lines.record(numbers[head]), inner)
            found[layer_key(block.name)] = block
        return found

    @cached_property
    def block_units(self) -> dict[str, int]:
        """The units that blocks were drawn in, as $INSUNITS, by key; 0 where a block has none."""
        found = dict[str, int]()
        for number in self._section("TABLES"):
            if self.lines.kind(number) == "BLOCK_RECORD":
                record = self.lines.record(number)
                found[layer_key(record.first(2))] = int(record.first(70, "0") or 0)
        return found

    @cached_property
    def spaces(self) -> _Spaces:
        """The entities of the model and those on paper."""
        model, paper = list[Entity](), list[Entity]()
        for number in self._section("ENTITIES"):
            if self.lines.kind(number) in _SUB_ENTITIES:
                continue
            on_paper = self.lines.value(number, 67) == "1"
            (paper if on_paper else model).append(self._entity(number))
        return _Spaces(tuple(model), tuple(paper))

    def following(self, number: int) -> Iterator[Record]:
        """Give the sub-entities of an entity: a polyline's vertices."""
        for k in range(number + 1, len(self.lines)):
            if self.lines.kind(k) not in _SUB_ENTITIES:
                return
            yield self.lines.record(k)

    def called(self, entity: Entity) -> str:
        """Give how messages call an entity: by its handle, else by its line in the file."""
        record = self.lines.record(entity.number)
        block = f" (block {record.first(2)})" if entity.block is not None else ""
        return f"{entity.kind} {record.first(5) or f'in line {record.line}'}{block}"

    @cached_property
    def said_unit(self) -> tuple[str, float] | None:
        """The unit that the header names, with its size in mm."""
        return INSUNITS.get(self.insunits)

    @cached_property
    def insunits(self) -> int:
        """The number of the header's unit; 0 where it is not there."""
        text = self.header.get("$INSUNITS", "0")
        try:
            return int(float(text))
        except (ValueError, OverflowError):
            return -1

    def _section(self, name: str) -> Iterator[int]:
        """Give the numbers of a section's records."""
        for start, stop in self._sections.get(name, ()):
            yield from range(start, stop)

    @cached_property
    def _sections(self) -> dict[str, list[tuple[int, int]]]:
        found = dict[str, list[tuple[int, int]]]()
        opened: tuple[str, int] | None = None
        for number in range(len(self.lines)):
            kind = self.lines.kind(number)
            if kind == "SECTION":
                opened = (self.lines.value(number, 2) or "").upper(), number + 1
            elif kind == "ENDSEC" and opened is not None:
                found.setdefault(opened[0], []).append((opened[1], number))
                opened = None
        if opened is not None:
            message = f"its section {opened[0]} has no end"
            raise DamagedFile(message)
        if "ENTITIES" not in found:
            message = "it has no section of entities"
            raise DamagedFile(message)
        return found

    def _block(self, head: Record, numbers: list[int]) -> Block:
        flags = int(head.first(70, "0") or 0)
        base = tuple(float(head.first(code, "0") or 0) for code in (10, 20, 30))
        entities = [self._entity(n) for n in numbers if self.lines.kind(n) not in _SUB_ENTITIES]
        return Block(head.first(2), base, tuple(entities), bool(flags & _XREF))  # type: ignore[arg-type]

    def _entity(self, number: int) -> Entity:
        kind = self.lines.kind(number)
        block = layer_key(self.lines.value(number, 2) or "") if kind == "INSERT" else None
        return Entity(kind, self.lines.value(number, 8) or "0", number, block)


def open_dxf(path: Path, field: str) -> tuple[DxfFile, tuple[Note, ...]]:
    """Open a text DXF file, leaving out what stands around the drawing with a note.

    Raises
    ------
    Refused
        E-DXF-FILE for no file, an empty or huge one, a binary one, one that is cut off, or damaged structure.
    OutputFault
        If the system does not let the file be read.
    """
    content = _content(path, field)
    try:
        records = records_of(content)
        file = DxfFile(path, records.text, records.cleaned)
        _ = file.spaces, file.blocks, file.layers
    except DamagedFile as error:
        _refuse(field, f"{path.name} is damaged: {error}", "a complete, sound DXF file", "Save it again as DXF.")
    except ValueError as error:
        _refuse(field, f"{path.name} is damaged ({error})", "sound DXF data", "Save it again as DXF.")
    return file, _recovered(file, field)


def _recovered(file: DxfFile, field: str) -> tuple[Note, ...]:
    if not file.cleaned:
        return ()
    text = f"{file.path.name}: {', '.join(file.cleaned)} left out; the drawing itself is whole"
    return (Note("W-DXF-RECOVERED", field, text),)


def _content(path: Path, field: str) -> bytes:
    if not path.is_file():
        _refuse(field, f"{path} is no file", "an existing DXF file", "Check the name and its folder.")
    size = path.stat().st_size
    if not 0 < size <= LARGEST_FILE:
        _refuse(field, f"{path.name} has {size} bytes", f"1 to {LARGEST_FILE}", "Save the curve alone.")
    try:
        with path.open("rb") as file:
            content = file.read()
    except OSError as error:
        message = f"{path}: {error.strerror}"
        raise OutputFault(message) from error
    if content.startswith(b"AutoCAD Binary DXF"):
        _refuse(field, f"{path.name} is a binary DXF", "a text DXF", "Save it as a text (ASCII) DXF.")
    return content


def _state(layer: Record) -> str:
    if int(layer.first(70, "0") or 0) & 1:
        return "frozen"
    return "off" if int(layer.first(62, "7") or 7) < 0 else ""


def _refuse(field: str, found: str, limit: str, way_out: str) -> NoReturn:
    raise Refused("E-DXF-FILE", field, found, limit, way_out)
