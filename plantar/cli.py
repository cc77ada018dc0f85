"""Command line, `plantar <command>`: modules of `plantar.commands`, and other packages' entry points."""

import sys
from importlib import import_module
from itertools import pairwise
from pkgutil import iter_modules
from typing import Annotated, Any

import typer
from typer.core import TyperCommand, TyperGroup

from plantar import commands, kernels
from plantar.common.console.command import Command, run_command
from plantar.common.console.ending import print_note, run
from plantar.common.extensions import extensions
from plantar.common.version import VERSION
from plantar.errors import InputError

_FIRST = ("demo", "shoe", "analyze", "sole", "robot", "sim", "view")  # commands that a new user looks for


class _Groups(TyperGroup):
    """Help that lists the first commands, and the rest below."""

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        found = {name: command for name in self.list_commands(ctx) if (command := self.get_command(ctx, name))}
        first = [name for name in _FIRST if name in found]
        for title, names in (("Commands", first), ("More", [name for name in found if name not in first])):
            with formatter.section(title):
                formatter.write_dl([(name, found[name].get_short_help_str(80)) for name in names])


class _Titled(TyperCommand):
    """Help whose options come in groups, those that many commands have last; no file has an empty name."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        for before, word in pairwise(("", *args)):
            if not word and (not before.startswith("-") or before in ("-o", "--output")):
                # As a path, an empty word would be the folder that one is in.
                raise InputError(f"a word of plantar {ctx.info_name} is empty; allowed: a file's or folder's name")
        return super().parse_args(ctx, args)

    def format_options(self, ctx: Any, formatter: Any) -> None:
        sections: dict[str, list[tuple[str, str]]] = {"Arguments": []}
        for parameter in self.get_params(ctx):
            record = parameter.get_help_record(ctx)
            kind = "Arguments" if parameter.param_type_name == "argument" else "Options"
            if record is not None:
                sections.setdefault(getattr(parameter, "rich_help_panel", None) or kind, []).append(record)
        sections["Options"] = sections.pop("Options", [])
        for title, records in sections.items():
            if records:
                with formatter.section(title):
                    formatter.write_dl(records)


app = typer.Typer(
    name="plantar",
    cls=_Groups,
    no_args_is_help=True,
    add_completion=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)
"""The commands."""


def _print_version(wanted: bool) -> None:
    if wanted:
        print(f"plantar {VERSION}")
        raise typer.Exit


@app.callback()
def _commands(
    version: Annotated[
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Print the version and exit.")
    ] = False,
) -> None:
    """Plantar skin and gait: build a tactile shoe, walk a robot on plantar feedback, analyse recordings."""
    if kernels.problem:
        print_note(kernels.form_text())


def _found() -> dict[str, Command]:
    """This package's commands by name, then others' (entry points of `plantar.commands`)."""
    modules = iter_modules(commands.__path__, f"{commands.__name__}.")
    own = [import_module(module.name).COMMAND for module in modules]
    found = {command.name or command.function.__name__: command for command in own}
    try:
        return {**found, **extensions("plantar.commands", Command, tuple(found))}
    except InputError as error:  # this package's commands run all the same
        print_note(f"{error}; commands of other packages are left out")
        return found


for _name, _command in sorted(_found().items(), key=lambda found: found[1].place):
    app.command(name=_name, cls=_Titled, short_help=_command.summary)(_command.function)


def main() -> None:
    """Entry point of the console script.

    Example:
        >>> main()  # doctest: +SKIP
    """
    sys.exit(run(lambda: run_command(app)))
