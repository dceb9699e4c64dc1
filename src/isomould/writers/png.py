"""Pictures as PNG, for whoever cannot use SVG: the only importer of Pillow."""

import io
from pathlib import Path

from PIL import Image, ImageDraw, ImageFont

from isomould.documents.picture import INK, Caption, Dot, Item, Picture, Shape

_FONT = Path(__file__).parents[1] / "documents" / "shop" / "fonts" / "DejaVuSans.ttf"
_SCALE = 2
"""Pixels per point."""
_FINER = 2
"""The picture is painted so many times larger and made smaller, which smooths its edges."""

_ANCHORS = {"start": "ls", "middle": "ms", "end": "rs"}


def png_bytes(picture: Picture) -> bytes:
    """Give the bytes of a picture, two pixels per point; the same picture gives the same bytes."""
    scale = _SCALE * _FINER
    size = (round(picture.width * scale), round(picture.height * scale))
    image = Image.new("RGB", size, "#ffffff")
    canvas = _Canvas(ImageDraw.Draw(image, "RGBA"), scale, picture.height)
    for item in picture.items:
        canvas.paint(item)
    smaller = image.resize((size[0] // _FINER, size[1] // _FINER), Image.Resampling.BOX)
    buffer = io.BytesIO()
    smaller.save(buffer, "PNG", optimize=True)
    return buffer.getvalue()


class _Canvas:
    """Paints items of a picture, whose y runs upwards."""

    def __init__(self, draw: ImageDraw.ImageDraw, scale: float, height: float) -> None:
        self.draw, self.scale, self.height = draw, scale, height

    def paint(self, item: Item) -> None:
        """Paint an item over what is there."""
        if isinstance(item, Shape):
            self._shape(item)
        elif isinstance(item, Dot):
            self._dot(item)
        else:
            self._caption(item)

    def _at(self, x: float, y: float) -> tuple[float, float]:
        return x * self.scale, (self.height - y) * self.scale

    def _shape(self, shape: Shape) -> None:
        points = [self._at(x, y) for x, y in shape.points.tolist()]
        if shape.fill is not None and len(points) > 2:
            self.draw.polygon(points, fill=_with_alpha(shape.fill, shape.opacity))
        if shape.stroke is not None:
            path = [*points, points[0]] if shape.closed else points
            width = max(1, round(shape.width * self.scale))
            self.draw.line(path, fill=shape.stroke, width=width, joint="curve")

    def _dot(self, dot: Dot) -> None:
        x, y = self._at(*dot.centre)
        radius = dot.radius * self.scale
        self.draw.ellipse((x - radius, y - radius, x + radius, y + radius), fill=dot.fill)

    def _caption(self, caption: Caption) -> None:
        font = ImageFont.truetype(str(_FONT), round(caption.size * self.scale))
        place = self._at(*caption.position)
        self.draw.text(place, caption.text, fill=INK, font=font, anchor=_ANCHORS[caption.anchor])


def _with_alpha(colour: str, opacity: float) -> tuple[int, int, int, int]:
    red, green, blue = (int(colour[k : k + 2], 16) for k in (1, 3, 5))
    return red, green, blue, round(255 * opacity)
