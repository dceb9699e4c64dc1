"""The tables that go with the nodes: limits with their margins, bought hardware, made fittings."""

from isomould.documents.table import Table, make_table
from isomould.parts.details.fittings import Fitting, name_fins
from isomould.parts.kit import Kit

_KG_PER_MM3 = 1e-9
"""Times density in kg/m³."""


def limit_table(kit: Kit) -> Table:
    """Give one row per node class and inequality: the value, what is required, and what is left."""
    rows = [(mark, limit) for mark, joint in zip(kit.nodes.marks, kit.joints, strict=True) for limit in joint.limits]
    return make_table(
        "node_limits",
        {
            "mark": [mark for mark, _ in rows],
            "what": [limit.name for _, limit in rows],
            "value_mm": [limit.value for _, limit in rows],
            "required_mm": [limit.required for _, limit in rows],
            "margin_mm": [limit.margin for _, limit in rows],
        },
    )


def hardware_table(kit: Kit) -> Table:
    """Give one row per node class and item that is bought: pieces per node."""
    counts = kit.nodes.classes.quantity.tolist()
    classes = zip(kit.nodes.marks, counts, kit.joints, strict=True)
    rows = [(mark, count, item) for mark, count, joint in classes for item in joint.hardware]
    return make_table(
        "hardware",
        {
            "mark": [mark for mark, _, _ in rows],
            "quantity": [count for _, count, _ in rows],
            "item": [item.item for _, _, item in rows],
            "size": [item.size for _, _, item in rows],
            "standard": [item.standard for _, _, item in rows],
            "pieces": [item.quantity for _, _, item in rows],
        },
    )


def fitting_table(fittings: tuple[Fitting, ...], density: float) -> Table:
    """Give one row per kind of cap, end plate or fin; `density` in kg/m³. Fins are coated with their nodes."""
    return make_table(
        "fittings",
        {
            "mark": [fitting.mark for fitting in fittings],
            "quantity": [fitting.quantity for fitting in fittings],
            "kind": [fitting.kind for fitting in fittings],
            "size": [fitting.size for fitting in fittings],
            "mass_kg": [fitting.volume * density * _KG_PER_MM3 for fitting in fittings],
            "coated_area_m2": [fitting.surface and fitting.surface / 1e6 for fitting in fittings],
            "file": [
                f"fittings/{f.mark}.3mf" if f.solid else f"fittings/{f.mark}.dxf;fittings/{f.mark}.nc1"
                for f in fittings
            ],
        },
    )


def node_fitting_table(kit: Kit, fittings: tuple[Fitting, ...]) -> Table:
    """Give one row per node class and arm with fins: which, and how many per node."""
    classes = zip(kit.nodes.marks, kit.nodes.classes.quantity.tolist(), kit.joints, kit.nodes.arms, strict=True)
    rows = [
        (mark, count, arm, fin)
        for mark, count, joint, arms in classes
        for arm, fin in name_fins(joint, arms, fittings).items()
    ]
    return make_table(
        "node_fittings",
        {
            "mark": [mark for mark, *_ in rows],
            "quantity": [count for _, count, *_ in rows],
            "arm": [arm for _, _, arm, _ in rows],
            "fitting": [fin for *_, fin in rows],
            "pieces": [2] * len(rows),
        },
    )
