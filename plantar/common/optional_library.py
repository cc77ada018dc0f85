"""Imports of optional libraries: missing, broken or interrupted."""

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from types import FrameType

from plantar.errors import DependencyError

_INTERRUPTS = (signal.SIGINT, signal.SIGTERM)


@contextmanager
def optional_library(library: str, extra: str) -> Iterator[None]:
    """Guard the import of an optional library; only imports belong into the block.

    Only that very module's absence is "not installed". Ctrl-C waits until it is loaded.

    Yields None.

    Example:
        >>> with optional_library("no_such_library", "shoes"):
        ...     import no_such_library
        Traceback (most recent call last):
        plantar.errors.DependencyError: no_such_library is not installed; install it with: pip install 'plantar[shoes]'
    """
    with _interrupts_held_back():
        try:
            yield
        except ModuleNotFoundError as error:
            reason = None if error.name == library else str(error)
            raise DependencyError(library, extra, reason) from None
        except Exception as error:  # while loading, a library that is broken raises any error
            raise DependencyError(library, extra, f"{type(error).__name__}: {error}") from None


def need_libraries(extra: str, *libraries: str) -> None:
    """Raise an error unless all can be loaded. `libraries`: names of modules as they are imported.

    Example:
        >>> need_libraries("sim", "json", "no_such_library")
        Traceback (most recent call last):
        plantar.errors.DependencyError: no_such_library is not installed; install it with: pip install 'plantar[sim]'
    """
    for library in libraries:
        with optional_library(library, extra):
            import_module(library)


@contextmanager
def _interrupts_held_back() -> Iterator[None]:
    """Deliver a signal after the block; a second one of its kind at once."""
    if threading.current_thread() is not threading.main_thread():  # signals reach the main thread only
        yield
        return
    before = {n: h for n in _INTERRUPTS if callable(h := signal.getsignal(n))}
    came: list[int] = []

    def hold_back(number: int, frame: FrameType | None) -> None:
        came.append(number)
        if came.count(number) > 1:
            before[signal.Signals(number)](number, frame)

    for number in before:
        signal.signal(number, hold_back)
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
        if came:
            before[signal.Signals(came[0])](came[0], None)
