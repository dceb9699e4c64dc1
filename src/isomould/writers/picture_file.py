"""A picture in the format that the file's name asks for."""

from pathlib import Path

from isomould.documents.picture import Picture
from isomould.writers.disk import replace_file
from isomould.writers.svg import svg_text


def write_picture(path: Path, picture: Picture) -> None:
    """Write a picture as SVG or PNG, whole or not at all."""
    if path.suffix.lower() == ".png":
        from isomould.writers.png import png_bytes  # noqa: PLC0415 - Pillow is for PNG alone

        replace_file(path, png_bytes(picture))
    else:
        replace_file(path, svg_text(picture).encode())
