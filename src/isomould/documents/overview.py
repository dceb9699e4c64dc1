"""Key figures and the checks made while building: what `check` prints and the first and last sheets show."""

from collections.abc import Sequence

import numpy as np

from isomould.documents.numbers import round_to
from isomould.documents.table import Table, make_table
from isomould.form.mesh import NodeKind
from isomould.nesting.layout import BarLayout, Layout
from isomould.parts.details.joint import tightest
from isomould.parts.kit import Kit
from isomould.parts.solid import Solid
from isomould.ties import FINE, first_largest

Fact = tuple[str, float, str]
"""Item, value, unit; values are rounded for people to read."""

_DECIMALS = 6


def kit_facts(kit: Kit) -> tuple[Fact, ...]:
    """Counts, classes by kind, and how well beams meet."""
    mesh, nodes = kit.mesh, kit.nodes
    facts = (
        ("Parallels", mesh.shape[0], ""),
        ("Generatrices", mesh.shape[1], ""),
        ("Nodes", len(mesh.nodes), ""),
        *_node_facts(kit),
        ("Members", len(mesh.edges), ""),
        ("Member classes", len(kit.members.marks), ""),
        ("Panels", len(mesh.face_ij), ""),
        ("Panel classes", len(kit.panels.marks), ""),
        ("Drum diameter", kit.joints[0].diameter, "mm"),
        *((f"Tightest {name}", value, "mm") for name, value, _ in tightest(kit.joints)),
        ("Largest beam mismatch", float(kit.mismatch.max()), "mm"),
        ("Largest beam mismatch at regular inner nodes", _inner_mismatch(kit), "mm"),
        ("Smallest bearing of a panel", float(kit.panels.bearing.min()), "mm"),
        ("Panel undersides above the mesh", kit.panels.underside, "mm"),
        ("Chiral node classes", sum(hand != "none" for hand in nodes.handed), ""),
    )
    return _rounded(facts)


def _rounded(facts: Sequence[Fact]) -> tuple[Fact, ...]:
    """Round measured values; counts stay whole numbers."""
    return tuple((item, value if isinstance(value, int) else _round(value), unit) for item, value, unit in facts)


def _round(value: float) -> float:
    return float(round_to(np.array([value]), _DECIMALS)[0])


def _node_facts(kit: Kit) -> tuple[Fact, ...]:
    """Node classes by kind: the regular ones are the inner ones that are not flat."""
    words = {NodeKind.INTERIOR: "regular interior", NodeKind.FLAT: "flat", NodeKind.BOUNDARY: "boundary"}
    words |= {NodeKind.SUPPORT: "support"} if (kit.nodes.kind == NodeKind.SUPPORT).any() else {}
    counts = [(word, int(np.count_nonzero(kit.nodes.kind == kind))) for kind, word in words.items()]
    return (
        ("Node classes", len(kit.nodes.marks), ""),
        *((f"Node classes, {word}", count, "") for word, count in counts),
    )


def _inner_mismatch(kit: Kit) -> float:
    inner = kit.mismatch[kit.mesh.kind == NodeKind.INTERIOR]
    return float(inner.max()) if len(inner) else 0.0


def layout_facts(sheets: Layout, bars: BarLayout | None) -> tuple[Fact, ...]:
    """Sheets and bars with their lower bounds."""
    facts = [
        ("Sheets", len(sheets.sheets), ""),
        (f"Lower bound of sheets ({sheets.bound_kind})", sheets.bound, ""),
        ("Yield of sheets", sheets.yield_percent, "%"),
    ]
    if bars is not None:
        facts += [("Bars", len(bars.bars), ""), (f"Lower bound of bars ({bars.bound_kind})", bars.bound, "")]
    return _rounded(facts)


def build_checks(kit: Kit, solids: tuple[Solid, ...], sheets: Layout) -> Table:
    """Give the checks that the makers ran; the certificate repeats them on the written files and adds its own."""
    rows = [
        _row("V1", "panels are planar", kit.panels.flatness, kit.panels.locations, 1e-6, "mm"),
        _row("V6", "nodes are torsion-free", np.degrees(kit.torsion), kit.nodes.locations, 0.01, "°"),
        _row(
            "V21",
            "solids: inclusion and exclusion",
            [s.inclusion_exclusion for s in solids],
            kit.nodes.marks,
            1e-9,
            "",
        ),
        _row("V22", "solids: order of operands", [s.commutativity for s in solids], kit.nodes.marks, 1e-9, ""),
        _row("V36", "nodes of a class agree", np.degrees(kit.nodes.deviation), kit.nodes.locations, None, "°"),
        _row("V36b", "members of a class agree", kit.members.deviation, kit.members.locations, None, "mm"),
        _row("V36c", "panels of a class agree", kit.panels.deviation, kit.panels.locations, None, "mm"),
        _row(
            "V35",
            "sheets are no fewer than the bound",
            [max(0, -sheets.gap_to_bound)],
            ("sheets",),
            0.0,
            "sheets",
        ),
    ]
    names = ("id", "what", "count", "worst", "where", "limit", "unit", "status", "reason")
    return make_table("checks", {name: [row[k] for row in rows] for k, name in enumerate(names)})


def _row(
    number: str, what: str, values: object, where: tuple[str, ...], limit: float | None, unit: str
) -> tuple[object, ...]:
    found = np.asarray(values, dtype=np.float64)
    worst = float(found.max())
    passed = limit is None or worst <= limit
    status, reason = (
        "pass" if passed else "fail",
        "" if limit is not None else "held when the classes were made",
    )
    return number, what, len(found), worst, where[first_largest(found, FINE)], limit, unit, status, reason
