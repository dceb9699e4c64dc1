"""Pages as DXF: those of a book side by side in paper millimetres, a layer per pen; QR codes are in the PDF only.

ezdxf makes the file around the entities; the entities of hundreds of pages are written as tags straight away, which
takes a twentieth of the time of building them one by one.
"""

import math
from functools import singledispatch
from pathlib import Path

import numpy as np
from ezdxf.filemanagement import new

from isomould.documents.shop.font import text_width
from isomould.documents.shop.page import Arc, Book, Code, Item, Line, Pen, Text
from isomould.writers.disk import write_bytes
from isomould.writers.dxf import dxf_bytes, fixed_meta_data

_LAYERS: dict[Pen, tuple[str, str, int]] = {
    "frame": ("FRAME", "CONTINUOUS", 70),
    "outline": ("OUTLINE", "CONTINUOUS", 50),
    "hidden": ("HIDDEN", "DASHED", 25),
    "centre": ("CENTRE", "CENTER", 18),
    "thin": ("DIMENSION", "CONTINUOUS", 18),
}
"""Layer, line type and line weight (1/100 mm) of every pen."""
_TEXT_LAYER, _STYLE = "TEXT", "ISOMOULD"
_BETWEEN = 20.0
_SHARE = {"start": 0.0, "middle": 0.5, "end": 1.0}

Body = tuple[str, str, str]
"""Type, layer and tags of an entity."""


def write_pages(path: Path, book: Book) -> None:
    """Write a book of pages side by side.

    Raises
    ------
    OutputFault
        If the file cannot be written.
    """
    lefts = np.cumsum([0.0, *(page.size[0] + _BETWEEN for page in book.pages)]).tolist()
    placed = [(item, left) for page, left in zip(book.pages, lefts, strict=False) for item in page.items]
    bodies = [_body(item, left) for item, left in placed if not isinstance(item, Code)]
    with fixed_meta_data():
        write_bytes(path, _document(bodies, (lefts[-1], max(page.size[1] for page in book.pages))))


def _document(bodies: list[Body], extent: tuple[float, float]) -> bytes:
    """Let ezdxf write header, tables and objects, and put the entities into their section."""
    document = new("R2010", units=4, setup=["linetypes"])
    document.header["$MEASUREMENT"] = 1
    document.header["$EXTMAX"] = (*extent, 0.0)
    document.styles.add(_STYLE, font="arial.ttf")
    document.layers.add(_TEXT_LAYER, color=7)
    for name, line_type, weight in _LAYERS.values():
        document.layers.add(name, color=7, linetype=line_type, lineweight=weight)
    first, owner = int(document.entitydb.next_handle(), 16), document.modelspace().layout_key
    document.entitydb.handles.reset(f"{first + len(bodies):X}")
    entities = "".join(_entity(first + k, owner, *body) for k, body in enumerate(bodies))
    data = dxf_bytes(document)
    end = data.index(b"  0\nENDSEC", data.index(b"ENTITIES"))
    return data[:end] + document.encode(entities) + data[end:]


def _entity(handle: int, owner: str, kind: str, layer: str, tags: str) -> str:
    head = f"  0\n{kind}\n  5\n{handle:X}\n330\n{owner}\n100\nAcDbEntity\n  8\n{layer}\n"
    return head + tags


@singledispatch
def _body(item: Item, left: float) -> Body:
    """Give type, layer and tags of an item whose page starts at `left`."""
    raise NotImplementedError(type(item).__name__)


@_body.register
def _(item: Line, left: float) -> Body:
    layer, points = _LAYERS[item.pen][0], (item.points + np.array([left, 0.0])).tolist()
    if item.filled:
        corners = zip(range(10, 14), (*points, points[-1]), strict=True)
        tags = "".join(f" {code}\n{x:.4f}\n {code + 10}\n{y:.4f}\n {code + 20}\n0\n" for code, (x, y) in corners)
        return "SOLID", layer, f"100\nAcDbTrace\n{tags}"
    vertices = "".join(f" 10\n{x:.4f}\n 20\n{y:.4f}\n" for x, y in points)
    return "LWPOLYLINE", layer, f"100\nAcDbPolyline\n 90\n{len(points)}\n 70\n{int(item.closed)}\n{vertices}"


@_body.register
def _(item: Arc, left: float) -> Body:
    layer, (x, y) = _LAYERS[item.pen][0], item.centre
    circle = f"100\nAcDbCircle\n 10\n{x + left:.4f}\n 20\n{y:.4f}\n 30\n0\n 40\n{item.radius:.4f}\n"
    if item.end - item.start >= 2 * math.pi:
        return "CIRCLE", layer, circle
    start, end = math.degrees(item.start) % 360, math.degrees(item.end) % 360
    return "ARC", layer, f"{circle}100\nAcDbArc\n 50\n{start:.4f}\n 51\n{end:.4f}\n"


@_body.register
def _(item: Text, left: float) -> Body:
    back = _SHARE[item.anchor] * text_width(item.text, item.height, bold=item.bold)
    x, y = item.at[0] - back * math.cos(item.turn) + left, item.at[1] - back * math.sin(item.turn)
    place = f" 10\n{x:.4f}\n 20\n{y:.4f}\n 30\n0\n 40\n{item.height:.4f}\n  1\n{_plain(item.text)}\n"
    degrees = round(math.degrees(item.turn), 4) + 0.0
    turned = f"{place} 50\n{degrees:.4f}\n  7\n{_STYLE}\n"
    return "TEXT", _TEXT_LAYER, f"100\nAcDbText\n{turned}100\nAcDbText\n"


def _plain(text: str) -> str:
    """Keep a text from being read as control codes: `%%` and `^` start them."""
    return text.replace("%%", "%%%%%%").replace("^", "^ ")
