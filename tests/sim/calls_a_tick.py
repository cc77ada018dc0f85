"""Counts the calls of a control tick: exact on any machine, where times are not.

`python tests/sim/calls_a_tick.py` counts them again and writes the limits, `calls_a_tick.csv`: a change that needs more
calls shows there by how many. Every third tick of the first steps is counted, with sensors, controller, physics and
judge.
"""

import csv
import dis
import sys
from collections.abc import Callable
from pathlib import Path
from types import CodeType, FrameType
from typing import Any, NamedTuple

from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene

LIMITS = Path(__file__).with_suffix(".csv")
CASES = [(s, r) for s in ("flat", "beam", "uneven", "stones", "push-step", "wander") for r in ("h1", "hrp2kai")]

BETWEEN = (1.9, 3.4)
"""Simulated time in s that is counted: from the end of the first double support into the second."""

ALLOWED = 0.5
"""Calls a tick above the limit that still pass: less than one call that is made in each tick."""

SAMPLED = 3  # ticks from one counted to the next

_CALLS = {number for name, number in dis.opmap.items() if name.startswith("CALL") and "INTRINSIC" not in name}


class Calls(NamedTuple):
    """Mean calls of a tick.

    Attributes:
        functions: Python functions that were entered, properties and comprehensions among them.
        calls: Calls that they made, of functions, classes, kernels and numpy.
    """

    functions: float
    calls: float


class CallCounter:
    """Counts what Python does while it is on."""

    def __init__(self) -> None:
        self.functions = self.calls = 0
        self._of: dict[CodeType, Callable[..., Any]] = {}
        self._before: Any = None

    def on(self) -> None:
        """Count from now on what is called from here."""
        self._before = sys.gettrace()
        sys.settrace(self._enter)

    def off(self) -> None:
        """Count no longer."""
        sys.settrace(self._before)

    def _enter(self, frame: FrameType, event: str, _: object) -> Callable[..., Any]:
        self.functions += 1
        frame.f_trace_lines, frame.f_trace_opcodes = False, True
        code = frame.f_code
        counter = self._of.get(code)
        if counter is None:
            counter = self._of[code] = self._counter(code)
        return counter

    def _counter(self, code: CodeType) -> Callable[..., Any]:
        places = {i.offset for i in dis.get_instructions(code) if i.opcode in _CALLS}

        def count(frame: FrameType, event: str, _: object) -> Callable[..., Any]:
            if event == "opcode" and frame.f_lasti in places:
                self.calls += 1
            return count

        return count


def calls_a_tick(scene: str, robot: str, between: tuple[float, float] = BETWEEN) -> Calls:
    """Mean calls of the sampled ticks of a scene with a robot, seed 0, in a part of the simulated time."""
    counter, ticks = CallCounter(), 0

    class Counted(Simulation):
        @property
        def end(self) -> float:
            return between[1]

        def sense(self, k: int) -> None:
            nonlocal ticks
            every = round(self.periods[1] / self.periods[0])
            if k % every == 0:
                counter.off()
                if k * self.periods[0] >= between[0] and (k // every) % SAMPLED == 0:
                    ticks += 1
                    counter.on()
            super().sense(k)

    simulation = Counted(load_scene(scene, robot=robot), 0)
    before = sys.gettrace()
    try:
        simulation.run()
    finally:
        sys.settrace(before)
    return Calls(counter.functions / ticks, counter.calls / ticks)


def limits() -> dict[tuple[str, str], Calls]:
    """The stored calls of each scene and robot."""
    with LIMITS.open(newline="", encoding="utf-8") as file:
        return {(r["scene"], r["robot"]): Calls(float(r["functions"]), float(r["calls"])) for r in csv.DictReader(file)}


def main() -> None:
    """Count all and write the limits."""
    rows = [(*case, *(f"{count:.1f}" for count in calls_a_tick(*case))) for case in CASES]
    with LIMITS.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("scene", "robot", *Calls._fields))
        writer.writerows(rows)


if __name__ == "__main__":
    main()
