"""The NC1 file of a member, line by line from the arithmetic of `worked_by_hand`."""

from worked_by_hand import DEPTH, GRADE, SECTION, STEEL, THICK, member_outline, rounded
from worked_rows import first_of, member_classes, member_row

NUMBER = "2026-014"
HEIGHT = 20.0
"""Of the mark: the tallest letters, which find room below the top edge."""


def nc1_file(i, j, di, dj):
    """Lines of the file of the class of a member."""
    row = member_row(i, j, di, dj)
    outline = rounded(member_outline(*first_of(member_classes(), (i, j, di, dj))))
    left, bottom = (min(axis) for axis in zip(*outline, strict=True))
    corners = [(x - left, y - bottom) for x, y in outline]
    body = max(corners[0][0], corners[len(corners) // 2 - 1][0])  # top and bottom edge both have begun there
    contour = [_point(*corner, 0.0) for corner in [*corners, corners[0]]]
    stamp = f"{_point(body + HEIGHT, DEPTH - 2 * HEIGHT, 0.0)}{HEIGHT:6.1f}r{row['mark']}"
    return ["ST", *_header(row), "AK", *contour, "SI", stamp, "EN"]


def _header(row):
    cut, per_metre, paint = row["cut_length_mm"], DEPTH * THICK * STEEL / 1e6, 2 * (DEPTH + THICK) / 1e3
    angles = [row[f"end_angle_{end}_deg"] for end in ("start", "end")]
    words = [NUMBER, "-", "-", row["mark"], GRADE, str(row["quantity"]), SECTION, "B", f"{cut:10.2f},{cut:10.2f}"]
    words += [f"{size:10.2f}" for size in (DEPTH, THICK, THICK, THICK, 0, per_metre, paint, 0, 0, 0, 0)]
    words += ["TOP {top_length_mm:.2f} BOTTOM {bottom_length_mm:.2f}".format_map(row)]
    words += ["END CUTS {:.2f} {:.2f} DEG, IN CONTOUR".format(*angles), "START LEFT, OUTSIDE UP", "-"]
    return ["  " + word for word in words]


def _point(x, y, value):
    return f"  v {x:10.2f}u{y:10.2f}{value:10.2f}"
