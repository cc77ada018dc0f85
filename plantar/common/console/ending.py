"""How a command ends: an error is one line on stderr and an exit code, and no temporary file is left.

| exit code | means |
|---|---|
| 0, 1 | what the command returns; 1 also where a sweep's workers went away |
| 2 | bad input, a file that cannot be read or written, or not enough memory |
| 130 | interrupted (Ctrl-C) |
| 129, 143 | the terminal was closed (SIGHUP), the process was asked to end (SIGTERM) |
| 141 | no one reads stdout any more, as behind `| head`; recognised by the code alone |
"""

import os
import signal
import sys
import threading
from _thread import interrupt_main
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from types import FrameType
from typing import Any

from plantar.common.optional_library import missing_libraries
from plantar.errors import PlantarError, WorkerError

FAILED = 1
"""Exit code where what was asked for is fine and could not be done."""

BAD_INPUT = 2
"""Exit code for bad input."""

INTERRUPTED = 128 + signal.SIGINT
"""Exit code after Ctrl-C."""

_AGAIN = 0.01  # s until an interruption that Python ignored comes once more
_OUTPUT_CLOSED = 128 + 13  # SIGPIPE, which Windows does not have
_ENDED_BY = {"SIGTERM": "ended (SIGTERM)", "SIGHUP": "ended: its terminal was closed (SIGHUP)"}


class Terminated(SystemExit):
    """Process was asked to end; raised to close files and remove temporaries.

    `text` to show; None for the signal's meaning.

    Example:
        >>> Terminated(signal.SIGTERM).code
        143
    """

    def __init__(self, number: int, text: str | None = None) -> None:
        super().__init__(128 + number)
        self.text = _ENDED_BY[signal.Signals(number).name] if text is None else text


def one_line(text: object) -> str:
    """A text, such as an error that names a file, as one line that any terminal can show: line ends, control and
    broken characters escaped.

    Example:
        >>> one_line("no file 'a\\nb'")
        "no file 'a\\\\nb'"
    """
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in str(text).strip())


def plain_lines(text: object) -> str:
    """A text of several lines, such as metadata, without characters that move a terminal's cursor or set a color.

    Example:
        >>> plain_lines("name: \x1b[2Jred\\nsecond")
        'name: \\\\x1b[2Jred\\nsecond'
    """
    return "\n".join(" " * (len(x) - len(x.lstrip(" "))) + one_line(x) for x in str(text).split("\n"))


def print_note(text: object) -> None:
    """Print one line on stderr, indented."""
    print(f"  {one_line(text)}", file=sys.stderr)


def leave_at_interrupt() -> None:
    """Let Ctrl-C end the process at once while loading, before `run`: Python may lose one within an import."""
    with suppress(ValueError):  # not the main thread
        if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
            signal.signal(signal.SIGINT, _leave)


def _leave(number: int, frame: FrameType | None) -> None:
    os.write(2, b"plantar: interrupted\n")
    os._exit(INTERRUPTED)


@contextmanager
def _interruptible() -> Iterator[None]:
    """Raise KeyboardInterrupt at Ctrl-C, again where Python had to ignore it."""

    def again(lost: Any) -> None:
        if issubclass(lost.exc_type, KeyboardInterrupt):
            threading.Timer(_AGAIN, interrupt_main).start()  # at once, it would be ignored in here, too
        else:
            before(lost)

    before = sys.unraisablehook
    sys.unraisablehook = again
    if threading.current_thread() is threading.main_thread() and signal.getsignal(signal.SIGINT) is _leave:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        yield
    finally:
        sys.unraisablehook = before


def run(command: Callable[[], int | None]) -> int:
    """Run a command, which returns its exit code or None for 0, to the exit code at the top of this file.

    Example:
        >>> run(lambda: 1)
        1
    """
    _prepare_streams()
    with _interruptible(), _terminable():
        try:
            with missing_libraries():
                code = command() or 0
            if sys.stdout is not None:
                sys.stdout.flush()
        except WorkerError as error:
            return _ended(error, FAILED)
        except PlantarError as error:
            return _ended(error, BAD_INPUT)
        except KeyboardInterrupt:
            code = INTERRUPTED
        except Terminated as end:
            return _ended(end.text, int(str(end.code)))
        except BrokenPipeError:
            _drop_output()
            return _OUTPUT_CLOSED
        except MemoryError:
            return _ended("not enough memory for this input", BAD_INPUT)
        except OSError as error:
            where = "cannot write the output" if error.filename is None else one_line(os.fsdecode(error.filename))
            _drop_output()
            return _ended(f"{where}: {error.strerror or error}", BAD_INPUT)
    return _ended("interrupted", code) if code == INTERRUPTED else code


@contextmanager
def ignore_further_interrupts() -> Iterator[None]:
    """Ignore signals after the one that interrupted the block, to print its line. Yields None.

    Example:
        >>> with ignore_further_interrupts():
        ...     "work that Ctrl-C ends"
        'work that Ctrl-C ends'
    """
    try:
        yield
    except KeyboardInterrupt:
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, signal.SIG_IGN)
        raise


def _ended(text: object, code: int) -> int:
    with suppress(OSError):
        print(f"plantar: {one_line(text)}", file=sys.stderr, flush=True)
    return code


def _prepare_streams() -> None:
    """Streams that accept any text; stderr never becomes stdout."""
    if sys.stderr is None:  # closed by the caller: print() would take stdout instead
        sys.stderr = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115  for the rest of the process
    reconfigure = getattr(sys.stdout, "reconfigure", None)
    if reconfigure is not None:
        reconfigure(errors="backslashreplace")


def _drop_output() -> None:
    """Discard the rest of stdout, which the interpreter would retry at exit."""
    with suppress(OSError, ValueError, AttributeError):
        null = os.open(os.devnull, os.O_WRONLY)
        os.dup2(null, sys.stdout.fileno())
        os.close(null)


@contextmanager
def _terminable() -> Iterator[None]:
    """Raise `Terminated` at ending signals that no other handler takes."""
    numbers = [signal.Signals[name] for name in _ENDED_BY if hasattr(signal, name)]
    ours = []
    if threading.current_thread() is threading.main_thread():
        ours = [number for number in numbers if signal.getsignal(number) is signal.SIG_DFL]

    def end(number: int, frame: FrameType | None) -> None:
        for each in ours:  # a second one must not cut the clearing up short
            signal.signal(each, signal.SIG_IGN)
        raise Terminated(number)

    for number in ours:
        signal.signal(number, end)
    try:
        yield
    finally:
        for number in ours:
            signal.signal(number, signal.SIG_DFL)
