"""The stress run: a million readings thrown at every function of the perception, and what comes back checked."""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any

from plantar.bench.stress.arguments import ARGUMENT_CHECKS
from plantar.bench.stress.fields import FIELD_CHECKS
from plantar.bench.stress.force import FORCE_CHECKS, LAST_CHECKS
from plantar.bench.stress.random_cells import RANDOM_CHECKS
from plantar.bench.stress.shapes import SHAPE_CHECKS
from plantar.bench.stress.soles import blocks_of, stress_soles
from plantar.bench.stress.tally import Tally, Tested
from plantar.errors import InputError

__all__ = ["StressResult", "stress"]


CALLED_BY: dict[str, str] = {
    "feet_support_polygon": "FeetPercept",
    "concave_outline": "Percept.concave_outline_in_sole",
    "fit_ground_plane": "Percept.ground_plane_in_sole",
    "preemptive_polygon": "Percept.preemptive_polygon_in_sole",
    "rectangle_in_outline": "Percept.outline_rectangle_in_sole",
    "rectangle_in_outline_any_angle": "Percept.outline_rectangle_any_angle_in_sole",
    **{
        name: f"Percept.{name}_in_sole"
        for name in (
            "bounding_box",
            "enclosing_parallelogram",
            "inscribed_circle",
            "inscribed_parallelogram",
            "inscribed_rectangle",
            "inscribed_rectangle_any_angle",
            "inscribed_triangle",
            "oriented_box",
        )
    },
}
"""What hands every reading to a function, beside the check of its own that gives it odd input."""


@dataclass(frozen=True)
class StressResult:
    """What a stress run saw.

    Attributes:
        readings: Readings that were thrown.
        seed: Seed of the run.
        seconds: How long it took.
        functions: Of each function or property the readings, the worst error, the bound and the failures.
    """

    readings: int
    seed: int
    seconds: float
    functions: dict[str, Tested]

    @property
    def least(self) -> int:
        """Readings that the function met that met the fewest, over all functions: a check that only looks closer at
        some of a function's results counts for that function, and so does the percept's member that calls it."""
        met: dict[str, int] = {}
        for name, tested in self.functions.items():
            function = name.split(":")[0].split(",")[0]
            if function in ("Percept", "wrong arguments"):
                continue
            function = CALLED_BY.get(function, function)
            met[function] = max(met.get(function, 0), tested.readings)
        return min(met.values(), default=0)

    @property
    def failures(self) -> int:
        """Failures of all functions together."""
        return sum(t.failures for t in self.functions.values())

    def as_dict(self) -> dict[str, Any]:
        """All figures, for `--json`."""
        tested = [{"function": name, **asdict(t)} for name, t in sorted(self.functions.items())]
        return {
            "readings": self.readings,
            "least_readings_of_a_function": self.least,
            "seed": self.seed,
            "seconds": round(self.seconds, 1),
            "failures": self.failures,
            "functions": tested,
        }


def stress(
    readings: int = 1_000_000, seed: int = 0, progress: Callable[[float, str], None] | None = None
) -> StressResult:
    """Throw readings at every public function of the perception.

    A warning of numpy counts as a failure, since the code means to do without; so does what raises, hangs, gives NaN
    unasked, or leaves its bound. With each block of readings some functions are called with wrong arguments, too.

    Args:
        readings: How many at least, 1 or more.
        seed: Of what is left to chance.
        progress: Called with the fraction done and a text.

    Returns:
        Counts, worst errors and failures.

    Raises:
        InputError: If there is not at least one reading.
    """
    if readings < 1:
        raise InputError(f"stress run of {readings} readings; allowed: 1 or more")
    tally = Tally()
    start = time.perf_counter()
    done = 0
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for block in blocks_of(stress_soles(), readings, seed):
            for check in (
                *FORCE_CHECKS,
                *SHAPE_CHECKS,
                *FIELD_CHECKS,
                *RANDOM_CHECKS,
                *ARGUMENT_CHECKS,
                *LAST_CHECKS,
            ):
                tally.run(check, block)
            done += len(block)
            del block  # its memory, still in the cache, is what the next block takes
            if progress is not None:
                progress(min(1.0, done / readings), f"{done} readings, {tally.failures} failures")
    return StressResult(done, seed, time.perf_counter() - start, tally.tested)
