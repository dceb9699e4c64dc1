"""Sheets of whole designs: nothing meets a text, values are the schedule's, sections and developments are true."""

import re
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

import museum
from isomould.cutting import nest_kit
from isomould.delivery.drawings import make_books
from isomould.delivery.goods import Delivery
from isomould.documents.shop.checks import clashes, text_box
from isomould.documents.shop.development import flat_faces, lay_block
from isomould.documents.shop.labels import make_names, owners
from isomould.documents.shop.member_sheet import MemberDrawing, member_sheet
from isomould.documents.shop.page import SMALLEST, Arc, Line, Text
from isomould.documents.shop.rows import amount_text, schedule_rows
from isomould.documents.shop.title_block import Stationery, read_title_block
from isomould.nesting.search import Search
from isomould.parts.bodies import section_outline
from isomould.parts.features import Hole
from isomould.parts.sections import view_solid
from isomould.parts.solid import make_solids
from isomould.templates import template_folder, template_names
from isomould.workers import one_by_one


def delivery_of(data):
    design = museum.design(data)
    solids = make_solids(design.kit.nodes, design.kit.joints)
    cutting = nest_kit(design.kit, None, Search("quick"), one_by_one)
    return Delivery(design, solids, {}, cutting)


@pytest.fixture(scope="module")
def vault():
    return delivery_of(museum.SMALL)


@pytest.fixture(scope="module")
def dome():
    return delivery_of(museum.trimmed(museum.dome(8.0)))


@pytest.fixture(scope="module")
def books(vault):
    return {book.name: book for book in make_books(vault)}


def texts(page):
    return [item.text for item in page.items if isinstance(item, Text)]


def boxes_of(page):
    return np.concatenate([text_box(item) for item in page.items if isinstance(item, Text)])


@pytest.mark.parametrize("name", ["vault", "dome"])
def test_no_text_meets_anything(name, request):
    pages = [page for book in make_books(request.getfixturevalue(name)) for page in book.pages]
    assert [clash for page in pages for clash in clashes(page)] == []
    heights = {item.height for page in pages for item in page.items if isinstance(item, Text)}
    assert min(heights) == SMALLEST


@pytest.mark.long
@pytest.mark.parametrize("template", template_names())
def test_no_text_meets_anything_in_any_template(template):
    pages = [page for book in make_books(delivery_of(museum.template(template))) for page in book.pages]
    assert [clash for page in pages for clash in clashes(page)] == []


@pytest.mark.parametrize("paper", ["A4", "A3"])
def test_the_paper_that_is_asked_for(paper):
    delivery = delivery_of(museum.changed(museum.SMALL, deliver={"paper": paper}))
    pages = [page for book in make_books(delivery) for page in book.pages]
    assert {tuple(sorted(page.size)) for page in pages} == {{"A4": (210.0, 297.0), "A3": (297.0, 420.0)}[paper]}
    assert [clash for page in pages for clash in clashes(page)] == []


@pytest.mark.parametrize("name", ["nodes", "members", "panels"])
def test_a_sheet_per_class_with_the_schedule_on_it(name, vault, books):
    table = next(table for table in vault.schedules if table.name == name)
    rows = schedule_rows(table)
    assert [page.name for page in books[name].pages] == [row["mark"] for row in rows]
    for row, page in zip(rows, books[name].pages, strict=True):
        shown = texts(page)
        masses = {amount_text(name, row[name]) for name in ("mass_kg", "total_mass_kg")}
        assert {row["mark"], row["quantity"], *masses} <= set(shown)
        amounts = [text for before, text in pairwise(shown) if before.endswith(("(m²)", "(kg)", "(cm³)"))]
        assert amounts
        assert all(re.fullmatch(r"\d+(\.\d{1,2})?|0\.00\d+", text) for text in amounts)
        named = (row.get("drawing_file") or row["files"]).split(";")[-1]
        assert named == f"drawings/{name}.pdf#page={books[name].pages.index(page) + 1}"


def test_dimensions_of_members_are_as_long_as_they_say(vault, books):
    rows = schedule_rows(next(table for table in vault.schedules if table.name == "members"))
    for row, page in zip(rows, books["members"].pages, strict=True):
        scale = float(re.match(r"1:(\d+)", next(text for text in texts(page) if text.startswith("1:")))[1])
        arrows = [item.points[0] for item in page.items if isinstance(item, Line) and item.filled]
        drawn = np.array([np.hypot(*(b - a)) * scale for a, b in zip(arrows[::2], arrows[1::2], strict=True)])
        for column in ("top_length", "bottom_length", "cut_length", "system_length", "set_back_start", "set_back_end"):
            assert min(abs(drawn - float(row[f"{column}_mm"]))) < 0.01, (row["mark"], column)


def test_set_backs_of_arms_are_those_of_their_members(vault, books):
    table = next(table for table in vault.schedules if table.name == "members")
    scheduled = {row[f"set_back_{end}_mm"] for row in schedule_rows(table) for end in ("start", "end")}
    drum, page = vault.design.kit.joints[4], books["nodes"].pages[4]
    row = schedule_rows(next(table for table in vault.schedules if table.name == "nodes"))[4]
    shown = texts(page)
    for k in range(1, int(row["valence"]) + 1):
        place = shown.index(str(k), shown.index("Set-back"))
        azimuth, elevation, _, _, back = shown[place + 1 : place + 6]
        assert (azimuth, elevation) == (row[f"azimuth_{k}_deg"], row[f"elevation_{k}_deg"])
        assert float(back) == pytest.approx(drum.plate_end / np.cos(np.radians(float(elevation))), abs=6e-4)
        assert back in scheduled


def test_sections_of_a_drum(vault):
    kit, solid = vault.design.kit, vault.solids[4]
    views = view_solid(solid)
    shoelace = [np.sum(p[:, 0] * np.roll(p[:, 1], -1) - p[:, 1] * np.roll(p[:, 0], -1)) / 2 for p in views.level]
    assert sum(shoelace) * kit.joints[4].height == pytest.approx(solid.volume, rel=1e-9)
    assert np.hypot(*np.concatenate(views.plan).T).max() == pytest.approx(kit.joints[4].radius, abs=5e-3)
    assert np.ptp(np.concatenate(views.elevation)[:, 1]) == pytest.approx(kit.joints[4].height, abs=1e-6)


@pytest.mark.parametrize("name", ["vault", "dome"])
def test_laid_panels_keep_their_shape_and_share_their_folds(name, request):
    mesh = request.getfixturevalue(name).design.kit.mesh
    flat = flat_faces(mesh)
    high = mesh.face_ij.max(axis=0) + 1
    block = lay_block(mesh, flat, range(high[0]), range(high[1]))
    assert sorted(block.faces) == list(range(len(flat)))
    for face, corners in zip(block.faces, block.corners, strict=True):
        space = mesh.nodes[mesh.faces[mesh.face_offsets[face] : mesh.face_offsets[face + 1]]]
        for step in (1, 2):
            sides = [np.linalg.norm(np.roll(points, -step, axis=0) - points, axis=1) for points in (space, corners)]
            assert sides[0] == pytest.approx(sides[1], abs=1e-6)
    placed = dict(zip(block.faces, block.corners, strict=True))
    whole = [f for f in block.faces if tuple(mesh.face_ij[f] + [1, 0]) in set(map(tuple, mesh.face_ij.tolist()))]
    shared = 0
    for face in whole:
        above = next(g for g in block.faces if tuple(mesh.face_ij[g]) == tuple(mesh.face_ij[face] + [1, 0]))
        for node in set(mesh.table(mesh.faces)[face]) & set(mesh.table(mesh.faces)[above]) - {-1}:
            ends = [placed[f][mesh.table(mesh.faces)[f].tolist().index(node)] for f in (face, above)]
            assert ends[0] == pytest.approx(ends[1], abs=1e-6)
            shared += 1
    assert shared >= len(flat)


def test_every_name_is_written_in_one_panel_beside_its_part(dome):
    kit = dome.design.kit
    names = make_names(kit)
    edge_owner, node_owner = owners(kit.mesh, names)
    corners = kit.mesh.table(kit.mesh.faces)
    assert all(node in corners[face] for node, face in enumerate(node_owner))
    assert all(set(kit.mesh.edges[edge]) <= set(corners[face]) for edge, face in enumerate(edge_owner) if face >= 0)
    assert (edge_owner >= 0).mean() > 0.9


def test_every_location_is_in_the_arrangement(vault, books):
    shown = {text for page in books["general-arrangement"].pages for text in texts(page)}
    for part in ("node", "member", "panel"):
        table = next(table for table in vault.schedules if table.name == f"{part}_instances")
        for row in schedule_rows(table):
            assert row["location"] in shown or f"{row['mark']} {row['location']}" in shown


@pytest.mark.parametrize("name", ["vault", "dome"])
def test_every_line_is_numbered_and_every_panel_on_the_sheet_that_is_named(name, request):
    delivery = request.getfixturevalue(name)
    mesh, pages = delivery.design.kit.mesh, make_books(delivery)[-1].pages
    shown = [texts(page) for page in pages]
    for axis, letter in enumerate("ij"):
        lines = {f"{letter}{k}" for k, count in enumerate(np.bincount(mesh.node_ij[:, axis])) if count > 1}
        assert lines <= set(shown[0]) | set(shown[1])
    start = shown[0].index("Strips") + 1
    rows = [shown[0][k : k + 3] for k in range(start, len(shown[0]) - 3, 3)]
    rows = [row for row in rows if all(re.fullmatch(r"\d+( to \d+)?", cell) for cell in row)]
    named = {int(sheet): [[*map(int, re.findall(r"\d+", cell))] for cell in cells] for sheet, *cells in rows}
    for where, at in zip(delivery.design.kit.panels.locations, mesh.face_ij.tolist(), strict=True):
        (sheet,) = [s for s, spans in named.items() if all(r[0] <= k <= r[-1] for k, r in zip(at, spans, strict=True))]
        assert where in shown[sheet - 1] or not any(where in page for page in shown[2 : 2 + len(named)])


def test_holes_are_drawn_placed_and_listed(vault):
    kit, table = vault.design.kit, next(table for table in vault.schedules if table.name == "members")
    holes = (
        Hole(100.0, 20.0, 18.0),
        Hole(140.0, -30.0, 14.0, lengthening=20.0),
        Hole(300.0, 0.0, 20.0, "top", 0.0, "M20"),
    )
    shape = replace(kit.members.shapes[6], holes=holes)
    member = MemberDrawing(schedule_rows(table)[6], shape, section_outline(shape.section))
    block = read_title_block((template_folder() / "sheets" / "title-block.toml").read_text(encoding="utf-8"))
    stationery = Stationery(block, vault.design.project.project)
    bare, drilled = (
        member_sheet(stationery, table, replace(member, shape=replace(shape, holes=some)), 1, 1) for some in ((), holes)
    )
    start = shape.outline[:, 0].min()
    new = set(texts(drilled)) - set(texts(bare))
    assert {"M20", "top", "18", "14", *(f"{hole.x - start:g}" for hole in holes)} <= new
    arcs = [sum(isinstance(item, Arc) for item in page.items) for page in (bare, drilled)]
    assert arcs[1] - arcs[0] == 2 * (1 + 2)
    on_a4 = member_sheet(replace(stationery, paper="A4"), table, replace(member, shape=shape), 1, 1)
    many = replace(shape, holes=tuple(Hole(100.0 + 30 * k, 0.0, 18.0) for k in range(30)))
    crowded = member_sheet(stationery, table, replace(member, shape=many), 1, 1)
    assert {"30", "970"} <= set(texts(crowded))
    assert clashes(drilled) == clashes(on_a4) == clashes(crowded) == ()
