"""The `[costs]` table: what things cost. Every field is a rate of the workbook, named `rate_<field>` there."""

from typing import Any

from pydantic import Field

from isomould.settings import Name, Settings
from isomould.units import NonNegativeNumber

Rate = NonNegativeNumber | None
"""Money or hours per unit, or percent; None is a rate that nobody gave."""


def _rate(unit: str, description: str) -> Any:
    return Field(default=None, description=description, json_schema_extra={"unit": unit})


class CostSettings(Settings):
    """The `[costs]` table. Stock prices stand in `[stock]`; a rate that is not given is blank, and the cost says so."""

    currency: Name = "EUR"
    steel: Rate = _rate("/kg", "Steel of members, where no bars are in stock")
    node_steel: Rate = _rate("/kg", "Round bar that nodes are turned from")
    base_steel: Rate = _rate("/kg", "Base plates and stems of supports")
    fitting_steel: Rate = _rate("/kg", "Steel of caps, end plates and fins, where there are any")
    glass: Rate = _rate("/m²", "Panels by charged area, where no sheets are in stock")
    waste_members: Rate = _rate("%", "Waste on steel of members, where no bars are in stock")
    waste_panels: Rate = _rate("%", "Waste on panels, where no sheets are in stock")
    panel_set_up: Rate = _rate("/class", "Setting up for a panel class")
    panel_cut: Rate = _rate("/m", "Cutting panels, per metre of contour")
    panel_pierce: Rate = _rate("/piece", "Starting a contour")
    member_set_up: Rate = _rate("/class", "Setting up for a member class")
    saw_cut: Rate = _rate("/cut", "End cut of a member, two per member")
    member_hole: Rate = _rate("/piece", "Hole or slot of a member")
    hole: Rate = _rate("/piece", "Bore or hole of a node")
    thread: Rate = _rate("/piece", "Tapping a hole of a node")
    node_set_up: Rate = _rate("/class", "Setting up for a node class")
    node_run: Rate = _rate("/piece", "Running one node")
    node_run_torsion: Rate = _rate("/piece", "Running one node with torsion, of other mesh families")
    slot: Rate = _rate("/piece", "Slot of a node")
    facet: Rate = _rate("/piece", "Facet of a node")
    weld: Rate = _rate("/m", "Weld of nodes: slots, or fins on hubs")
    cap: Rate = _rate("/piece", "Making a cap, where nodes have caps")
    end_plate: Rate = _rate("/piece", "Making an end plate and welding it in, where members have any")
    fin: Rate = _rate("/piece", "Making a fin, where nodes have fins")
    coating: Rate = _rate("/m²", "Coating of nodes, members and fittings")
    hardware: Rate = _rate("/node", "Bolts, washers and small parts, where none are listed")
    bolt: Rate = _rate("/piece", "Bolt, where hardware is listed")
    nut: Rate = _rate("/piece", "Nut, where hardware is listed")
    washer: Rate = _rate("/piece", "Washer, where hardware is listed")
    hours_node: Rate = _rate("h/node", "Hours to assemble a node")
    hours_member: Rate = _rate("h/member", "Hours to assemble a member")
    hours_panel: Rate = _rate("h/panel", "Hours to assemble a panel")
    assembly: Rate = _rate("/h", "Assembly in the shop")
    handling: Rate = _rate("/piece", "Handling and packing a part")
    transport: Rate = _rate("/t", "Transport by mass")
    erect_node: Rate = _rate("/node", "Erecting a node")
    erect_member: Rate = _rate("/member", "Erecting a member")
    erect_panel: Rate = _rate("/panel", "Erecting a panel")
    overhead: Rate = _rate("%", "Overhead on everything above")
    margin: Rate = _rate("%", "Margin on cost and overhead")
