"""Arguments and options that several commands have."""

import functools
from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

EFFORT = click.Choice(["quick", "normal", "best"])
PROJECT = click.argument("project", type=click.Path(path_type=Path))
CHANGES = click.option("--set", "changes", multiple=True, metavar="KEY=VALUE", help='Such as rail.curve.rise="8 m".')


class Quantity(click.ParamType):  # pyright: ignore[reportMissingTypeArgument] - generic in newer versions only
    """A value that a reader of ours makes of an option's text, such as a length with its unit."""

    def __init__(self, name: str, read: Callable[[str], Any]) -> None:
        self.name, self.read = name, read

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Read the text, or say what is wrong with it."""
        try:
            return self.read(value)
        except ValueError as fault:
            self.fail(str(fault), param, ctx)


def building(command: Callable[..., None]) -> Callable[..., None]:
    """Give a command the arguments of everything that builds a project into a folder."""
    arguments = (
        PROJECT,
        click.option("--out", type=click.Path(path_type=Path), help="Folder to write; default below outputs/."),
        click.option("--replace", is_flag=True, help="Replace an earlier delivery in that folder."),
        click.option(
            "--previous", type=click.Path(path_type=Path), help="Former delivery: unchanged parts keep its marks."
        ),
        CHANGES,
        click.option("--effort", type=EFFORT, default="normal", show_default=True, help="How long to nest."),
        click.option("--jobs", type=click.IntRange(min=1), help="Processes; default one per core, result the same."),
        click.option("--quiet", is_flag=True, help="No progress."),
    )
    return functools.reduce(lambda made, add: add(made), reversed(arguments), command)
