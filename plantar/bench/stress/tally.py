"""Counting what a stress run checks: readings, worst errors, and the failures with what it takes to see them again."""

from __future__ import annotations

import math
import signal
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from plantar.bench.stress.soles import Block

__all__ = ["Tally", "Tested"]

_PATIENCE = 60.0
"""Time in s after which a check of one block hangs."""

_KEPT = 5
"""Failures that are kept of each function."""


@dataclass
class Tested:
    """What was seen of one function.

    Attributes:
        bound: Error that its documentation allows.
        readings: How many readings it was called with.
        worst: Largest error seen.
        failures: How many readings left the bound, raised or gave NaN.
        seconds: Time spent on it and its check.
        examples: The first failures, each with sole, block and reading.
    """

    bound: float
    readings: int = 0
    worst: float = 0.0
    failures: int = 0
    seconds: float = 0.0
    examples: list[str] = field(default_factory=list)


class Tally:
    """Results of all functions by name.

    Example:
        >>> Tally().failures
        0
    """

    def __init__(self) -> None:
        self.tested: dict[str, Tested] = {}
        self._since = time.perf_counter()

    @property
    def failures(self) -> int:
        """Failures of all functions together."""
        return sum(t.failures for t in self.tested.values())

    def add(self, name: str, block: Block, errors: ArrayLike, bound: float = 0.0, readings: int | None = None) -> None:
        """Note the errors of one function on one block.

        Args:
            name: The function.
            block: The readings.
            errors: Error of each reading or each value checked; NaN is a failure.
            bound: What it may be.
            readings: How many readings were tried; as many as there are errors where None.
        """
        values = np.asarray(errors, dtype=float).reshape(-1)
        tested = self.tested.get(name)
        if tested is None:
            tested = self.tested[name] = Tested(bound)
        tested.readings += len(values) if readings is None else readings
        worst = float(values.max(initial=-math.inf))
        if not worst <= tested.worst:
            tested.worst = math.inf if math.isnan(worst) else worst
        if not worst <= bound:
            bad = ~(values <= bound)
            tested.failures += int(bad.sum())
            for i in np.flatnonzero(bad)[: max(0, _KEPT - len(tested.examples))].tolist():
                self._example(tested, block, f"value {i} of {len(values)}: error {values[i]:.3g}, allowed {bound:.3g}")
        now = time.perf_counter()
        tested.seconds += now - self._since
        self._since = now

    def _example(self, tested: Tested, block: Block, text: str) -> None:
        tested.examples.append(f"sole '{block.layout.name}', block {block.number}: {text}")

    def run(self, check: Callable[[Block, Tally], None], block: Block) -> None:
        """Run one check on one block; what it raises, or that it hangs, is a failure.

        Args:
            check: The check.
            block: The readings.
        """
        self._since = time.perf_counter()
        try:
            with _patience():
                check(block, self)
        except Exception as error:
            tested = self.tested.setdefault(f"{check.__name__.lstrip('_')} raises", Tested(0.0))
            tested.readings += len(block)
            tested.failures += 1
            if len(tested.examples) < _KEPT:
                self._example(tested, block, f"{_where(error)}: {type(error).__name__}: {error}")


def _where(error: BaseException) -> str:
    trace: Any = error.__traceback__
    while trace is not None and trace.tb_next is not None:
        trace = trace.tb_next
    return f"{trace.tb_frame.f_code.co_filename}:{trace.tb_lineno}" if trace else "?"


@contextmanager
def _patience() -> Iterator[None]:
    """Interrupt what hangs, where signals reach."""
    if not hasattr(signal, "setitimer") or threading.current_thread() is not threading.main_thread():
        yield
        return

    def stop(_number: int, _frame: object) -> None:
        raise TimeoutError(f"hangs for {_PATIENCE:.0f} s")

    before = signal.signal(signal.SIGALRM, stop)
    signal.setitimer(signal.ITIMER_REAL, _PATIENCE)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
