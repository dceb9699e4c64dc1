"""All files of the folder but certificate and manifest, one group after another."""

from pathlib import Path

from isomould.delivery.drawings import write_cutting_plan, write_drawings, write_saw_list
from isomould.delivery.goods import Delivery
from isomould.delivery.handling import write_labels
from isomould.delivery.machine import write_machine_files, write_nc1_files, write_setting_out, write_strips
from isomould.delivery.model import write_model
from isomould.delivery.nodes import write_nodes
from isomould.delivery.schedules import write_bars, write_schedules
from isomould.delivery.solids import write_part_solids
from isomould.delivery.stages import MODELS, SCHEDULES
from isomould.progress import UNTOLD, Course
from isomould.workers import Spread


def write_delivery(folder: Path, delivery: Delivery, spread: Spread, course: Course = UNTOLD) -> None:
    """Write all files but certificate and manifest into an empty folder."""
    write_machine_files(folder, delivery, spread, course)
    write_nc1_files(folder, delivery)
    told = course.begin(MODELS)
    write_model(folder / "model", delivery)
    write_nodes(folder / "nodes", delivery, told)
    write_part_solids(folder, delivery)
    course.begin(SCHEDULES)
    write_schedules(folder, delivery)
    write_bars(folder / "bars" / "bars.csv", delivery)
    write_drawings(folder / "drawings", delivery, spread, course)
    write_cutting_plan(folder / "sheets" / "cutting-plan.pdf", delivery)
    write_saw_list(folder / "bars" / "saw-list.pdf", delivery)
    write_strips(folder, delivery)
    write_labels(folder / "labels.pdf", delivery)
    write_setting_out(folder / "setting-out.dxf", delivery)
