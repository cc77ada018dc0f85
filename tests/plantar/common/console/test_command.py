"""What all commands share: exit codes, and words or JSON."""

import json
import sys
from typing import Annotated

import pytest
import typer

from plantar.common.console.command import end_command, file_lines, run_command
from plantar.errors import InputError

app = typer.Typer(no_args_is_help=True, add_completion=False, rich_markup_mode=None)


@app.command()
def end(code: int, stop: bool = False) -> None:
    """End with a code."""
    if stop:
        raise typer.Abort
    raise typer.Exit(code)


@app.command()
def sing(song: Annotated[str, typer.Option()] = "") -> None:
    """Sing a song."""


@app.command()
def other() -> None:
    """Another one."""


def called(monkeypatch: pytest.MonkeyPatch, *arguments: str) -> int:
    monkeypatch.setattr(sys, "argv", ["plantar", *arguments])
    return run_command(app)


@pytest.mark.parametrize("code", [0, 1, 7])
def test_a_commands_exit_code_comes_back(monkeypatch, code):
    assert called(monkeypatch, "end", str(code)) == code


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["nothing"], "see plantar --help"),
        (["end"], "see plantar end --help"),
        (["end", "many"], "see plantar end --help"),
        (["end", "1", "--no-such"], "see plantar end --help"),
        (["sing", "--song"], "'--song' requires an argument; see plantar sing --help"),
    ],
)
def test_a_wrong_argument_is_one_line_that_names_the_help(monkeypatch, arguments, words):
    with pytest.raises(InputError, match=words) as error:
        called(monkeypatch, *arguments)
    assert "\n" not in str(error.value)


def test_no_argument_is_the_help(monkeypatch, capsys):
    assert called(monkeypatch) == 2
    assert "Another one." in capsys.readouterr().err


def test_a_stop_is_an_interrupt(monkeypatch):
    with pytest.raises(KeyboardInterrupt):
        called(monkeypatch, "end", "0", "--stop")


@pytest.mark.parametrize("as_json", [True, False])
@pytest.mark.parametrize("failed", [True, False])
def test_what_failed_is_told_on_stderr_whatever_is_on_stdout(capsys, as_json, failed):
    code = 0
    try:
        end_command({"a": [1]}, as_json, "one a", ["it broke"] if failed else [], failed)
    except typer.Exit as stop:
        code = stop.exit_code
    out, err = capsys.readouterr()
    assert code == int(failed)
    assert err == ("plantar: it broke\n" if failed else "")
    assert (json.loads(out) == {"a": [1]}) if as_json else (out == "one a\n")


def test_files_are_a_line_each():
    assert "made" + file_lines([]) == "made"
    assert file_lines(["a", "b"]) == "\n  a\n  b"
