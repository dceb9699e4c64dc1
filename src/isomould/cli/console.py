"""What commands share: how they print, and are told to end. Rich is imported with the first table."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable
from contextlib import suppress
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from isomould.reader import Reader

_STDOUT, _STDERR = 1, 2

INTERRUPTED = 130
"""The exit code after Ctrl-C."""


def console() -> Reader:
    """Give the console of the output."""
    from isomould.reader import Reader

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


def catch_signals(handler: Callable[..., None], *names: str) -> None:
    """Handle the signals by which a user, a shell or a service ends a program; not every system has them all."""
    for name in names or ("SIGINT", "SIGTERM", "SIGBREAK"):
        if hasattr(signal, name):
            signal.signal(getattr(signal, name), handler)
