"""A museum of named designs for tests: the oracles of the mathematics and the shapes of the paper."""

import json
import tomllib
from pathlib import Path
from typing import Any

from isomould.design import Design, Sketch, make_design, sketch
from isomould.project.load import validate

TEMPLATES = Path(__file__).parents[1] / "templates"

VAULT: dict[str, Any] = {
    "schema": 1,
    "project": {"name": "Oracle C"},
    "rail": {
        "curve": {"kind": "parabola", "span": "20 m", "rise": "7.5 m"},
        "plane": "xz",
        "outside": [0, 1],
        "divide": {"nodes": 18},
        "ends": "square",
    },
    "generatrix": {
        "curve": {"kind": "sine", "amplitude": "1 m", "wavelength": "12 m", "waves": 2},
        "axes": "zd",
        "divide": {"per_arc": 7},
        "flat_nodes": True,
    },
    "surface": {"kind": "isogonal"},
}
"""Oracle C: 33 × 20 nodes, 8 regular interior classes and 1 flat."""

EDGE_OFFSET_VAULT = {
    **VAULT,
    "rail": {**VAULT["rail"], "ends": "mitred"},
    "generatrix": {**VAULT["generatrix"], "divide": {"phase": "centre"}},
    "surface": {"kind": "edge-offset"},
}
"""Oracle D: the same curves with the slopes of an edge offset mesh."""


def sphere(angle_deg: float, band_deg: float, radius: float = 10_000.0) -> dict[str, Any]:
    """Oracle A: an edge offset sphere between the latitudes ±band."""
    return {
        "schema": 1,
        "project": {"name": "Oracle A"},
        "rail": {
            "curve": {"kind": "circle", "radius": radius},
            "outside": "outer",
            "divide": {"angle_deg": angle_deg},
        },
        "generatrix": {
            "curve": {"kind": "arc", "radius": radius, "start_deg": -band_deg, "end_deg": band_deg},
            "origin": [-radius, 0],
            "divide": {"phase": "centre"},
        },
        "surface": {"kind": "edge-offset"},
        "tolerances": {"min_member": 1},
        "members": {"section": {"kind": "plate", "depth": 60, "thickness": 6}},
        "nodes": {"diameter_step": 1},
        "panels": {"seat_width": 50, "gap": 8, "thickness": 6},
        "limits": {"max_panels": 5000},
    }


SMALL: dict[str, Any] = {
    "schema": 1,
    "project": {"name": "Small", "number": "1", "revision": "0"},
    "rail": {
        "curve": {"kind": "parabola", "span": "8 m", "rise": "2.4 m"},
        "plane": "xz",
        "outside": [0, 1],
        "divide": {"nodes": 4},
    },
    "generatrix": {
        "curve": {"kind": "sine", "amplitude": "0.4 m", "wavelength": "9 m", "waves": 1},
        "axes": "zd",
        "divide": {"per_arc": 3},
    },
    "stock": {
        "gap": 5,
        "kerf": 2,
        "trim": 10,
        "bar_kerf": 3,
        "bar_trim": 10,
        "sheets": [{"name": "Sheet", "width": "4 m", "height": "2.5 m", "price": 100}],
        "bars": [{"section": "FL200*12", "length": "6 m", "price": 80}],
    },
    "costs": {
        "node_set_up": 350,
        "node_run": 28.5,
        "node_steel": 1.9,
        "slot": 6,
        "weld": 22,
        "coating": 18,
        "panel_cut": 3.2,
        "saw_cut": 4,
        "hours_node": 0.4,
        "hours_panel": 0.25,
        "assembly": 58,
        "transport": 120,
        "erect_panel": 65,
        "overhead": 12,
        "margin": 8,
    },
    "deliver": {"strips": ["generatrix", "parallel"]},
}
"""A vault of 8 × 6 nodes with sheets, bars and strips: quick to build, everything in it."""

FAMILY: dict[str, Any] = {
    "schema": 1,
    "project": {"name": "Family"},
    "rail": {
        "curve": {"kind": "arc", "radius": 4000, "start_deg": 0, "end_deg": 180},
        "plane": "xz",
        "outside": [0, 1],
        "divide": {"angle_deg": 30, "first_deg": 90},
    },
    "generatrix": {**SMALL["generatrix"], "divide": {"per_arc": 2}},
    "shapes": [
        {
            "name": "Tall one",
            "rail": {"curve": {"kind": "ellipse", "semi_axes": [3500, 5000], "start_deg": 0, "end_deg": 180}},
        }
    ],
}
"""Two vaults of one kit of nodes: half a circle and half an ellipse."""

MONGE: dict[str, Any] = {
    "schema": 1,
    "project": {"name": "Monge"},
    "rail": {
        "curve": {
            "kind": "polyline",
            "points": [
                [0, 0, 0],
                [3000, 900, 500],
                [6000, 1100, 1300],
                [9000, 300, 1700],
                [12000, -900, 1500],
                [15000, -1300, 800],
                [18000, -900, 500],
            ],
        },
        "up": [0, 0, 1],
    },
    "generatrix": {
        "curve": {"kind": "arc", "span": 5000, "rise": 1200},
        "outside": [0, 1],
        "divide": {"nodes": 4},
    },
    "surface": {"kind": "monge"},
}
"""A vault of 6 × 7 nodes over a polyline in space."""


def template(name: str) -> dict[str, Any]:
    """Give the tables of a template."""
    return tomllib.loads((TEMPLATES / f"{name}.toml").read_text(encoding="utf-8"))


def dome(radius: float, nodes: int = 8, scale: float = 1.0) -> dict[str, Any]:
    """Oracle F: a dome on an upright spline; `radius` (m, scaled too) is the generatrix's at the apex. Untrimmed."""
    points = ((-9, -4.5), (-8.4, 0.2), (-4, 3.9), (4, 3.9), (8.4, 0.2), (9, -4.5))
    rise = 4.1
    span = 2 * (2 * radius * rise) ** 0.5
    return {
        "schema": 1,
        "project": {"name": "Dome"},
        "rail": {
            "curve": {"kind": "bspline", "units": "m", "points": [[scale * x, scale * y] for x, y in points]},
            "plane": "xz",
            "outside": [0, 1],
            "divide": {"nodes": nodes},
        },
        "generatrix": {
            "curve": {"kind": "parabola", "span": 1000 * scale * span, "rise": 1000 * scale * rise},
            "origin": [-1000 * scale * rise, 0],
            "axes": "zd",
            "divide": {"phase": "centre"},
        },
        "surface": {"kind": "edge-offset"},
        "members": {"section": {"kind": "plate", "depth": 120, "thickness": 10}},
        "panels": {"gap": 12, "seat_width": 50, "thickness": 10},
    }


HALL = {"sheets": [{"name": "Hall", "width": "100 m", "height": "100 m"}]}
"""Sheets so large that all panels of a test fit on one: the fewest files to write and read."""


BARE = {"drawings": False, "strips": []}
"""For deliveries in tests of something else: no shop drawings, no strips."""


def trimmed(data: dict[str, Any], *planes: dict[str, Any], sill: bool = True) -> dict[str, Any]:
    """Give a project cut by planes, by default the ground."""
    ground = {"plane": {"z": 0}, "keep": "above"}
    return changed(data, surface={"trim": list(planes or (ground,)), "sill": sill})


def design(data: dict[str, Any], folder: Path = TEMPLATES) -> Design:
    """Compute a design from the tables of a project."""
    return make_design(validate(data, "museum"), folder)


def sketched(data: dict[str, Any]) -> Sketch:
    """Compute a design without its parts, in a fraction of the time."""
    return sketch(validate(data, "museum"), TEMPLATES)


def changed(data: dict[str, Any], **tables: dict[str, Any]) -> dict[str, Any]:
    """Give a project with some keys of some tables replaced."""
    return {**data, **{name: {**data.get(name, {}), **keys} for name, keys in tables.items()}}


UTM = {"origin": ["691608.123 m", "5334765.4567 m", "519.25 m"], "rotation_deg": 33.5}
"""A datum far from the project's origin."""

DELIVERED = changed(
    SMALL,
    project={"number": "A-7", "drawing": "Süd № 2", "phase": "1", "datum": UTM},
    deliver={"dxf": ["R2010", "R12"], "nc1_mass": "kg/m2"},
)
"""What the session's delivered folder is made of: all that machines and the site get."""


def write_project(path: Path, data: dict[str, Any]) -> Path:
    """Write the tables of a project as TOML."""
    path.write_text("".join(_lines(data)), encoding="utf-8")
    return path


def _lines(data: dict[str, Any]) -> list[str]:
    plain = [f"{key} = {_toml(value)}\n" for key, value in data.items() if not isinstance(value, dict)]
    tables = [(key, value) for key, value in data.items() if isinstance(value, dict)]
    rows = [[f"\n[{key}]\n", *(f"{k} = {_toml(v)}\n" for k, v in table.items())] for key, table in tables]
    return [*plain, *(line for row in rows for line in row)]


def _toml(value: object) -> str:
    """Write a value on one line; JSON strings, numbers and booleans are TOML too."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key} = {_toml(inner)}" for key, inner in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(_toml(inner) for inner in value) + "]"
    return json.dumps(value)
