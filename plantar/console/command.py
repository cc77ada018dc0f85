"""What all commands share: running the one that is named, the options of its output, and printing what it found."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Annotated, Any, NamedTuple, cast

import typer

from plantar.console.ending import BAD_INPUT, one_line, plain_lines
from plantar.errors import InputError

__all__ = ["Command", "Json", "Output", "end_command", "file_lines", "run_command"]

Output = Annotated[Path, typer.Option("-o", "--output", help="Folder for the files.")]
"""The option for where a command writes."""

Json = Annotated[bool, typer.Option("--json", help="Print one JSON object on stdout.")]
"""The option for what a program reads."""


_WIDEST_HELP = 120
"""Columns that the help takes where the terminal has them; typer's own 80 break the examples in two."""


class Command(NamedTuple):
    """A command of the command line.

    Attributes:
        function: What runs; its parameters are the command's, as typer reads them.
        summary: One line for the list of commands.
        place: Place in that list, ascending.
        name: What it is called; the function's name where empty.
    """

    function: Callable[..., None]
    summary: str
    place: int = 1000
    name: str = ""


def run_command(app: typer.Typer) -> int:
    """Run the command that the process's arguments name.

    Typer's own way to run it would print several lines for a wrong argument, and end with 1 where no one reads stdout.

    Raises:
        InputError: If an argument is wrong; the message names which help shows more.
        KeyboardInterrupt: If the user stopped it.

    Example:
        >>> app = typer.Typer()
        >>> @app.command()
        ... def nothing() -> None: ...
        >>> arguments, sys.argv = sys.argv, ["plantar"]
        >>> run_command(app)
        0
        >>> sys.argv = arguments
    """
    usage_error = cast(type[Exception], typer.BadParameter.__base__)  # typer exports it under no public name
    command = typer.main.get_command(app)
    if "_PLANTAR_COMPLETE" in os.environ:  # a shell asks how a word goes on; click answers it and ends
        command.main(prog_name="plantar")
    try:
        with command.make_context("plantar", sys.argv[1:], max_content_width=_WIDEST_HELP) as context:
            command.invoke(context)
        return 0
    except typer.Exit as end:
        return int(end.exit_code)
    except typer.Abort:
        raise KeyboardInterrupt from None
    except usage_error as error:
        text = cast(Any, error).format_message()
        if "\n" in text:  # `plantar` alone: the help
            print(plain_lines(text), file=sys.stderr)
            return BAD_INPUT
        place = getattr(getattr(error, "ctx", None), "command_path", None) or _command_path(command)
        raise InputError(f"{text.rstrip('.')}; see {place} --help") from None


def _command_path(command: Any) -> str:
    """The command that the process's arguments name: the error of an option without its value lacks it."""
    first = next((word for word in sys.argv[1:] if not word.startswith("-")), "")
    return f"plantar {first}" if first in getattr(command, "commands", {}) else "plantar"


def end_command(
    result: Mapping[str, Any], as_json: bool, text: str, failures: Iterable[str] = (), failed: bool = False
) -> None:
    """Show what a command found: one JSON object or words on stdout, what failed on stderr.

    Args:
        result: What was found.
        as_json: Whether a program reads it.
        text: The same for people.
        failures: What failed, a line each.
        failed: Whether the command failed as a whole.

    Raises:
        typer.Exit: With exit code 1, if it failed.

    Example:
        >>> end_command({"steps": 4}, True, "4 steps")
        {"steps": 4}
    """
    print(json.dumps(result) if as_json else plain_lines(text))
    for line in failures:
        print(f"plantar: {one_line(line)}", file=sys.stderr)
    if failed:
        raise typer.Exit(1)


def file_lines(names: Iterable[str]) -> str:
    """Names of files, each in its own line below what was found.

    Returns:
        The lines, with a line end before each.

    Example:
        >>> "made:" + file_lines(["a.csv"])
        'made:\\n  a.csv'
    """
    return "".join(f"\n  {name}" for name in names)
