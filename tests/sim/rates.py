"""Rates of walks: seeds drawn from a test's name, and shares with their intervals."""

import hashlib
import os
from collections.abc import Callable, Iterable

from plantar.bench.intervals import wilson_interval

DRAW = os.environ.get("PLANTAR_TEST_DRAW", "0")
"""Which set of seeds is drawn: any other text draws another one, with which the tests have to pass as well."""


def drawn_seeds(test: Callable[..., object], count: int, also: str = "") -> list[int]:
    """Returns `count` seeds by the name of a `test`, and `also` by a text, such as a robot's name."""
    texts = (f"{test.__module__}.{test.__qualname__} {also} {DRAW} {k}" for k in range(count))
    return [int(hashlib.sha256(text.encode()).hexdigest()[:7], 16) for text in texts]


def check_rate(held: Iterable[bool], least: float = 0.0, most: float = 1.0) -> None:
    """Check that what `held` in some of several runs does not contradict a true rate of `least` to `most`.

    It does where Wilson's 95 % interval lies outside: three of four runs do not contradict a rate of 0.9, one does.
    """
    runs = list(held)
    low, high = wilson_interval(sum(runs), len(runs))
    assert high >= least, f"held in {sum(runs)} of {len(runs)} runs, at most {high:.2f} of all; wanted: {least:g}"
    assert low <= most, f"held in {sum(runs)} of {len(runs)} runs, at least {low:.2f} of all; wanted: {most:g}"
