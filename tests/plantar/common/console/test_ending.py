"""How a command ends: exit codes, one line on stderr, and nothing temporary left behind."""

import ast
import errno
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from plantar.common.atomic import output_folder
from plantar.common.console.ending import Terminated, one_line, plain_lines, run
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
        (Terminated(signal.SIGTERM), 143, "plantar: ended (SIGTERM)"),
        (MemoryError(), 2, "plantar: not enough memory for this input"),
        (OSError(errno.ENOSPC, "No space left on device"), 2, "plantar: cannot write the output: No space left"),
        (OSError(errno.ENAMETOOLONG, "File name too long", "x" * 9), 2, "plantar: xxxxxxxxx: File name too long"),
    ],
)
def test_what_goes_wrong_is_one_line_and_a_code(error, code, line, capfd):
    assert run(raising(error)) == code
    said = capfd.readouterr()
    assert said.out == ""
    assert said.err.startswith(line)
    assert said.err.count("\n") == 1


def test_a_fault_of_the_program_is_not_hidden():
    with pytest.raises(ZeroDivisionError):
        run(raising(ZeroDivisionError()))


def test_a_pipe_that_nobody_reads_is_told_by_the_code_alone(capfd):
    assert run(raising(BrokenPipeError(errno.EPIPE, "Broken pipe"))) == 141
    assert capfd.readouterr().err == ""


@pytest.mark.parametrize("code", [0, 1])
def test_what_a_command_returns_is_its_code(code):
    assert run(lambda: code) == code
    assert run(lambda: None) == 0


@pytest.mark.parametrize(("number", "code"), [(signal.SIGTERM, 143), (signal.SIGHUP, 129)])
def test_a_process_that_is_told_to_end_leaves_nothing(tmp_path, number, code, capfd):
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


def test_a_signal_that_is_ignored_stays_ignored():
    """As `nohup` does it."""

    def command() -> int:
        os.kill(os.getpid(), signal.SIGHUP)
        return 0

    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        assert run(command) == 0
    finally:
        signal.signal(signal.SIGHUP, before)


def test_a_closed_stderr_does_not_turn_into_stdout(monkeypatch, capfd):
    monkeypatch.setattr(sys, "stderr", None)
    assert run(raising(InputError("wrong"))) == 2
    sys.stderr.close()
    assert capfd.readouterr().out == ""


def test_one_line_keeps_letters_of_any_language():
    assert one_line(" größe – 足\t\n") == "größe – 足"
    assert one_line("a\tb\r\n\u2028c") == "a\\tb\\r\\n\\u2028c"


def test_an_interrupt_that_python_ignores_comes_once_more(capfd):
    class Closing:
        def __del__(self) -> None:
            raise KeyboardInterrupt

    def command() -> int:
        closing = Closing()
        del closing  # Python ignores what it raises
        time.sleep(5.0)
        return 0

    assert run(command) == 130
    assert capfd.readouterr().err == "plantar: interrupted\n"


def test_ctrl_c_at_any_moment_of_the_start_ends_the_command_in_one_line():
    for wait in (0.03, 0.06, 0.1, 0.15, 0.2, 0.3):
        command = [sys.executable, "-m", "plantar", "list", "papers"]
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        time.sleep(wait)
        process.send_signal(signal.SIGINT)
        _, err = process.communicate(timeout=600)
        if process.returncode == 130:
            assert err == "plantar: interrupted\n", wait
        else:  # it had ended before, or Python itself was still at its own start
            assert process.returncode in (0, -signal.SIGINT) or "plantar/" not in err, (wait, err)


@given(st.text())
def test_no_text_moves_the_cursor(text):
    shown = plain_lines(text)
    assert all(line.isprintable() for line in shown.split("\n"))
    assert len(shown.split("\n")) == len(text.split("\n"))


def test_no_module_prints_past_the_console():
    source = Path(__file__).parents[4] / "plantar"
    other = {
        path.relative_to(source).as_posix()
        for path in source.rglob("*.py")
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "print"
    }
    assert other <= {"common/console/ending.py", "common/console/command.py", "common/files/confined.py", "cli.py"}
