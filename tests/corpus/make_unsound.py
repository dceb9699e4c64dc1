"""Draw what must not be read as one curve: `python make_unsound.py FOLDER`."""

import sys
from pathlib import Path

import ezdxf

AT = {"layer": "RAIL"}


def saved(folder, name, *lines):
    document = ezdxf.new("R12")
    document.header["$INSUNITS"] = 4
    for start, end in lines:
        document.modelspace().add_line(start, end, dxfattribs=AT)
    document.saveas(folder / f"{name}.dxf")
    return (folder / f"{name}.dxf").read_text()


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    a, b, c = (0, 0), (1234.5, 0), (2000, 700.25)
    text = saved(folder, "gap-of-1", (a, b), ((1235.5, 0), c))
    saved(folder, "branch", (a, b), (b, c), (b, (1234.5, 800)))
    saved(folder, "doubled", (a, b), (b, a))
    saved(folder, "inside-another", (a, b), (b, (300, 0)))
    saved(folder, "two-apart", (a, b), ((0, 900), (800, 900)))
    saved(folder, "only-a-dot", (a, a))
    saved(folder, "uneven", ((0, 0, 0), (1234.5, 0, 0)), ((1234.5, 0, 0), (2000, 700.25, 35)))
    (folder / "decimal-commas.dxf").write_text(text.replace("1234.5", "1234,5"))
    (folder / "cut-off.dxf").write_text(text[: text.index("2000")])
    (folder / "not-a-number.dxf").write_text(text.replace("1234.5", "nan"))
    (folder / "beyond-the-earth.dxf").write_text(text.replace("1234.5", "1e300"))
