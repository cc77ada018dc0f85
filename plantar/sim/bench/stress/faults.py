"""Faults of the sensors in a stress run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.gait.command import Sensors
from plantar.sensing.reading import Reading
from plantar.sides import SIDES, Side
from plantar.sim.bench.stress.named_faults import FAULTS, Fault

__all__ = ["Faults", "FaultySensors"]


@dataclass(frozen=True)
class Faults:
    """Faults of a run's sensors; by default none. At the first tick encoders and IMU are there.

    Attributes:
        dropped: Share of the ticks at which a sole's packet is lost, and the one before stays.
        jitter: Standard deviation in s of a reading's time.
        stuck: Share of each sole's taxels that hold their first value.
        silent: Share of the ticks at which all taxels of a sole read NaN.
        missing: Share of the ticks at which encoders and IMU read NaN.
        lost_after: Time in s from which on encoders and IMU read NaN for good; negative for never.
        saturated: Share of the ticks at which a sole's loaded taxels read their limit.
        single: Whether all numbers arrive as float32.
        named: Name of one of `named_faults.FAULTS`, or empty.
        begins: Time in s at which that one begins.
    """

    dropped: float = 0.0
    jitter: float = 0.0
    stuck: float = 0.0
    silent: float = 0.0
    missing: float = 0.0
    lost_after: float = -1.0
    saturated: float = 0.0
    single: bool = False
    named: str = ""
    begins: float = 0.0

    @classmethod
    def drawn(cls, rng: np.random.Generator) -> Faults:
        """Draw faults: each is there in one of five runs."""
        shares = {name: (float(rng.random() ** 2) if rng.random() < 0.2 else 0.0) for name in _SHARES}
        return cls(
            **shares,
            jitter=float(rng.uniform(0.0, 2e-3)) if rng.random() < 0.2 else 0.0,
            lost_after=float(rng.uniform(0.0, 3.0)) if rng.random() < 0.05 else -1.0,
            single=bool(rng.random() < 0.2),
            named=str(rng.choice(list(FAULTS))) if rng.random() < 0.3 else "",
            begins=float(rng.uniform(0.5, 3.5)),
        )


_SHARES = ("dropped", "stuck", "silent", "missing", "saturated")


class FaultySensors:
    """Applies faults to sensors; `limit` in N saturates a taxel, `seed` draws the rest."""

    def __init__(self, faults: Faults, limit: Mapping[Side, float], seed: int) -> None:
        self.faults = faults
        self._limit = limit
        self._rng = np.random.default_rng([seed, 0xFA])
        self._last: dict[Side, Reading] = {}
        self._last_time: float | None = None
        self._stuck: dict[Side, tuple[NDArray[np.bool_], NDArray[np.float64]]] = {}
        self._named: Fault | None = FAULTS[faults.named]() if faults.named else None

    def passed(self, sensors: Sensors) -> Sensors:
        """The readings of one tick with their faults."""
        f, rng = self.faults, self._rng
        readings = {side: self._sole(side, sensors.readings[side]) for side in SIDES}
        changed: dict[str, Any] = {"readings": readings}
        lost = 0.0 <= f.lost_after <= sensors.time
        if self._last_time is not None and (lost or (f.missing and rng.random() < f.missing)):
            changed |= {
                name: np.full_like(getattr(sensors, name), np.nan)
                for name in ("joint_positions", "gyro", "accelerometer")
            }
        self._last_time = sensors.time
        if f.single:
            for name in ("joint_positions", "gyro", "accelerometer"):
                changed[name] = changed.get(name, getattr(sensors, name)).astype(np.float32).astype(np.float64)
        passed = sensors.changed(**changed)
        since = sensors.time - f.begins
        return passed if self._named is None or since < 0.0 else self._named(passed, since)

    def _sole(self, side: Side, reading: Reading) -> Reading:
        f, rng = self.faults, self._rng
        if side in self._last and f.dropped and rng.random() < f.dropped:
            return self._last[side]
        force, near, time = reading.force, reading.proximity, reading.time
        if f.stuck:
            if side not in self._stuck:
                self._stuck[side] = (rng.random(len(force)) < f.stuck, force)
            force = np.where(self._stuck[side][0], self._stuck[side][1], force)
        if f.saturated and rng.random() < f.saturated:
            force = np.where(force > 0.0, self._limit[side], force)
        if f.silent and rng.random() < f.silent:
            force = np.full_like(force, np.nan)
            near = None if near is None else np.full_like(near, np.nan)
        if f.jitter:
            time += f.jitter * float(rng.standard_normal())
        if f.single:
            force = force.astype(np.float32).astype(np.float64)
            near = None if near is None else near.astype(np.float32).astype(np.float64)
        self._last[side] = replace(reading, time=time, force=force, proximity=near)
        return self._last[side]
