"""Options that belong together, as one dataclass: a command takes the group and still has its options one by one."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable
from dataclasses import fields, is_dataclass
from typing import Annotated, Any, TypeVar, get_type_hints

import typer

__all__ = ["with_option_groups"]

T = TypeVar("T")


def with_option_groups(command: Callable[..., T]) -> Callable[..., T]:
    """Replace each parameter of a command that is annotated with a dataclass by that dataclass's options.

    Typer reads a command's signature and knows no groups; without them a command of many options is a function of as
    many parameters. A field is an option if its metadata has "help"; "metavar" is shown for its value, and "names" are
    the option's names where the field's does not do. So the dataclass needs no typer.

    Args:
        command: The function; all fields of its dataclasses have defaults.

    Returns:
        A function of single options, in the order of parameters and fields, which calls the command with the groups.

    Raises:
        TypeError: If two parameters or fields have one name.

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
    """A parameter for each field of a dataclass that is an option."""
    hints = get_type_hints(group)
    return [
        inspect.Parameter(
            f.name,
            inspect.Parameter.KEYWORD_ONLY,
            default=f.default,
            annotation=Annotated[
                hints[f.name],
                typer.Option(*f.metadata.get("names", ()), help=f.metadata["help"], metavar=f.metadata.get("metavar")),
            ],
        )
        for f in fields(group)
        if "help" in f.metadata
    ]
