"""Faults of time, sensors and ticks, as functions of a reading and the time since the fault began."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from plantar.gait.command import Sensors
from plantar.sensing.reading import Reading

__all__ = ["FAULTS", "WALKED_THROUGH", "Fault"]

Fault = Callable[[Sensors, float], Sensors]


def _time(change: Callable[[float, float], float]) -> Callable[[], Fault]:
    return lambda: lambda s, t: s.changed(time=change(s.time, t))


def _soles(change: Callable[[Any], Any]) -> Callable[[], Fault]:
    return lambda: lambda s, t: s.changed(readings=change(s.readings))


def _body(**values: Any) -> Callable[[], Fault]:
    def fault(s: Sensors, t: float) -> Sensors:
        return s.changed(**{k: v(getattr(s, k)) if callable(v) else v for k, v in values.items()})

    return lambda: fault


def _frozen(*names: str, until: float = 99.0) -> Callable[[], Fault]:
    def made() -> Fault:
        kept: dict[str, Any] = {}

        def fault(s: Sensors, t: float) -> Sensors:
            if not kept:
                kept.update({name: getattr(s, name) for name in names})
            return s.changed(**{k: v.copy() for k, v in kept.items()}) if t < until else s

        return fault

    return made


def _jitter() -> Fault:
    rng = np.random.default_rng(3)
    return lambda s, t: s.changed(time=s.time + rng.uniform(-0.01, 0.01))


def _silent(reading: Reading, value: float) -> Reading:
    return Reading(reading.time, np.full(len(reading.force), value))


def _wild(joints: Any) -> Any:
    out = joints.copy()
    out[3] = 1e6
    return out


FAULTS: Mapping[str, Callable[[], Fault]] = {
    "time +5 s": _time(lambda a, t: a + 5.0),
    "time inf": _time(lambda a, t: np.inf),
    "time NaN": _time(lambda a, t: np.nan),
    "time -5 s": _time(lambda a, t: a - 5.0),
    "time back by 1 s for 0.5 s": _time(lambda a, t: a - 1.0 if t < 0.5 else a),
    "time jitter of 10 ms": _jitter,
    "time frozen": _time(lambda a, t: a - t),
    "IMU frozen": _frozen("gyro", "accelerometer"),
    "IMU frozen for 0.1 s": _frozen("gyro", "accelerometer", until=0.1),
    "IMU zeros": _body(gyro=np.zeros(3), accelerometer=np.zeros(3)),
    "IMU NaN": _body(gyro=np.full(3, np.nan)),
    "gyro at 35 rad/s": _body(gyro=np.array([35.0, 0.0, 0.0])),
    "encoders frozen": _frozen("joint_positions"),
    "encoders zeros": _body(joint_positions=lambda q: np.zeros(len(q))),
    "one encoder at 1e6 rad": _body(joint_positions=_wild),
    "one encoder too few": _body(joint_positions=lambda q: q[:-1]),
    "no encoders": _body(joint_positions=None),
    "soles frozen": _frozen("readings"),
    "soles swapped": _soles(lambda r: {"left": r["right"], "right": r["left"]}),
    "left sole missing": _soles(lambda r: {"right": r["right"]}),
    "left skin NaN": _soles(lambda r: {"left": _silent(r["left"], np.nan), "right": r["right"]}),
    "left skin zeros": _soles(lambda r: {"left": _silent(r["left"], 0.0), "right": r["right"]}),
    "both skins zeros": _soles(lambda r: {side: _silent(r[side], 0.0) for side in r}),
    "no soles": _soles(lambda r: None),
}
"""What makes each fault."""

WALKED_THROUGH = (
    *("time +5 s", "time -5 s", "time back by 1 s for 0.5 s", "time jitter of 10 ms", "time frozen"),
    *("IMU frozen for 0.1 s", "soles swapped", "left sole missing", "left skin NaN", "left skin zeros"),
)
"""Faults after which the robot walks on."""
