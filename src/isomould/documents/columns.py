"""The columns of every table, as data: what `deliverables` promises, name by name.

A name says its unit (`mass_kg`), and the unit says the rest: that the column holds numbers, how many
decimals are kept, and how the header reads for people. Columns without a unit are listed by kind.
"""

from dataclasses import dataclass
from typing import Literal

Kind = Literal["text", "integer", "number", "yes_no"]


@dataclass(frozen=True)
class Column:
    """One column: `name` in CSV, `header` in Excel; `decimals` None keeps six significant digits.

    `total` columns are summed below the table.
    """

    name: str
    header: str
    kind: Kind
    decimals: int | None
    total: bool


ARMS, SHAPES = "ARMS", "SHAPES"
"""Stand for the columns of arms 1 to k of the nodes, and for the quantities in the shapes of a project."""

TABLES: dict[str, tuple[str, ...]] = {
    name: tuple(text.split())
    for name, text in {
        "summary": "item value unit",
        "nodes": f"""mark quantity kind valence handed {ARMS} drum_diameter_mm drum_height_mm mass_kg
            total_mass_kg volume_cm3 coated_area_m2 bar_diameter_mm blank_length_mm bar_mass_kg removed_volume_cm3
            slots facets fins holes threads
            base_length_mm base_width_mm base_level_mm base_holes base_mass_kg
            weld_length_mm max_deviation_mm max_deviation_deg solid_file drawing_file""",
        "node_instances": """location mark i j x_mm y_mm z_mm axis_x axis_y axis_z ref_x ref_y ref_z
            mismatch_mm torsion_deg members panels deviation_mm deviation_deg""",
        "members": """mark quantity family section grade system_length_mm top_length_mm bottom_length_mm
            cut_length_mm end_angle_start_deg end_angle_end_deg set_back_start_mm set_back_end_mm mass_kg
            total_mass_kg coated_area_m2 holes files""",
        "member_instances": """location mark turned node_start node_end panel_left panel_right bar
            position_mm bar_turned deviation_mm""",
        "panels": """mark quantity side_a_mm side_b_mm side_c_mm side_d_mm diagonal_1_mm diagonal_2_mm
            height_mm angle_1_deg angle_2_deg angle_3_deg angle_4_deg outline area_m2 total_area_m2
            charged_area_m2 box_width_mm box_height_mm mass_kg total_mass_kg handed files""",
        "panel_instances": """location mark i j first_corner nodes members packers_mm slope_deg flatness_mm
            sheet x_mm y_mm rotation_deg turned_over deviation_mm""",
        "setting_out": """location mark x_mm y_mm z_mm top_x_mm top_y_mm top_z_mm
            bottom_x_mm bottom_y_mm bottom_z_mm""",
        "packing": "crate location mark members panels",
        "crates": "crate part mark quantity mass_kg total_mass_kg locations",
        "node_limits": "mark what value_mm required_mm margin_mm",
        "hardware": "mark quantity item size standard pieces total_pieces",
        "node_fittings": "mark quantity arm fitting pieces total_pieces",
        "fittings": "mark quantity kind size mass_kg total_mass_kg coated_area_m2 file",
        "sheets": """sheet stock parts part_area_m2 yield_percent cut_length_mm cuts offcut_width_mm
            offcut_height_mm price file""",
        "bars": "bar stock pieces used_mm offcut_mm price",
        "saw_list": "bar stock cut mark location position_mm length_mm bar_turned offcut_mm",
        "strips": "strip along pieces length_mm width_mm sagitta_mm area_m2 file",
        "families": """family parallels generatrices nodes_count node_classes interior_node_classes members_count
            member_classes panels_count panel_classes shortest_mm longest_mm length_spread_percent aspect
            planarity_mm conical_deg circular_deg cone_spread_deg mismatch_mm torsion_deg deviation_mm
            horizontal_parallels freegrid_planarity freegrid_joint_classes freegrid_lengths reason""",
        "repetition": """family nodes_count node_classes twisted_nodes_count members_count member_classes panels_count
            panel_classes member_length_mm panel_area_m2 charged_area_m2 contour_length_mm node_set_up_cost
            node_run_cost member_set_up_cost member_run_cost panel_set_up_cost panel_run_cost member_material_cost
            panel_material_cost assembly_cost erection_cost works_cost surcharge_cost full_cost square_metre_cost
            currency""",
        "revision": "mark part status quantity_before quantity replaces",
        "rates": "code description unit value",
        "cost": "code group description unit quantity waste_percent rate amount",
        "kit": f"mark kind quantity {SHAPES} shared",
        "checks": "id what count worst where limit unit status reason",
    }.items()
}

UNITS = {"mm": "mm", "deg": "°", "kg": "kg", "m2": "m²", "cm3": "cm³", "percent": "%"}
"""How the unit at the end of a column name is written for people."""

_DECIMALS = {"mm": 3, "deg": 4, "kg": 3, "m2": 12, "cm3": 3, "percent": 3}
_DECIMALS_WITHOUT_UNIT: dict[str, int | None] = {
    **dict.fromkeys(("axis_x", "axis_y", "axis_z", "ref_x", "ref_y", "ref_z"), 9),
    **dict.fromkeys(("value", "rate", "amount", "price"), 12),
    **dict.fromkeys(("total_pieces",), 0),
    **dict.fromkeys((name for name in TABLES["repetition"] if name.endswith("_cost")), 12),
    **dict.fromkeys(("worst", "limit"), None),
    **dict.fromkeys(("aspect", "freegrid_lengths"), 3),
    **dict.fromkeys(("freegrid_planarity",), 6),
}
_TEXTS_WITH_UNIT = frozenset(("packers_mm",))  # a list of four, in the order of the sides
_INTEGERS = frozenset(
    """quantity quantity_before valence slots facets fins holes threads arm base_holes i j first_corner parts cuts
    cut pieces count parallels generatrices nodes_count twisted_nodes_count node_classes interior_node_classes
    members_count member_classes panels_count panel_classes horizontal_parallels freegrid_joint_classes""".split()  # noqa: SIM905
)
_TAKEN_OFF = Column("quantity", "Quantity", "number", 12, total=False)
"""In the cost a quantity is whatever is paid for, not a number of pieces."""
_YES_NO = frozenset(("turned_over", "shared"))

_TOTALS: dict[str, frozenset[str]] = {
    "nodes": frozenset(("quantity", "total_mass_kg")),
    "members": frozenset(("quantity", "total_mass_kg")),
    "panels": frozenset(("quantity", "total_area_m2", "total_mass_kg")),
    "hardware": frozenset(("total_pieces",)),
    "node_fittings": frozenset(("total_pieces",)),
    "fittings": frozenset(("quantity", "total_mass_kg")),
    "sheets": frozenset(("parts", "part_area_m2", "cut_length_mm", "cuts", "price")),
    "bars": frozenset(("pieces", "used_mm", "offcut_mm", "price")),
    "saw_list": frozenset(("length_mm", "offcut_mm")),
    "cost": frozenset(("amount",)),
    "kit": frozenset(("quantity",)),
}

_PER_PIECE, _PER_SHAPE = "total_", "quantity_"


def columns(table: str, arms: int = 0, shapes: tuple[str, ...] = ()) -> tuple[Column, ...]:
    """Give the columns of a table in order; `arms` is the largest valence of the nodes.

    `shapes` are the columns of the shapes of a project.

    Examples
    --------
    >>> [column.header for column in columns("bars")]
    ['Bar', 'Stock', 'Pieces', 'Used (mm)', 'Offcut (mm)', 'Price']
    """
    totals = _TOTALS.get(table, frozenset())
    found = (_column(name, name in totals) for name in _names(table, arms, shapes))
    return tuple(_TAKEN_OFF if table == "cost" and column.name == "quantity" else column for column in found)


def title(table: str) -> str:
    """Give the sheet name of a table: `member_instances` is "Member instances"."""
    return table.replace("_", " ").capitalize()


def unit(name: str) -> str:
    """Give the unit of a column as people write it, or an empty text.

    >>> unit("area_m2"), unit("mark")
    ('m²', '')
    """
    return "" if is_of_shape(name) else UNITS.get(_suffix(name), "")


def per_piece(name: str) -> str | None:
    """Give the column that a `total_…` column multiplies by the quantity, or None.

    >>> per_piece("total_mass_kg")
    'mass_kg'
    """
    return name.removeprefix(_PER_PIECE) if name.startswith(_PER_PIECE) else None


def is_of_shape(name: str) -> bool:
    """Tell whether a column holds the quantities in one shape of a project; its name may end like a unit.

    >>> is_of_shape("quantity_main"), is_of_shape("quantity")
    (True, False)
    """
    return name.startswith(_PER_SHAPE)


def arm_columns(arm: int) -> tuple[str, ...]:
    """Name the columns of one arm of a node, counted from 1."""
    return f"azimuth_{arm}_deg", f"elevation_{arm}_deg", f"family_{arm}", f"section_{arm}"


def _names(table: str, arms: int, shapes: tuple[str, ...]) -> tuple[str, ...]:
    expanded = {ARMS: tuple(name for arm in range(1, arms + 1) for name in arm_columns(arm)), SHAPES: shapes}
    return tuple(name for word in TABLES[table] for name in expanded.get(word, (word,)))


def _column(name: str, total: bool) -> Column:
    return Column(name, _header(name), _kind(name), _decimals(name), total)


def _suffix(name: str) -> str:
    return name.rpartition("_")[2]


def _header(name: str) -> str:
    """Write a name for people: `system_length_mm` is "System length (mm)"; coordinates stay small."""
    words = name.removesuffix(f"_{_suffix(name)}") if unit(name) else name
    text = words.replace("_", " ")
    capital = text if len(text) == 1 else text[0].upper() + text[1:]
    return f"{capital} ({unit(name)})" if unit(name) else capital


def _kind(name: str) -> Kind:
    if name in _INTEGERS or is_of_shape(name):
        return "integer"
    if name in _YES_NO:
        return "yes_no"
    return "number" if name not in _TEXTS_WITH_UNIT and (unit(name) or name in _DECIMALS_WITHOUT_UNIT) else "text"


def _decimals(name: str) -> int | None:
    return _DECIMALS_WITHOUT_UNIT.get(name, _DECIMALS.get(_suffix(name), 0))
