"""The command `new`: a project file to start from."""

import click

import isomould
from isomould.cli.console import say
from isomould.templates import describe_template, template_names


@click.command()
@click.argument("name", required=False)
@click.option("--template", default="barrel-vault", show_default=True, help="The shape to start from.")
@click.option("--list", "list_", is_flag=True, help="List the templates.")
def new(name: str | None, template: str, list_: bool) -> None:
    """Start a project file NAME.toml from a template."""
    if list_:
        for known in template_names():
            say(f"{known:20}  {describe_template(known)}")
        return
    if name is None:
        raise click.UsageError("give the new project a NAME, or --list for the templates")
    for path in isomould.new(name, template):
        say(f"wrote {path}")
