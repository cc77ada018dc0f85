"""Command line, `plantar <command>`: modules of `plantar.commands`, and other packages' entry points."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from importlib import import_module
from pkgutil import iter_modules
from typing import Annotated

import typer

from plantar import __version__, commands
from plantar.console.command import Command, run_command
from plantar.console.ending import run
from plantar.extensions import extensions

__all__ = ["app", "main"]

app = typer.Typer(
    name="plantar",
    no_args_is_help=True,
    add_completion=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)
"""The commands."""


def _print_version(wanted: bool) -> None:
    if wanted:
        print(f"plantar {__version__}")
        raise typer.Exit


@app.callback()
def _commands(
    version: Annotated[
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Print the version and exit.")
    ] = False,
) -> None:
    """Plantar skin and gait: build a tactile shoe, walk a robot on plantar feedback, analyse recordings."""


def _found() -> Iterator[Command]:
    """This package's commands, then others' (entry points of `plantar.commands`)."""
    for module in iter_modules(commands.__path__, f"{commands.__name__}."):
        yield import_module(module.name).COMMAND
    yield from extensions("plantar.commands", Command).values()


for _command in sorted(_found(), key=lambda command: command.place):
    app.command(name=_command.name or _command.function.__name__, short_help=_command.summary)(_command.function)


def main() -> None:
    """Entry point of the console script.

    Example:
        >>> main()  # doctest: +SKIP
    """
    sys.exit(run(lambda: run_command(app)))
