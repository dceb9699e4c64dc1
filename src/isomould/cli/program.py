"""The program: its commands, loaded when they are called, and how each of its runs ends.

Exit codes: 0 done, 1 certificate failed, 2 input refused, 3 I/O fault, 130 interrupted.
"""

import os
import sys
from collections.abc import Sequence
from importlib import import_module
from typing import Any

import click

from isomould.cli.console import INTERRUPTED, catch_signals, keep_stdout_for_results, lay_stdout_down, warn
from isomould.errors import IsomouldError, Refused

_COMMANDS = {
    "new": ("new_command", "Start a project file NAME.toml from a template."),
    "check": ("check_command", "Compute the design and print its sizes; no files are written."),
    "build": ("build_command", "Build a project: cut sheets, schedules, solids, models, and their certificate."),
    "verify": ("verify_command", "Prove a delivered folder, or the layout file of a nest, again from its files."),
    "schedule": ("build_command", "Write the workbook and the tables of a project."),
    "compare": ("compare_command", "Compare mesh families on the project's surface."),
    "nest": ("nest_command", "Nest parts of any origin on sheets, members on bars."),
    "inspect": ("inspect_command", "Say what is read of a drawing, a model or a part list."),
    "draw": ("draw_command", "Draw the design; no other files are written."),
}
"""The module of each command and what it does, in the order of the help page, which imports none of them."""


class _Program(click.Group):
    """A group that imports a command's module when the command is asked for."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(_COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name not in _COMMANDS:
            return None
        module = import_module(f"isomould.cli.{_COMMANDS[cmd_name][0]}")
        return getattr(module, cmd_name)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        with formatter.section("Commands"):
            formatter.write_dl([(name, brief) for name, (_, brief) in _COMMANDS.items()])


@click.group(cls=_Program, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="isomould")
def cli() -> None:
    """From two curves to everything a shop needs to build a free-form gridshell."""


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line; every failure that users can meet is one message and an exit code."""
    catch_signals(_terminate, "SIGTERM", "SIGBREAK")
    keep_stdout_for_results()
    code = _run(arguments)
    if code == INTERRUPTED:
        # Threads of a pool of workers may hold locks that the interrupt left closed: do not wait for them.
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)
    sys.exit(code)


def _terminate(*_: Any) -> None:
    raise KeyboardInterrupt


def _message(error: IsomouldError) -> str:
    """Word an error; refusals that were gathered are a line each."""
    together = error.each if isinstance(error, Refused) else ()
    lines = str(error).splitlines() if len(together) > 1 else [str(error)]
    return "\n".join(f"isomould: {line}" for line in lines)


def _run(arguments: Sequence[str] | None) -> int:
    try:
        result = cli.main(arguments, standalone_mode=False)
        sys.stdout.flush()
    except click.ClickException as error:
        error.show()
        return error.exit_code
    except IsomouldError as error:
        warn(_message(error))
        return error.exit_code
    except (KeyboardInterrupt, click.Abort):
        warn("isomould: interrupted; nothing was published")
        return INTERRUPTED
    except OSError as error:
        lay_stdout_down()
        warn(f"isomould: E-PRINT: the output cannot be written ({error.strerror or error}).")
        return 3
    except MemoryError:
        warn("isomould: E-MEMORY: not enough memory. Divide the curves more coarsely, or lower limits.max_panels.")
        return 2
    return result if isinstance(result, int) else 0
