"""The verbs as commands, one module each; parses, calls, prints."""

from isomould.cli.program import cli, main

__all__ = ["cli", "main"]
