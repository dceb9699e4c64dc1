"""What commands share: how they print, tell their progress, and are told to end."""

import os
import signal
import sys
from collections.abc import Callable
from contextlib import suppress

import click
from rich.console import Console

_STDOUT, _STDERR = 1, 2

INTERRUPTED = 130
"""The exit code after Ctrl-C."""


def console() -> Console:
    """Give the console of the output."""
    return Reader(highlight=False, soft_wrap=False)


def keep_stdout_for_results() -> None:
    """Let only the program itself write to stdout: what libraries print there by themselves goes to stderr.

    Native code writes to file descriptor 1 whatever Python's `sys.stdout` is. So the program keeps a copy of that
    descriptor for itself and its own stream, and number 1 becomes another name of stderr, in worker processes too.
    """
    stream = sys.stdout
    try:
        native = stream.fileno() == _STDOUT
    except (OSError, ValueError, AttributeError):
        return  # captured by a test, a notebook or a service without a console: there is nothing to guard
    if native:
        stream.flush()
        own = os.dup(_STDOUT)
        os.dup2(_STDERR, _STDOUT)
        sys.stdout = open(own, "w", encoding=stream.encoding, errors=stream.errors)  # noqa: PTH123, SIM115


def lay_stdout_down() -> None:
    """Let what could not be written vanish: else it is tried again when the program ends, and changes its exit code."""
    with suppress(OSError, ValueError, AttributeError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, sys.stdout.fileno())


def say(text: str) -> None:
    """Print on the output."""
    console().out(text, highlight=False)


def warn(text: str) -> None:
    """Print on stderr."""
    with suppress(OSError):  # nobody reads it
        click.echo(text, err=True)


class Reader(Console):
    """A console whose reader may go away (`| head`): what was done stays done, and the exit code says so."""

    def on_broken_pipe(self) -> None:
        """Go on without the reader."""
        with suppress(SystemExit):
            super().on_broken_pipe()


class Progress:
    """Shows the running stage on stderr: a spinner on a terminal, plain lines otherwise."""

    def __init__(self, quiet: bool) -> None:
        self.console = Reader(stderr=True, quiet=quiet)
        self.status = self.console.status("starting") if self.console.is_terminal and not quiet else None

    def __enter__(self) -> Callable[[str], None]:
        return self._report

    def _report(self, stage: str) -> None:
        if self.status:
            self.status.update(stage)
            self.status.start()
        else:
            with suppress(OSError):  # a full log must not stop the work
                self.console.print(stage, highlight=False)

    def __exit__(self, *_: object) -> None:
        if self.status:
            self.status.stop()


def catch_signals(handler: Callable[..., None], *names: str) -> None:
    """Handle the signals by which a user, a shell or a service ends a program; not every system has them all."""
    for name in names or ("SIGINT", "SIGTERM", "SIGBREAK"):
        if hasattr(signal, name):
            signal.signal(getattr(signal, name), handler)
