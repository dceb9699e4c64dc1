"""What helps on the way to the site and on it: labels."""

from pathlib import Path

from isomould.delivery.goods import Delivery
from isomould.documents.labels import piece_labels
from isomould.writers.label_sheets import write_label_sheets


def write_labels(path: Path, delivery: Delivery) -> None:
    """Write the labels of all pieces, if the project asks for them."""
    project = delivery.design.project
    if project.deliver.labels:
        crates = next(table for table in delivery.schedules if table.name == "crates")
        write_label_sheets(path, piece_labels(crates, project.project))
