"""What section 9 of the worked example says of other templates is what the program makes of them."""

import pytest
import worked_rows as rows
from test_worked_example import schedule_rows
from worked_templates import scheduled

from isomould.design import make_design
from isomould.parts.details.fittings import make_fittings
from isomould.project.load import load_project
from museum import TEMPLATES

BY_HAND = scheduled()


@pytest.fixture(scope="module", params=sorted({name for name, _, _ in BY_HAND}))
def found(request) -> tuple[str, dict[str, dict[str, dict]]]:
    """The name of a template, and the rows of its schedules by table and mark."""
    loaded = load_project(TEMPLATES / f"{request.param}.toml")
    design = make_design(loaded.project, loaded.folder)
    kit = design.kit
    fittings = {
        part.mark: {"mass_kg": part.volume * 7850e-9, "coated_area_m2": part.surface and part.surface / 1e6}
        for part in make_fittings(kit.nodes, kit.joints, kit.members)
    }
    tables = {name: {row.get("mark"): row for row in lines} for name, lines in schedule_rows(design).items()}
    return request.param, tables | {"fittings": fittings}


def test_details_of_other_templates(found):
    name, tables = found
    for (template, table, mark), cells in BY_HAND.items():
        if template == name:
            row = tables[table][mark]
            said = {column: rows.printed(row[column], rows.decimals(column)) for column in cells}
            assert said == {column: rows.printed(value, rows.decimals(column)) for column, value in cells.items()}
