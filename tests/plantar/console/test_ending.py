"""How a command ends: exit codes, one line on stderr, and nothing temporary left behind."""

from __future__ import annotations

import errno
import os
import signal
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from plantar.atomic import output_folder
from plantar.console.ending import Terminated, one_line, run
from plantar.errors import InputError


def raising(error: BaseException) -> Callable[[], int]:
    def command() -> int:
        raise error

    return command


@pytest.mark.parametrize(
    ("error", "code", "line"),
    [
        (InputError("no such thing; allowed: another"), 2, "plantar: no such thing; allowed: another"),
        (InputError("two\nlines\x1b[2J and \udcff"), 2, "plantar: two\\nlines\\x1b[2J and \\udcff"),
        (KeyboardInterrupt(), 130, "plantar: interrupted"),
        (Terminated(signal.SIGTERM), 143, "plantar: told to end (SIGTERM)"),
        (MemoryError(), 2, "plantar: not enough memory for this input"),
        (OSError(errno.ENOSPC, "No space left on device"), 2, "plantar: cannot write the output: No space left"),
        (OSError(errno.ENAMETOOLONG, "File name too long", "x" * 9), 2, "plantar: xxxxxxxxx: File name too long"),
    ],
)
def test_what_goes_wrong_is_one_line_and_a_code(
    error: BaseException, code: int, line: str, capfd: pytest.CaptureFixture[str]
) -> None:
    assert run(raising(error)) == code
    said = capfd.readouterr()
    assert said.out == ""
    assert said.err.startswith(line)
    assert said.err.count("\n") == 1


def test_a_fault_of_the_program_is_not_hidden() -> None:
    with pytest.raises(ZeroDivisionError):
        run(raising(ZeroDivisionError()))


def test_a_pipe_that_nobody_reads_is_told_by_the_code_alone(capfd: pytest.CaptureFixture[str]) -> None:
    assert run(raising(BrokenPipeError(errno.EPIPE, "Broken pipe"))) == 141
    assert capfd.readouterr().err == ""


@pytest.mark.parametrize("code", [0, 1])
def test_what_a_command_returns_is_its_code(code: int) -> None:
    assert run(lambda: code) == code
    assert run(lambda: None) == 0


@pytest.mark.parametrize(("number", "code"), [(signal.SIGTERM, 143), (signal.SIGHUP, 129)])
def test_a_process_that_is_told_to_end_leaves_nothing(
    tmp_path: Path, number: signal.Signals, code: int, capfd: pytest.CaptureFixture[str]
) -> None:
    def command() -> int:
        with output_folder(tmp_path / "out") as folder:
            (folder / "half").write_text("half")
            os.kill(os.getpid(), number)
            time.sleep(10.0)
        return 0

    before = signal.getsignal(number)
    assert run(command) == code
    assert list(tmp_path.iterdir()) == []
    assert capfd.readouterr().err.count("\n") == 1
    assert signal.getsignal(number) == before


def test_a_signal_that_is_ignored_stays_ignored() -> None:
    """As `nohup` does it."""

    def command() -> int:
        os.kill(os.getpid(), signal.SIGHUP)
        return 0

    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        assert run(command) == 0
    finally:
        signal.signal(signal.SIGHUP, before)


def test_a_closed_stderr_does_not_turn_into_stdout(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "stderr", None)
    assert run(raising(InputError("wrong"))) == 2
    sys.stderr.close()
    assert capfd.readouterr().out == ""


def test_one_line_keeps_letters_of_any_language() -> None:
    assert one_line(" größe – 足\t\n") == "größe – 足"
    assert one_line("a\tb\r\n\u2028c") == "a\\tb\\r\\n\\u2028c"
