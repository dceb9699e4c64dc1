"""Tables as Apache Parquet, for those who install `isomould[parquet]`."""

from importlib.util import find_spec
from pathlib import Path

from isomould.documents.table import Table
from isomould.errors import Refused
from isomould.writers.disk import write_bytes


def require_parquet() -> None:
    """Refuse to promise what cannot be written, before anything is computed.

    Raises
    ------
    Refused
        If pyarrow is not installed.
    """
    if find_spec("pyarrow") is None:
        way_out = "Run: pip install 'isomould[parquet]', or leave deliver.parquet out."
        raise Refused("E-PARQUET", "deliver.parquet", "pyarrow is not installed", "pyarrow for Parquet files", way_out)


def write_parquet(path: Path, table: Table) -> None:
    """Write one table with the names and types of its frame; text is as it is, for no reader computes it."""
    write_bytes(path, table.frame.to_parquet(None, engine="pyarrow", index=False))
