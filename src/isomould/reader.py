"""A console whose reader may go away (`| head`): what was done stays done, and the exit code says so."""

from contextlib import suppress

from rich.console import Console


class Reader(Console):
    """A console that goes on without its reader."""

    def on_broken_pipe(self) -> None:
        """Go on without the reader."""
        with suppress(SystemExit):
            super().on_broken_pipe()
