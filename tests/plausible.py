"""Random projects such as an office would draw up: every kind of surface, detail and option, built in seconds.

A project is made from its number alone, so that a fault is found again by it. Sizes belong together as a designer
chooses them: edges of 1 to 2.5 m, members of 120 to 250 mm depth, seats as wide as gaps and bearings need.
"""

from collections.abc import Callable
from random import Random
from typing import Any

Tables = dict[str, Any]

PRICES = {
    "node_set_up": 350,
    "node_run": 28.5,
    "node_steel": 1.9,
    "slot": 6,
    "weld": 22,
    "coating": 18,
    "panel_cut": 3.2,
}
TIMES = {"hours_node": 0.4, "hours_panel": 0.25, "assembly": 58, "transport": 120, "overhead": 12, "margin": 8}
RATES = {**PRICES, **TIMES, "saw_cut": 4, "glass": 90, "steel": 1.4, "waste_panels": 12, "bolt": 1.1, "cap": 14}
RHS = ("RHS 120x60x5", "RHS 140x80x6", "RHS 100x50x4", "SHS 100x100x5")
SITE = {"origin": ["691608.123 m", "5334765.4567 m", "519.25 m"], "rotation_deg": 33.5}


def vault(random: Random) -> Tables:
    """An isogonal vault over a waved or arched generatrix."""
    nodes = random.randint(3, 5)
    span = nodes * random.uniform(1400, 2000)
    return {
        "rail": {
            "curve": _arch(random, span),
            "plane": random.choice(["xz", "xz", "xy"]),
            "outside": [0, 1],
            "divide": {"nodes": nodes},
        },
        "generatrix": _long(random),
        "surface": {"kind": "isogonal"},
    }


def tower(random: Random) -> Tables:
    """A closed isogonal rail, all round, with a bulging generatrix."""
    radius = random.uniform(2500, 4500)
    round_ = {"kind": "circle", "radius": radius}
    oval = {"kind": "ellipse", "semi_axes": [radius, radius * random.uniform(0.75, 0.95)]}
    height = random.uniform(3000, 6000)
    return {
        "rail": {
            "curve": random.choice([round_, oval]),
            "outside": "outer",
            "divide": {"nodes": random.choice([8, 10, 12])},
        },
        "generatrix": {
            "curve": {"kind": "arc", "span": height, "rise": height * random.uniform(0.06, 0.14)},
            "axes": "zd",
            "divide": {"nodes": random.randint(2, 4)},
        },
        "surface": {"kind": "isogonal"},
    }


def moulding(random: Random) -> Tables:
    """A moulding surface by stations along both curves."""
    stations = random.randint(4, 7)
    return {
        "rail": {
            "curve": _arch(random, stations * random.uniform(1300, 1900)),
            "plane": "xz",
            "outside": [0, 1],
            "divide": {"stations": stations},
        },
        "generatrix": {**_long(random), "divide": {"stations": random.randint(3, 6)}},
        "surface": {"kind": "moulding"},
    }


def edge_offset(random: Random) -> Tables:
    """An edge offset vault."""
    project = vault(random)
    waves = {
        "kind": "sine",
        "amplitude": random.uniform(300, 700),
        "wavelength": random.uniform(7000, 10_000),
        "waves": 1,
    }
    project["generatrix"] |= {"curve": waves, "divide": {"phase": random.choice(["centre", "node"])}}
    project["generatrix"].pop("flat_nodes", None)
    return project | {"surface": {"kind": "edge-offset"}}


def dome(random: Random) -> Tables:
    """An edge offset dome on an upright spline, cut by the ground."""
    scale = random.uniform(420, 560)
    points = ((-9, -4.5), (-8.4, 0.2), (-4, 3.9), (4, 3.9), (8.4, 0.2), (9, -4.5))
    return {
        "rail": {
            "curve": {"kind": "bspline", "points": [[scale * x, scale * y] for x, y in points]},
            "plane": "xz",
            "outside": [0, 1],
            "divide": {"nodes": 8},
        },
        "generatrix": {
            "curve": {"kind": "parabola", "span": 17.47 * scale, "rise": 4.1 * scale},
            "origin": [-4.1 * scale, 0],
            "axes": "zd",
            "divide": {"phase": "centre"},
        },
        "surface": {
            "kind": "edge-offset",
            "trim": [{"plane": {"z": random.uniform(-300, 300)}, "keep": "above"}],
            "sill": random.random() < 0.6,
        },
    }


def monge(random: Random) -> Tables:
    """A vault over a rail in space."""
    points, x = list[list[float]](), 0.0
    for _ in range(random.randint(4, 5)):
        points.append([x, random.uniform(-700, 700), random.uniform(0, 900)])
        x += random.uniform(1800, 2600)
    kind = random.choice(["polyline", "spline"])
    divide = {"divide": {"stations": len(points)}} if kind == "spline" else {}
    return {
        "rail": {"curve": {"kind": kind, "points": points}, "up": [0, 0, 1], **divide},
        "generatrix": {
            "curve": {"kind": "arc", "span": random.uniform(4500, 6500), "rise": random.uniform(700, 1300)},
            "outside": [0, 1],
            "divide": {"nodes": random.randint(2, 4)},
        },
        "surface": {"kind": "monge"},
    }


def family(random: Random) -> Tables:
    """Two vaults of one kit of nodes, with classes in unequal numbers."""
    radius, height = random.uniform(3200, 4200), random.uniform(1.05, 1.3)
    other = {"kind": "ellipse", "semi_axes": [radius * 0.9, radius * height], "start_deg": 0, "end_deg": 180}
    waves = {"kind": "sine", "amplitude": random.uniform(300, 500), "wavelength": 9000}
    longer = {"generatrix": {"curve": {**waves, "waves": 1.5}, "axes": "zd", "divide": {"per_arc": 2}}}
    return {
        "rail": {
            "curve": {"kind": "arc", "radius": radius, "start_deg": 0, "end_deg": 180},
            "plane": "xz",
            "outside": [0, 1],
            "divide": {"angle_deg": 30, "first_deg": 90},
        },
        "generatrix": {"curve": {**waves, "waves": 1}, "axes": "zd", "divide": {"per_arc": 2}},
        "surface": {"kind": "isogonal"},
        "shapes": [{"name": "Tall one", "rail": {"curve": other}, **longer}],
    }


KINDS: dict[str, Callable[[Random], Tables]] = {
    "vault": vault,
    "tower": tower,
    "moulding": moulding,
    "edge-offset": edge_offset,
    "dome": dome,
    "monge": monge,
    "family": family,
}


def plausible(number: int) -> tuple[str, Tables]:
    """Give the kind and the tables of the project with this number; kinds and details come in turn."""
    random = Random(number)
    kind = list(KINDS)[number % len(KINDS)]
    shape = KINDS[kind](random)
    detail = ("slotted", "faceted", "finned", "capped")[number // len(KINDS) % 4]
    section, parts = _parts(random, detail, trimmed="trim" in shape["surface"])
    stock = {"stock": _stock(random, section, parts)} if random.random() < 0.8 else {}
    costs = {"costs": dict(random.sample(sorted(RATES.items()), random.randint(3, len(RATES))))}
    return kind, {
        "schema": 1,
        "project": _info(random, number),
        **shape,
        **parts,
        "tolerances": {"min_member": 100, **_some(random, length=[0.2, 1.0], angle_deg=[0.02, 0.2])},
        **stock,
        **(costs if random.random() < 0.5 else {}),
        "deliver": _deliver(random, shape, kind),
    }


def _some(random: Random, **choices: list[Any]) -> Tables:
    """Choose about a third of the keys, and one of their values each."""
    return {key: random.choice(values) for key, values in choices.items() if random.random() < 0.35}


def _arch(random: Random, span: float) -> Tables:
    rise = span * random.uniform(0.15, 0.32)
    curves = [
        {"kind": "parabola", "span": span, "rise": rise},
        {"kind": "arc", "span": span, "rise": rise},
        {"kind": "catenary", "span": span, "rise": rise},
        {"kind": "bspline", "points": [[-span / 2, 0], [-span / 3, rise], [span / 3, rise * 1.1], [span / 2, 0]]},
    ]
    return random.choice(curves)


def _long(random: Random) -> Tables:
    length = random.uniform(5000, 9000)
    if random.random() < 0.5:
        waves = {"kind": "sine", "amplitude": random.uniform(250, 500), "wavelength": length, "waves": 1}
        return {
            "curve": waves,
            "axes": "zd",
            "divide": {"per_arc": random.randint(2, 3)},
            **_some(random, flat_nodes=[True]),
        }
    arch = {"kind": "arc", "span": length, "rise": length * random.uniform(0.05, 0.12)}
    return {"curve": arch, "axes": "zd", "divide": {"nodes": random.randint(2, 4)}}


def _parts(random: Random, detail: str, *, trimmed: bool) -> tuple[str, Tables]:
    """Give the members' section as stock names it, and the tables of members, nodes and panels."""
    depth, thickness = random.choice([120, 150, 160, 180]), random.choice([8, 10, 12])
    hollow = random.choice(RHS)
    section = hollow if detail == "faceted" else f"FL {depth}x{thickness}"
    sill = {"sill": random.choice(["FL 120x10", "FL 100x10"])} if trimmed else {}
    nodes = {
        "slotted": {"detail": "slotted", **_some(random, slot_end=["round"], clearance=[0.3, 1.0], min_web=[8])},
        "capped": {"detail": "slotted", "retention": "lipped-cap", "hardware": {"bolt": random.choice(["M12", "M16"])}},
        "faceted": {"detail": "faceted", **_some(random, end_plate=[10, 15], facet_border=[5], facet_cover=[5])},
        "finned": {"detail": "finned", **_some(random, bolt_rows=[1, 2], fin_thickness=[6, 10], weld_access=[15])},
    }[detail]
    bore = {"bore": 20 if detail == "capped" else random.choice([0, 20, 25])}
    base = {"base_plate": random.choice([{}, {"holes": 6, "margin": 80}])} if trimmed and random.random() < 0.3 else {}
    return section, {
        "members": {"section": section, **sill, **_some(random, grade=["S235", "S355J2"], min_clear=[80])},
        "nodes": {**nodes, **bore, **base, **_some(random, diameter_step=[1, 10], end_gap=[1, 3])},
        "panels": _panels(random, detail),
    }


def _panels(random: Random, detail: str) -> Tables:
    coating = random.choice(["none", "none", "inside", "outside"])
    flat = {"flippable": True} if coating == "none" and random.random() < 0.2 else {}
    edges = {"edge_deduction": {"boundary": 5, "cut": 3}} if random.random() < 0.2 else {}
    return {
        "thickness": random.choice([8, 10, 12, 13.5]),
        "gap": random.choice([12, 15, 20]),
        "seat_width": random.choice([60, 70, 80]),
        "seat_height": {"slotted": 10, "faceted": 15, "finned": 15, "capped": 24}[detail],
        "coating": coating,
        **flat,
        **edges,
        **_some(
            random, spacer=[3, 5], edge_overhang=[20, 40], makeup=["2 × 6 mm, laminated"], orientation_mark=[False]
        ),
    }


def _stock(random: Random, section: str, parts: Tables) -> Tables:
    sheets = [
        {"name": "Jumbo", "width": "6 m", "height": "3.21 m", "price": 510},
        {"name": "Half", "width": "3.21 m", "height": "3 m", "price": 260, **_some(random, grain=[True], quantity=[2])},
    ][: random.randint(0, 2)]
    names = {section, parts["members"].get("sill", section)}
    bars = [{"section": _designation(name), "length": "6 m", "price": 90} for name in sorted(names)]
    gap = random.choice([0, 5, 8])
    way = {"turn_over": True} if parts["panels"]["coating"] == "none" and random.random() < 0.2 else {}
    return {
        "gap": gap,
        "kerf": min(gap, 3),
        "trim": random.choice([0, 15, 20]),
        "bar_kerf": 3,
        "bar_trim": 10,
        **({"sheets": sheets} if sheets else {"max_blank_length": "9 m"}),
        **({"bars": bars} if random.random() < 0.7 else {}),
        **way,
        **_some(random, bar_ends=["head-to-tail"], turning=["half", "none"], guillotine=[False]),
    }


def _designation(name: str) -> str:
    """Write a section as schedules name it: `FL 120x10` is `FL120*10`."""
    return name.replace(" ", "").replace("x", "*")


def _info(random: Random, number: int) -> Tables:
    names = ["Hofüberdachung", "Courtyard roof", "Kryta ulica Łódź", "Αίθριο", "Atrium № 7"]
    about = _some(
        random, number=["2026-101"], client=["Müller & Söhne"], revision=["B"], phase=["2"], drawing=["S-100"]
    )
    datum = {"datum": SITE} if random.random() < 0.3 else {}
    return {"name": f"{random.choice(names)} {number}", **about, **datum}


def _deliver(random: Random, shape: Tables, kind: str) -> Tables:
    """Ask for what the surface has: strips, second layers and comparisons of whole surfaces alone."""
    whole = "trim" not in shape["surface"] and kind not in {"monge", "family"}
    layer = {"offset": "vertex", "distance": random.choice([-600, 400])}
    extras = _some(random, strips=[["generatrix"], ["generatrix", "parallel"]]) if whole else {}
    extras |= _some(random, double_layer=[layer]) if kind == "vault" else {}
    return {
        "drawings": random.random() < 0.15,
        **extras,
        **({"compare": True} if whole and random.random() < 0.1 else {}),
        **_some(random, dxf=[["R2010", "R12"]], labels=[True], nc1_mass=["kg/m2"], solids=[["members"], ["panels"]]),
        **_some(random, layers=[{"CUT": "SCHNITT", "ENGRAVE": "TEXT"}], paper=["A3"]),
    }
