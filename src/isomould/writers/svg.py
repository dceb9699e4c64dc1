"""Pictures as SVG: plain shapes, no styles, no scripts, the same bytes every time."""

from xml.sax.saxutils import escape, quoteattr

from isomould.arrays import Floats
from isomould.documents.numbers import format_number
from isomould.documents.picture import INK, Caption, Dot, Item, Picture, Shape

_DECIMALS = 2


def svg_text(picture: Picture) -> str:
    """Give the text of a picture; points become pixels, y turns downwards."""
    width, height = (format_number(size, _DECIMALS) for size in (picture.width, picture.height))
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}" '
        f'font-family="sans-serif" stroke-linejoin="round">'
    )
    ground = f'<rect width="{width}" height="{height}" fill="#ffffff"/>'
    body = [_item(item, picture.height) for item in picture.items]
    return "\n".join([head, f"<title>{escape(picture.title)}</title>", ground, *body, "</svg>", ""])


def _item(item: Item, height: float) -> str:
    if isinstance(item, Shape):
        return _shape(item, height)
    return _dot(item, height) if isinstance(item, Dot) else _caption(item, height)


def _shape(shape: Shape, height: float) -> str:
    stroke = f' stroke="{shape.stroke}" stroke-width="{_number(shape.width)}"' if shape.stroke else ""
    clear = f' fill-opacity="{_number(shape.opacity)}"' if shape.opacity < 1 else ""
    path = f"{_path(shape.points, height)}{'Z' if shape.closed else ''}"
    return f'<path d="{path}" fill="{shape.fill or "none"}"{clear}{stroke}/>'


def _path(points: Floats, height: float) -> str:
    return "M" + "L".join(f"{_number(x)} {_number(height - y)}" for x, y in points.tolist())


def _dot(dot: Dot, height: float) -> str:
    x, y = dot.centre
    return f'<circle cx="{_number(x)}" cy="{_number(height - y)}" r="{_number(dot.radius)}" fill="{dot.fill}"/>'


def _caption(caption: Caption, height: float) -> str:
    x, y = caption.position
    anchor = "" if caption.anchor == "start" else f" text-anchor={quoteattr(caption.anchor)}"
    place = f'x="{_number(x)}" y="{_number(height - y)}" font-size="{_number(caption.size)}" fill="{INK}"{anchor}'
    return f"<text {place}>{escape(caption.text)}</text>"


def _number(value: float) -> str:
    return format_number(value, _DECIMALS)
