"""Details in money: every kilogram in one sum, hardware by piece, from delivered tables of all details."""

import math

import pytest

import isomould
from isomould.documents.cost_settings import CostSettings
from isomould.documents.costs import Pricing, make_cost
from isomould.documents.reconciliations import reconcile
from museum import SMALL, changed, write_project

TINY = changed(
    {key: table for key, table in SMALL.items() if key not in {"stock", "deliver", "costs"}},
    rail={"curve": {"kind": "parabola", "span": "5 m", "rise": "1 m"}, "divide": {"nodes": 2}},
    generatrix={"curve": {"kind": "arc", "span": "5 m", "rise": "0.6 m"}, "divide": {"nodes": 2}},
)
DESIGNS = {
    "welded": TINY,
    "capped": changed(TINY, nodes={"retention": "lipped-cap"}),
    "faceted": changed(TINY, nodes={"detail": "faceted"}, members={"section": "RHS 100x50x4"}),
    "finned": changed(TINY, nodes={"detail": "finned"}),
}
BOUGHT = {
    "welded": {"hardware"},
    "capped": {"bolt", "nut", "washer"},
    "faceted": {"bolt", "washer"},
    "finned": {"bolt", "nut", "washer"},
}


@pytest.fixture(scope="module", params=DESIGNS)
def scheduled(request, tmp_path_factory):
    """Name, tables and lines of the cost by code."""
    folder = tmp_path_factory.mktemp(request.param)
    project = write_project(folder / "tiny.toml", DESIGNS[request.param])
    built = isomould.schedule(project, folder / "out", run=isomould.Run(effort="quick", jobs=1))
    frames = isomould.frames(built)
    return request.param, built.tables, frames, frames["cost"].set_index("code")


def weights(frame):
    return math.fsum(frame["quantity"] * frame["mass_kg"])


def test_every_kilogram_is_carried_once(scheduled):
    _, _, frames, cost = scheduled
    fittings = frames.get("fittings")
    caps = 0.0 if fittings is None else weights(fittings[fittings["kind"] == "cap"])
    parts = math.fsum(weights(frames[name]) for name in ("nodes", "members", "panels")) + caps
    assert cost.loc["transport", "quantity"] == pytest.approx(parts / 1000, abs=1e-9)


def test_steel_of_members_and_fittings_is_bought_once(scheduled):
    name, _, frames, cost = scheduled
    bought = [cost.loc[code, "quantity"] for code in ("steel", "fitting_steel") if code in cost.index]
    caps = weights(frames["fittings"]) if name in {"capped", "finned"} else 0.0
    assert len(bought) == (1 if name == "welded" else 2)
    assert sum(bought) == pytest.approx(weights(frames["members"]) + caps, abs=1e-9)


def test_hardware_is_paid_for_as_it_is_listed(scheduled):
    name, _, frames, cost = scheduled
    assert set(cost.index[cost["group"] == "Hardware"]) == BOUGHT[name]
    assert BOUGHT[name] == {*frames["rates"]["code"]} & {"hardware", "bolt", "nut", "washer"}
    for item in BOUGHT[name] - {"hardware"}:
        rows = frames["hardware"][frames["hardware"]["item"] == item]
        assert cost.loc[item, "quantity"] == (rows["quantity"] * rows["pieces"]).sum() > 0


def test_threads_and_holes_are_those_of_the_detail(scheduled):
    name, _, frames, cost = scheduled
    bolts = cost.loc["bolt", "quantity"] if name == "faceted" else 0
    assert cost.loc["thread", "quantity"] == bolts
    holes = (frames["members"]["quantity"] * frames["members"]["holes"]).sum()
    assert cost.loc["member_hole", "quantity"] == holes
    assert (holes > 0) == (name in {"faceted", "finned"})


def test_bar_is_bought_for_what_is_turned(scheduled):
    name, _, frames, cost = scheduled
    nodes = frames["nodes"]
    bars = math.pi / 4 * nodes["bar_diameter_mm"] ** 2 * nodes["blank_length_mm"] * 7850e-9
    assert cost.loc["node_steel", "quantity"] == pytest.approx((nodes["quantity"] * bars).sum(), abs=0.01)
    turned = nodes["bar_mass_kg"] - nodes["removed_volume_cm3"] * 7850e-6
    welded = nodes["mass_kg"] - turned
    assert (welded.max() > 1.0) == (name == "finned")
    assert welded.min() > -0.002


def test_fins_are_made_welded_and_not_coated_twice(scheduled):
    name, _, frames, cost = scheduled
    if name != "finned":
        assert "fin" not in cost.index
        return
    assert cost.loc["fin", "quantity"] == frames["fittings"]["quantity"].sum()
    assert cost.loc["fin", "quantity"] == (frames["nodes"]["quantity"] * frames["nodes"]["fins"]).sum()
    assert cost.loc["fin", "quantity"] == frames["node_fittings"]["total_pieces"].sum() > 0
    assert cost.loc["weld", "quantity"] > 0
    assert frames["fittings"]["coated_area_m2"].isna().all()


def test_caps_are_coated_and_handled(scheduled):
    name, _, frames, cost = scheduled
    kinds = ("nodes", "members", "fittings") if name in {"capped", "faceted"} else ("nodes", "members")
    area = sum((frames[kind]["quantity"] * frames[kind]["coated_area_m2"]).sum() for kind in kinds)
    assert cost.loc["coating", "quantity"] == pytest.approx(area, rel=1e-12)
    pieces = sum(frames[kind]["quantity"].sum() for kind in ("nodes", "members", "panels"))
    caps = frames["fittings"]["quantity"].sum() if name == "capped" else 0
    assert cost.loc["handling", "quantity"] == pieces + caps


def test_sums_are_reconciled(scheduled):
    name, tables, _, _ = scheduled
    found = {line.what: line.status for line in reconcile(tables)}
    assert set(found.values()) == {"pass"}
    assert ("Bolts, nuts and washers paid for = hardware" in found) == (name != "welded")
    assert ("Caps, end plates and fins paid for = fittings" in found) == (name != "welded")


def test_a_rate_per_bolt_changes_the_total_by_the_bolts(scheduled):
    name, tables, _, cost = scheduled
    code = "hardware" if name == "welded" else "bolt"
    schedules = [table for table in tables if table.name not in {"rates", "cost"}]
    priced = make_cost(schedules, Pricing(CostSettings.model_validate({code: 2.5}), (), ()))
    assert priced.total == pytest.approx(2.5 * cost.loc[code, "quantity"], rel=1e-12)
