"""True walking speed against its command, and standing at a stop."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.gait.plan.phases import Timing
from plantar.gait.propose.velocity_command import VelocityTable
from plantar.sim.judging.unmet import unmet
from plantar.sim.model.world import World

SPEED_ERROR = 0.1
"""Share of the commanded speed by which the mean speed may be off."""

STEPS_TO_REST = 2
"""Steps after which a robot that was commanded to stop has to stand."""

AT_REST = 0.00824
"""Speed of the CoM in legs a beat below which it stands: 0.02 m/s for H1."""

_ORIGIN = np.zeros(2)


class VelocityTruth:
    """Follows a walk at the commanded velocities of a `table`.

    The way in the torso's heading counts against the command one step before, as a foot in the air keeps its target.

    `begin`: middle (2,) in m and heading in rad at the start. Attributes `course`: commanded place (2,) in m and
    heading in rad.
    """

    def __init__(
        self,
        world: World,
        table: VelocityTable,
        timing: Timing,
        begin: tuple[NDArray[np.float64], float] = (_ORIGIN, 0.0),
    ) -> None:
        self.course = begin
        self._world = world
        self._table = table
        self._delay = timing.single_support + timing.double_support
        self._shift = timing.start
        self._last: tuple[float, NDArray[np.float64], float] | None = None
        self._way = [0.0, 0.0]  # along the command, and as commanded, in m
        self._turn = [0.0, 0.0]  # the same in rad
        self._speed = 0.0
        self._walks_from = math.inf

    def update(self, time: float) -> None:
        """At each control tick, at `time` in s."""
        world = self._world
        data = self._world.data
        com = data.subtree_com[world.torso, :2].copy()
        heading = math.atan2(float(data.xmat[world.torso, 3]), float(data.xmat[world.torso, 0]))
        last = self._last
        self._last = (time, com, heading)
        if last is None or time <= last[0]:
            return
        period = time - last[0]
        dx, dy = (com - last[1]).tolist()
        self._speed += 0.05 * (math.hypot(dx, dy) / period - self._speed)
        command = self._table.at(time - self._delay)
        if command is None:
            self._walks_from = time + self._shift - self._delay
        if command is None or time < self._walks_from:
            return
        place, way = self.course
        ahead = math.cos(way)
        aside = math.sin(way)
        step = (command.forward * ahead - command.left * aside, command.forward * aside + command.left * ahead)
        self.course = place + period * np.array(step), way + command.turn * period
        c = math.cos(heading)
        s = math.sin(heading)
        wanted = math.hypot(command.forward, command.left)
        if wanted > 0.0:
            self._way[0] += (command.forward * (c * dx + s * dy) + command.left * (c * dy - s * dx)) / wanted
            self._way[1] += wanted * period
        if command.turn != 0.0:
            self._turn[0] += math.copysign(1.0, command.turn) * math.remainder(heading - last[2], 2.0 * math.pi)
            self._turn[1] += abs(command.turn) * period

    def summary(self, landings: list[float]) -> dict[str, Any]:
        """Shares of commanded speeds, and the last stop, by touchdowns `landings` in s."""
        stops = [t for t, c in zip(self._table.times, self._table.commands, strict=True) if c is None]
        return {
            "speed_ratio": round(self._way[0] / self._way[1], 4) if self._way[1] > 0.0 else None,
            "turn_ratio": round(self._turn[0] / self._turn[1], 4) if self._turn[1] > 0.0 else None,
            "walked_m": round(self._way[0], 3),
            "turned_deg": round(math.degrees(self._turn[0]), 1),
            "steps_after_stop": sum(t > stops[-1] for t in landings) if stops else None,
            "last_speed_m_s": round(self._speed, 4),
        }

    def reasons(self, landings: list[float]) -> list[dict[str, Any]]:
        """Failed criteria, as `verdict.reasons`, by touchdowns `landings` in s."""
        figures = self.summary(landings)
        steps = figures["steps_after_stop"]
        speed = figures["last_speed_m_s"]
        at_rest = round(self._world.body.in_si("leg/beat") * AT_REST, 4)
        within = f"of the command; allowed: within {SPEED_ERROR:g} of it"
        ratios = [
            (abs(ratio - 1.0) <= SPEED_ERROR, name, ratio, SPEED_ERROR, f"the mean {words} was {ratio:.2f} {within}")
            for name, words in (("speed_ratio", "speed"), ("turn_ratio", "rate of turn"))
            if (ratio := figures[name]) is not None
        ]
        if steps is None:
            return unmet(*ratios)
        late = f"{steps} steps after the command to stop; allowed: {STEPS_TO_REST}"
        moves = f"the CoM moved at {speed:.3f} m/s in the end; allowed: less than {at_rest:g} m/s"
        return unmet(
            *ratios,
            (steps <= STEPS_TO_REST, "stop", steps, STEPS_TO_REST, late),
            (speed < at_rest, "rest", speed, at_rest, moves),
        )
