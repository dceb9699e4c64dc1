"""What is read of a file of any kind, and its picture."""

from pathlib import Path

from isomould.errors import Refused
from isomould.intake.inspect_drawing import inspect_drawing
from isomould.intake.inspect_list import inspect_list
from isomould.intake.inspect_picture import drawing_picture
from isomould.intake.inspection import Inspection, is_drawing
from isomould.intake.read import Asked
from isomould.units import LengthUnit
from isomould.writers.disk import replace_file
from isomould.writers.svg import svg_text


def inspect_file(
    path: Path, layer: str | None, units: LengthUnit | None, join: float | None, out: Path | None
) -> Inspection:
    """Say what is read of a drawing, a model or a part list, and draw its curves where `out` names a picture.

    Raises
    ------
    Refused
        E-DRAW-FILE, E-INSPECT-PICTURE and E-INSPECT-JOIN for what was asked; what else the file's own readers raise.
    OutputFault
        If the file cannot be read, or the picture not be written.
    """
    _refuse_asked(path, join, out)
    if not is_drawing(path):
        return inspect_list(path, Asked(units=units, layer=layer, join=join))
    found = inspect_drawing(path, layer, units, join)
    if out is not None:
        replace_file(out, svg_text(drawing_picture(found)).encode())
    return found


def _refuse_asked(path: Path, join: float | None, out: Path | None) -> None:
    if out is not None and out.suffix.lower() != ".svg":
        raise Refused("E-DRAW-FILE", "--out", str(out), "a file that ends in .svg", "Write --out picture.svg.")
    if out is not None and not is_drawing(path):
        way_out = "Leave it out, or inspect the drawing of one part."
        found = f"a picture of the list {path.name}"
        raise Refused("E-INSPECT-PICTURE", "--out", found, "drawings and models", way_out)
    if join is not None and not join > 0:
        raise Refused("E-INSPECT-JOIN", "--join", f"{join:g} mm", "a length above 0", "Say --join 0.1mm.")
