"""Common parts of commands: running, output options, and printing."""

import functools
import inspect
import json
import os
import sys
from collections.abc import Callable, Iterable, Mapping
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Annotated, Any, NamedTuple, TypeVar, cast, get_type_hints

import typer

from plantar.common.console.ending import BAD_INPUT, one_line, plain_lines
from plantar.errors import InputError

Output = Annotated[Path, typer.Option("-o", "--output", help="Folder for the files.")]
"""The option for where a command writes."""

Json = Annotated[bool, typer.Option("--json", help="Print one JSON object on stdout.")]
"""The option for what a program reads."""


_WIDEST_HELP = 120  # Columns that the help takes where the terminal has them; typer's own 80 break the examples in two


class Command(NamedTuple):
    """Command of the command line.

    Attributes:
        function: Its parameters are the command's, by typer.
        summary: One line, for the list.
        place: In that list, ascending.
        name: Function's if empty.
    """

    function: Callable[..., None]
    summary: str
    place: int = 1000
    name: str = ""


def run_command(app: typer.Typer) -> int:
    """Run the command named by the process's arguments.

    Typer prints several lines for wrong arguments, and exits with 1 if stdout is closed.
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
    """Command in the arguments, which errors of an option without value lack."""
    first = next((word for word in sys.argv[1:] if not word.startswith("-")), "")
    return f"plantar {first}" if first in getattr(command, "commands", {}) else "plantar"


def end_command(
    result: Mapping[str, Any], as_json: bool, text: str, failures: Iterable[str] = (), failed: bool = False
) -> None:
    """Print a command's `result`, as one JSON object if `as_json`, else `text`; then `failures` on stderr, a line
    each.

    Raises typer.Exit with code 1 if `failed`.
    """
    print(json.dumps(result) if as_json else plain_lines(text))
    for line in failures:
        print(f"plantar: {one_line(line)}", file=sys.stderr)
    if failed:
        raise typer.Exit(1)


def file_lines(names: Iterable[str]) -> str:
    """File names, a line each, after a line end."""
    return "".join(f"\n  {name}" for name in names)


T = TypeVar("T")


def with_option_groups(command: Callable[..., T]) -> Callable[..., T]:
    """Replace a command's dataclass parameters by their options; returns the function of single options.

    Typer knows no groups. Fields with "help" in their metadata are options; "metavar" is shown for the value, "names"
    replaces option names; all have defaults. A class's TITLE is their heading in the help. TypeError if names repeat.

    Example:
        >>> from dataclasses import dataclass, field
        >>> @dataclass(frozen=True)
        ... class Size:
        ...     length: float = field(default=1.0, metadata={"help": "Length in m."})
        ...     width: float = field(default=2.0, metadata={"help": "Width in m."})
        >>> def area(size: Size, times: int = 1) -> float:
        ...     return times * size.length * size.width
        >>> with_option_groups(area)(length=3.0, times=2)
        12.0
    """
    hints = get_type_hints(command, include_extras=True)
    groups: dict[str, type[Any]] = {}
    options: list[inspect.Parameter] = []
    for parameter in inspect.signature(command).parameters.values():
        kind = hints[parameter.name]
        if isinstance(kind, type) and is_dataclass(kind):
            groups[parameter.name] = kind
            options += _options_of(kind)
        else:
            options.append(parameter.replace(annotation=kind, kind=inspect.Parameter.KEYWORD_ONLY))
    names = [option.name for option in options]
    if len(set(names)) < len(names):
        raise TypeError(f"{command.__name__} has an option twice: {', '.join(names)}")

    @functools.wraps(command)
    def of_single_options(**given: Any) -> T:
        made = {
            name: kind(**{f.name: given.pop(f.name) for f in fields(kind) if f.name in given})
            for name, kind in groups.items()
        }
        return command(**made, **given)

    of_single_options.__signature__ = inspect.Signature(options)  # type: ignore[attr-defined]
    of_single_options.__annotations__ = {option.name: option.annotation for option in options}
    return of_single_options


def _options_of(group: type[Any]) -> list[inspect.Parameter]:
    hints = get_type_hints(group)
    return [
        inspect.Parameter(
            f.name,
            inspect.Parameter.KEYWORD_ONLY,
            default=f.default,
            annotation=Annotated[
                hints[f.name],
                typer.Option(
                    *f.metadata.get("names", ()),
                    help=f.metadata["help"],
                    metavar=f.metadata.get("metavar"),
                    rich_help_panel=getattr(group, "TITLE", None),
                ),
            ],
        )
        for f in fields(group)
        if "help" in f.metadata
    ]
