"""Faults of the sensors in a stress run."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.gait.command import Sensors
from plantar.sensing.reading import Reading

Fault: TypeAlias = Callable[[Sensors, float], Sensors]
"""What arrives of a reading, some time in s after the fault began."""


def _time(change: Callable[[float, float], float]) -> Callable[[], Fault]:
    return lambda: lambda s, t: s.changed(time=change(s.time, t))


def _soles(change: Callable[[Any], Any]) -> Callable[[], Fault]:
    return lambda: lambda s, t: s.changed(readings=change(s.readings))


def _body(**values: Any) -> Callable[[], Fault]:
    def fault(s: Sensors, t: float) -> Sensors:
        return s.changed(**{k: v(getattr(s, k)) if callable(v) else v for k, v in values.items()})

    return lambda: fault


def _frozen(*names: str) -> Callable[[], Fault]:
    def made() -> Fault:
        kept: dict[str, Any] = {}

        def fault(s: Sensors, t: float) -> Sensors:
            if not kept:
                kept.update({name: getattr(s, name) for name in names})
            return s.changed(**{k: v.copy() for k, v in kept.items()})

        return fault

    return made


def _jitter() -> Fault:
    rng = np.random.default_rng(3)
    return lambda s, t: s.changed(time=s.time + rng.uniform(-0.01, 0.01))


def _silent(reading: Reading, value: float) -> Reading:
    return Reading(reading.time, np.full(len(reading.force), value))


def _encoder(joint: int, change: Callable[[float, float], float]) -> Callable[[], Fault]:
    def fault(s: Sensors, t: float) -> Sensors:
        joints = s.joint_positions.copy()
        joints[joint] = change(joints[joint], t)
        return s.changed(joint_positions=joints)

    return lambda: fault


def _stuck(joint: int) -> Callable[[], Fault]:
    def made() -> Fault:
        kept: list[float] = []

        def fault(s: Sensors, t: float) -> Sensors:
            kept.append(s.joint_positions[joint])
            return _encoder(joint, lambda *_: kept[0])()(s, t)

        return fault

    return made


def _share(side: str, share: float) -> Callable[[Any], Any]:
    return lambda r: {s: Reading(r[s].time, r[s].force * (share if s == side else 1.0)) for s in r}


def _for(seconds: float, made: Callable[[], Fault]) -> Callable[[], Fault]:
    def limited() -> Fault:
        fault = made()
        return lambda s, t: fault(s, t) if t < seconds else s

    return limited


def _noise(name: str, size: float) -> Callable[[], Fault]:
    def made() -> Fault:
        rng = np.random.default_rng(5)
        return lambda s, t: s.changed(**{name: getattr(s, name) + rng.normal(0.0, size, len(getattr(s, name)))})

    return made


def _raised(s: Sensors, t: float) -> Sensors:
    return None  # type: ignore[return-value]


FAULTS: Mapping[str, Callable[[], Fault]] = {
    "time +5 s": _time(lambda a, t: a + 5.0),
    "time inf": _time(lambda a, t: np.inf),
    "time NaN": _time(lambda a, t: np.nan),
    "time -5 s": _time(lambda a, t: a - 5.0),
    "time back by 1 s for 0.5 s": _time(lambda a, t: a - 1.0 if t < 0.5 else a),
    "time jitter of 10 ms": _jitter,
    "time frozen": _time(lambda a, t: a - t),
    "time frozen for 0.1 s": _for(0.1, _time(lambda a, t: a - t)),
    "time NaN for 0.1 s": _for(0.1, _time(lambda a, t: np.nan)),
    "time of 1e18 s": _time(lambda a, t: 1e18),
    "time no number": _time(lambda a, t: "now"),  # type: ignore[arg-type, return-value]
    "time twice as fast": _time(lambda a, t: a + t),
    "no sensors": lambda: _raised,
    "no sensors for 0.03 s": _for(0.03, lambda: _raised),
    "IMU frozen": _frozen("gyro", "accelerometer"),
    "IMU frozen for 0.1 s": _for(0.1, _frozen("gyro", "accelerometer")),
    "IMU zeros": _body(gyro=np.zeros(3), accelerometer=np.zeros(3)),
    "IMU NaN": _body(gyro=np.full(3, np.nan)),
    "IMU NaN for 0.03 s": _for(0.03, _body(gyro=np.full(3, np.nan))),
    "accelerometer NaN": _body(accelerometer=np.full(3, np.nan)),
    "accelerometer at 1e4 m/s^2": _body(accelerometer=np.array([0.0, 0.0, 1e4])),
    "accelerometer too short": _body(accelerometer=np.zeros(2)),
    "gyro inf": _body(gyro=np.array([0.0, np.inf, 0.0])),
    "gyro with noise of 0.05 rad/s": _noise("gyro", 0.05),
    "no IMU": _body(gyro=None, accelerometer=None),
    "gyro at 35 rad/s for a tick": _for(0.004, _body(gyro=np.array([35.0, 0.0, 0.0]))),
    "gyro at 35 rad/s": _body(gyro=np.array([35.0, 0.0, 0.0])),
    "encoders frozen": _frozen("joint_positions"),
    "encoders zeros": _body(joint_positions=lambda q: np.zeros(len(q))),
    "one encoder at 1e6 rad": _encoder(3, lambda q, t: 1e6),
    "one encoder NaN": _encoder(2, lambda q, t: np.nan),
    "one encoder inf": _encoder(9, lambda q, t: np.inf),
    "one encoder off by 0.24 rad": _encoder(3, lambda q, t: q + 0.24),
    "one encoder off by 0.1 rad": _encoder(3, lambda q, t: q + 0.1),
    "one encoder off by -0.1 rad": _encoder(2, lambda q, t: q - 0.1),
    "one encoder off by 0.05 rad": _encoder(1, lambda q, t: q + 0.05),
    "one encoder off by 0.3 rad": _encoder(8, lambda q, t: q + 0.3),
    "an ankle's encoder off by 0.15 rad": _encoder(4, lambda q, t: q + 0.15),
    "an ankle's encoder off by -0.15 rad": _encoder(10, lambda q, t: q - 0.15),
    "a hip's encoder off by 0.1 rad": _encoder(7, lambda q, t: q + 0.1),
    "one encoder off by 0.1 rad for 0.3 s": _for(0.3, _encoder(3, lambda q, t: q + 0.1)),
    "one encoder off by 0.1 rad for a tick": _for(0.004, _encoder(3, lambda q, t: q + 0.1)),
    "one encoder stuck for 0.05 s": _for(0.05, _stuck(3)),
    "a hip's encoder stuck": _stuck(2),
    "a knee's encoder drifts by 0.2 rad/s": _encoder(3, lambda q, t: q + 0.2 * t),
    "an ankle's encoder drifts by -0.2 rad/s": _encoder(4, lambda q, t: q - 0.2 * t),
    "encoders NaN for 0.03 s": _for(0.03, _body(joint_positions=lambda q: q * np.nan)),
    "encoders NaN": _body(joint_positions=lambda q: q * np.nan),
    "encoders in degrees": _body(joint_positions=np.degrees),
    "encoders mirrored": _body(joint_positions=lambda q: -q),
    "encoders of the legs exchanged": _body(joint_positions=lambda q: np.roll(q, len(q) // 2)),
    "encoders frozen for 0.1 s": _for(0.1, _frozen("joint_positions")),
    "encoders with noise of 1 mrad": _noise("joint_positions", 1e-3),
    "one encoder too few": _body(joint_positions=lambda q: q[:-1]),
    "no encoders": _body(joint_positions=None),
    "soles frozen": _frozen("readings"),
    "soles swapped": _soles(lambda r: {"left": r["right"], "right": r["left"]}),
    "left sole missing": _soles(lambda r: {"right": r["right"]}),
    "left skin NaN": _soles(lambda r: {"left": _silent(r["left"], np.nan), "right": r["right"]}),
    "left skin zeros": _soles(lambda r: {"left": _silent(r["left"], 0.0), "right": r["right"]}),
    "right sole missing": _soles(lambda r: {"left": r["left"]}),
    "right skin NaN": _soles(lambda r: {"left": r["left"], "right": _silent(r["right"], np.nan)}),
    "right skin zeros": _soles(lambda r: {"left": r["left"], "right": _silent(r["right"], 0.0)}),
    "left skin of another size": _soles(lambda r: {"left": Reading(0.0, np.zeros(3)), "right": r["right"]}),
    "left skin reports 80 %": _soles(_share("left", 0.8)),
    "right skin reports 120 %": _soles(_share("right", 1.2)),
    "soles NaN": _soles(lambda r: {side: _silent(r[side], np.nan) for side in r}),
    "soles NaN for 0.03 s": _for(0.03, _soles(lambda r: {side: _silent(r[side], np.nan) for side in r})),
    "no soles for 0.03 s": _for(0.03, _soles(lambda r: None)),
    "both skins zeros": _soles(lambda r: {side: _silent(r[side], 0.0) for side in r}),
    "no soles": _soles(lambda r: None),
}
"""What makes each fault."""


@dataclass(frozen=True)
class Faults:
    """Sensor faults, by default none; never of encoders and IMU at the first tick.

    Attributes:
        dropped: Share of ticks at which a sole's packet is lost, and the last stays.
        jitter: Standard deviation in s of a reading's time.
        stuck: Share of taxels that hold their first value.
        silent: Share of ticks at which a sole's taxels read NaN.
        missing: Share of ticks at which encoders and IMU read NaN.
        lost_after: Time in s from which on they read NaN for good; negative for never.
        saturated: Share of ticks at which loaded taxels read their limit.
        single: Whether numbers arrive as float32.
        named: Name of one of `FAULTS`, or empty.
        begins: Time in s at which that begins.
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
    def drawn(cls, rng: np.random.Generator) -> "Faults":
        """Draw faults: each in one of five runs."""
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
    """Applies faults; `limit` in N saturates a taxel, `seed` draws."""

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
        f = self.faults
        rng = self._rng
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
        f = self.faults
        rng = self._rng
        if side in self._last and f.dropped and rng.random() < f.dropped:
            return self._last[side]
        force = reading.force
        near = reading.proximity
        time = reading.time
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
