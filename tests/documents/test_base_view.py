"""Bases of supports on the sheets of their nodes: every hole and corner has its place, nothing meets a text."""

import re

import numpy as np
import pytest

import museum
from isomould.cutting import nest_kit
from isomould.delivery.drawings import make_books
from isomould.delivery.goods import Delivery
from isomould.documents.shop.checks import clashes
from isomould.documents.shop.page import Arc, Text
from isomould.nesting.search import Search
from isomould.parts.solid import make_solids
from isomould.workers import one_by_one


@pytest.fixture(scope="module")
def delivery():
    asked = {"base_plate": {"holes": 6}}
    design = museum.design(museum.changed(museum.trimmed(museum.dome(5.2, nodes=6)), nodes=asked))
    solids = make_solids(design.kit.nodes, design.kit.joints)
    return Delivery(design, solids, {}, nest_kit(design.kit, None, Search("quick"), one_by_one))


def test_bases_are_drawn_with_their_holes_and_sizes(delivery):
    pages = make_books(delivery)[0].pages
    assert [clash for page in pages for clash in clashes(page)] == []
    for base, page in zip(delivery.design.kit.bases, pages, strict=True):
        shown = [item.text for item in page.items if isinstance(item, Text)]
        captions = [text for text in shown if text.startswith("Base 1:")]
        assert len(captions) == (base is not None)
        if base is None:
            continue
        scale = float(re.match(r"Base 1:(\d+)", captions[0])[1])
        assert f"Plate {base.plate_thickness:g} thick, 6 holes Ø{base.holes[0].diameter:g}" in shown
        low, high = base.plate.min(axis=0), base.plate.max(axis=0)
        corners = [*(high - low), *(base.stem[:, 0] - base.stem[:, 0].min())]
        assert {f"{round(x, 3) + 0:g}" if x == round(x) else f"{x:.3f}".rstrip("0") for x in corners} <= set(shown)
        assert {f"{v:g}" for hole in base.holes for v in (hole.x - low[0], hole.y - low[1])} <= set(shown)
        radii = [item.radius for item in page.items if isinstance(item, Arc)]
        assert sum(np.isclose(radii, base.holes[0].diameter / 2 / scale)) >= len(base.holes)
