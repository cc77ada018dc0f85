"""Options of a command that are declared as dataclasses."""

from dataclasses import dataclass, field
from typing import Any

import pytest
import typer
from typer.testing import CliRunner

from plantar import cli
from plantar.common.console.command import with_option_groups


def option(default: Any, text: str, **more: Any) -> Any:
    return field(default=default, metadata={"help": text, **more})


@dataclass(frozen=True)
class Size:
    unasked: str = "kept"
    length: float = option(1.0, "How long.", metavar="MM")
    side_name: str | None = option(None, "Which side.")
    flat: bool = option(False, "Without height.")


app = typer.Typer(rich_markup_mode=None)
seen: list[tuple[Any, ...]] = []


@app.command()
@with_option_groups
def make(size: Size, name: str, times: int = 2) -> None:
    """Make something."""
    seen.append((size, name, times))


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["a"], (Size(), "a", 2)),
        (["--length", "3", "a", "--times", "5"], (Size(length=3.0), "a", 5)),
        (["b", "--flat", "--side-name", "left"], (Size(side_name="left", flat=True), "b", 2)),
    ],
)
def test_the_command_gets_its_group_and_its_single_arguments(arguments, expected):
    done = CliRunner().invoke(app, arguments, catch_exceptions=False)
    assert done.exit_code == 0, done.output
    assert seen.pop() == expected


def test_the_help_tells_each_field_that_is_an_option():
    text = CliRunner().invoke(app, ["--help"]).output
    assert "Make something." in text
    assert "--length MM" in text
    assert "How long." in text
    assert "Which side." in text
    assert "unasked" not in text
    assert "--size" not in text


def test_a_wrong_value_names_the_single_option():
    done = CliRunner().invoke(app, ["a", "--length", "long"])
    assert done.exit_code == 2
    assert "--length" in done.output


def test_a_name_twice_is_refused():
    def twice(size: Size, length: float = 1.0) -> None: ...

    with pytest.raises(TypeError, match="twice has an option twice: length, side_name, flat, length"):
        with_option_groups(twice)


def test_the_commands_help_has_groups_with_choices_and_what_all_have_last():
    text = CliRunner().invoke(cli.app, ["analyze", "--help"]).output
    heads = ["Arguments:", "What the file does not state:", "Which steps, and whose:", "Of a folder: what is compared:"]
    places = [text.index(head) for head in [*heads, "Options:"]]
    assert places == sorted(places)
    assert "--side left|right" in text
    assert text.index("  --participants") > places[3]
    assert text.index("  -o, --output") > places[4]
