"""Faults of `safety_campaign.py`: those of a stress run, of single taxels, delays, loop and drives, and drawn pairs."""

from collections import deque
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.gait.command import Sensors
from plantar.mechanics.rotation import rotation_from_vector
from plantar.sensing.reading import Reading
from plantar.sim.bench.stress.faults import FAULTS, Fault

Forces = Callable[[NDArray[np.float64], float], NDArray[np.float64]]
"""What a sole reports of its forces (n,) in N, some time in s after the fault began."""


class CampaignFault(NamedTuple):
    """A fault.

    Attributes:
        group: What it is a fault of; two of a pair are of different groups.
        made: Makes what changes the readings.
        missing: Whether the loop misses the tick at a time in s after the begin.
        drives: Shares of stiffness and damping that drives keep, by joint; None for all joints.
        known: What a controller could do that knows it: "true" (undo it), "joints" or "taxels" (leave out what is
            in `places`), "sole" (leave out that of `places`), or "" (stop).
        places: Joints, or side with taxels of which it is a fault.
    """

    group: str
    made: Callable[[], Fault]
    missing: Callable[[float], bool] = lambda t: False
    drives: Mapping[int | None, float] = MappingProxyType({})
    known: str = ""
    places: tuple[Any, ...] = ()


def sound() -> Fault:
    return lambda s, t: s


def taxels(change: Forces, *sides: Side) -> Callable[[], Fault]:
    def fault(s: Sensors, t: float) -> Sensors:
        readings = dict(s.readings)
        for side in sides:
            r = readings[side]
            readings[side] = Reading(r.time, change(r.force.copy(), t), r.proximity)
        return s.changed(readings=readings)

    return lambda: fault


def places_of(force: NDArray[np.float64], places: tuple[float, ...]) -> NDArray[np.int64]:
    """Indices of taxels by their share of the way through a sole's list."""
    return (np.array(places) * (len(force) - 1)).round().astype(int)


def one(places: tuple[float, ...], change: Callable[[NDArray[np.float64], float], Any], *sides: Side) -> CampaignFault:
    """Fault of a few taxels, of a share `places` of the way through the sole's list."""

    def changed(force: NDArray[np.float64], t: float) -> NDArray[np.float64]:
        which = places_of(force, places)
        force[which] = change(force[which], t)
        return force

    return CampaignFault("soles", taxels(changed, *sides), known="taxels", places=(sides, places))


def late(seconds: float, *names: str, joints: tuple[int, ...] = ()) -> Callable[[], Fault]:
    """What arrives a time in s late; of the encoders, those of some joints alone."""

    def made() -> Fault:
        kept: deque[tuple[float, dict[str, Any]]] = deque()

        def fault(s: Sensors, t: float) -> Sensors:
            kept.append((t, {name: getattr(s, name) for name in names}))
            while len(kept) > 1 and kept[1][0] <= t - seconds + 1e-9:
                kept.popleft()
            old = dict(kept[0][1])
            if joints:
                angles = s.joint_positions.copy()
                angles[list(joints)] = old["joint_positions"][list(joints)]
                old["joint_positions"] = angles
            return s.changed(**old)

        return fault

    return made


def held(every: int, name: str) -> Callable[[], Fault]:
    """What arrives anew at each so manieth tick alone."""

    def made() -> Fault:
        kept: list[Any] = []
        ticks = [0]

        def fault(s: Sensors, t: float) -> Sensors:
            if ticks[0] % every == 0:
                kept[:] = [getattr(s, name)]
            ticks[0] += 1
            return s.changed(**{name: kept[0]})

        return fault

    return made


def joints(which: tuple[int, ...], change: Callable[[NDArray[np.float64], float], Any]) -> CampaignFault:
    def fault(s: Sensors, t: float) -> Sensors:
        angles = s.joint_positions.copy()
        angles[list(which)] = change(angles[list(which)], t)
        return s.changed(joint_positions=angles)

    return CampaignFault("encoders", lambda: fault, known="joints", places=which)


def stuck(joint: int) -> CampaignFault:
    def made() -> Fault:
        kept: list[float] = []

        def fault(s: Sensors, t: float) -> Sensors:
            kept.append(s.joint_positions[joint])
            angles = s.joint_positions.copy()
            angles[joint] = kept[0]
            return s.changed(joint_positions=angles)

        return fault

    return CampaignFault("encoders", made, known="joints", places=(joint,))


def imu(**changes: Callable[[NDArray[np.float64]], NDArray[np.float64]]) -> CampaignFault:
    def fault(s: Sensors, t: float) -> Sensors:
        changed = {name: np.ascontiguousarray(change(getattr(s, name))) for name, change in changes.items()}
        return s.changed(**changed)

    return CampaignFault("IMU", lambda: fault)


def noise(seed: int, size: float) -> Callable[[NDArray[np.float64], float], NDArray[np.float64]]:
    rng = np.random.default_rng(seed)
    return lambda values, t: values + rng.normal(0.0, size, len(values))


def stall(missing: Callable[[float], bool]) -> CampaignFault:
    return CampaignFault("loop", sound, missing)


def weak(drives: dict[int | None, float]) -> CampaignFault:
    return CampaignFault("drives", sound, drives=drives)


def _chance(seed: int, share: float) -> Callable[[float], bool]:
    rng = np.random.default_rng(seed)
    return lambda t: bool(rng.random() < share)


_TURN = rotation_from_vector(np.radians([0.0, 10.0, 0.0]))
_ALL = tuple(range(12))

NEW: dict[str, CampaignFault] = {
    # Single taxels
    "a left taxel reads 600 N": one((0.5,), lambda f, t: 600.0, "left"),
    "a right taxel reads 600 N": one((0.5,), lambda f, t: 600.0, "right"),
    "a left taxel reads 600 N at a corner": one((0.0,), lambda f, t: 600.0, "left"),
    "a right taxel reads 100 N": one((0.8,), lambda f, t: 100.0, "right"),
    "a left taxel reads 60 N": one((0.3,), lambda f, t: 60.0, "left"),
    "a left taxel drifts by 50 N/s": one((0.7,), lambda f, t: f + 50.0 * t, "left"),
    "a right taxel reads -200 N": one((0.4,), lambda f, t: -200.0, "right"),
    "a left taxel is silent": one((0.5,), lambda f, t: 0.0, "left"),
    "a right taxel reads NaN": one((0.0,), lambda f, t: np.nan, "right"),
    "a left taxel reads inf": one((0.6,), lambda f, t: np.inf, "left"),
    "a right taxel has noise of 50 N": one((0.5,), noise(7, 50.0), "right"),
    "a left taxel reads 600 N at times": one((0.5,), lambda f, t: 600.0 if t % 0.05 < 0.005 else f, "left"),
    "a right taxel reads five times its load": one((0.5,), lambda f, t: 5.0 * f, "right"),
    "two right taxels read 400 N": one((0.45, 0.5), lambda f, t: 400.0, "right"),
    "a taxel of each sole reads 400 N": one((0.2,), lambda f, t: 400.0, *SIDES),
    "a third of the left taxels is silent": one(tuple(np.linspace(0.0, 0.33, 40)), lambda f, t: 0.0, "left"),
    "a third of the right taxels reads NaN": one(tuple(np.linspace(0.6, 0.93, 40)), lambda f, t: np.nan, "right"),
    # Soles
    "taxel order of the left sole reversed": CampaignFault(
        "soles", taxels(lambda f, t: f[::-1].copy(), "left"), known="true"
    ),
    "left skin frozen": CampaignFault(
        "soles",
        lambda: (
            lambda kept: (
                lambda s, t: s.changed(
                    readings={"left": kept.setdefault("left", s.readings["left"]), "right": s.readings["right"]}
                )
            )
        )({}),
        known="sole",
        places=("left",),
    ),
    "soles 50 ms late": CampaignFault("soles", late(0.05, "readings")),
    "soles 100 ms late": CampaignFault("soles", late(0.1, "readings")),
    "soles report at 20 Hz": CampaignFault("soles", held(10, "readings")),
    "soles with noise of 3 N": CampaignFault("soles", taxels(noise(11, 3.0), *SIDES)),
    "soles report half": CampaignFault("soles", taxels(lambda f, t: 0.5 * f, *SIDES), known="true"),
    "left skin reports three times": CampaignFault("soles", taxels(lambda f, t: 3.0 * f, "left"), known="true"),
    # Encoders
    "encoders 20 ms late": CampaignFault("encoders", late(0.02, "joint_positions"), known="joints", places=_ALL),
    "encoders 50 ms late": CampaignFault("encoders", late(0.05, "joint_positions"), known="joints", places=_ALL),
    "encoders 100 ms late": CampaignFault("encoders", late(0.1, "joint_positions"), known="joints", places=_ALL),
    "a knee's encoder 50 ms late": CampaignFault(
        "encoders", late(0.05, "joint_positions", joints=(3,)), known="joints", places=(3,)
    ),
    "encoders in steps of 5 mrad": joints(_ALL, lambda q, t: 5e-3 * np.round(q / 5e-3)),
    "an encoder reads NaN at every other tick": joints((3,), lambda q, t: np.nan if round(t / 0.005) % 2 else q),
    "two encoders off by 0.1 rad": joints((3, 8), lambda q, t: q + 0.1),
    "an ankle's roll encoder stuck": stuck(5),
    "a knee's encoder stuck": stuck(9),
    "sign of a knee's encoder turned": joints((9,), lambda q, t: -q),
    "an encoder jumps by 0.2 rad at times": joints((8,), lambda q, t: q + 0.2 * (round(t / 0.005) % 20 == 0)),
    # IMU
    "gyro off by 0.1 rad/s": imu(gyro=lambda w: w + np.array([0.0, 0.1, 0.0])),
    "gyro in degrees": imu(gyro=np.degrees)._replace(known="true"),
    "gyro's axes exchanged": imu(gyro=lambda w: w[[1, 0, 2]])._replace(known="true"),
    "gyro zero": imu(gyro=np.zeros_like),
    "accelerometer in g": imu(accelerometer=lambda a: a / 9.81)._replace(known="true"),
    "accelerometer off by 1 m/s^2": imu(accelerometer=lambda a: a + np.array([1.0, 0.0, 0.0])),
    "IMU turned by 10 degrees": imu(gyro=lambda w: _TURN @ w, accelerometer=lambda a: _TURN @ a),
    "IMU 50 ms late": CampaignFault("IMU", late(0.05, "gyro", "accelerometer")),
    # Loop
    "loop stalls for 0.1 s": stall(lambda t: t < 0.1),
    "loop stalls for 0.2 s": stall(lambda t: t < 0.2),
    "every other tick is missing": stall(lambda t: round(t / 0.005) % 2 == 1),
    # Drives
    "a knee's drive at half its stiffness": weak({3: 0.5}),
    "battery sags: drives at 0.7 of their stiffness": weak({None: 0.7}),
}
"""The faults that stress runs do not have."""


def _group(name: str) -> str:
    if name.startswith("time"):
        return "time"
    if any(word in name for word in ("IMU", "gyro", "accelerometer")):
        return "IMU"
    if any(word in name for word in ("sole", "skin")):
        return "soles"
    return "all" if "sensors" in name else "encoders"


_KNOWN: dict[str, tuple[str, tuple[Any, ...]]] = {
    "one encoder at 1e6 rad": ("joints", (3,)),
    "one encoder NaN": ("joints", (2,)),
    "one encoder inf": ("joints", (9,)),
    "one encoder off by 0.3 rad": ("joints", (8,)),
    "one encoder off by 0.24 rad": ("joints", (3,)),
    "one encoder off by 0.1 rad": ("joints", (3,)),
    "one encoder off by -0.1 rad": ("joints", (2,)),
    "one encoder off by 0.05 rad": ("joints", (1,)),
    "an ankle's encoder off by 0.15 rad": ("joints", (4,)),
    "an ankle's encoder off by -0.15 rad": ("joints", (10,)),
    "a hip's encoder off by 0.1 rad": ("joints", (7,)),
    "one encoder off by 0.1 rad for 0.3 s": ("joints", (3,)),
    "one encoder stuck for 0.05 s": ("joints", (3,)),
    "a hip's encoder stuck": ("joints", (2,)),
    "a knee's encoder drifts by 0.2 rad/s": ("joints", (3,)),
    "an ankle's encoder drifts by -0.2 rad/s": ("joints", (4,)),
    "encoders in degrees": ("true", ()),
    "encoders mirrored": ("true", ()),
    "encoders of the legs exchanged": ("true", ()),
    "soles swapped": ("true", ()),
    "left skin reports 80 %": ("true", ()),
    "right skin reports 120 %": ("true", ()),
    **{f"{side} {what}": ("sole", (side,)) for side in SIDES for what in ("sole missing", "skin NaN", "skin zeros")},
    "left skin of another size": ("sole", ("left",)),
}
"""Of the faults of stress runs, what leaves more than to stop to a controller that knows them."""


def _old(name: str) -> CampaignFault:
    group = _group(name)
    known, places = _KNOWN.get(name, ("joints", _ALL) if group == "encoders" else ("", ()))
    return CampaignFault(group, FAULTS[name], known="true" if group == "time" else known, places=places)


SINGLE: dict[str, CampaignFault] = {**{name: _old(name) for name in FAULTS}, **NEW}
"""All faults that come alone."""


def drawn_pairs(count: int, seed: int) -> list[tuple[str, str]]:
    """Pairs of faults of different groups, drawn once."""
    names = [name for name in SINGLE if SINGLE[name].group != "all"]
    rng = np.random.default_rng(seed)
    found: list[tuple[str, str]] = []
    while len(found) < count:
        a, b = (names[i] for i in rng.integers(len(names), size=2))
        if SINGLE[a].group != SINGLE[b].group and (a, b) not in found and (b, a) not in found:
            found.append((a, b))
    return found


PAIRS: dict[str, tuple[str, str]] = {f"{a} + {b}": (a, b) for a, b in drawn_pairs(60, 69)}
"""Names of two faults that begin at the same time."""


def parts_of(name: str) -> list[CampaignFault]:
    """The faults of a name: one, or a pair's two."""
    return [SINGLE[part] for part in PAIRS.get(name, (name,))]


_LEARNED = "learned as usual where it begins before the first single support has ended"
_AIR = "a sole in the air has nothing to be compared with until it lands"
_STONE = "a stone under one taxel reads as much, until the next swing"
_REPEATS = "its bits show beside loaded taxels that change, or it shows in mid-swing"
_STILL = "joints hardly move while the robot stands"
_DRIVES = "the expected torque is fed forward: joints miss by less than 0.03 rad"

WHY_LATE: Mapping[str, str] = MappingProxyType(
    {
        "IMU turned by 10 degrees": "a mean over 0.3 s; pushes reach a third of it",
        "accelerometer off by 1 m/s^2": "as much as the limit, twice what a push reaches",
        "IMU 50 ms late": "the trunk turns by less than 0.02 rad in that time",
        "gyro off by 0.1 rad/s": "turns by 0.03 rad in 0.3 s, as sound soles do",
        "gyro's axes exchanged": "shows by the turn of the standing sole, of 0.07 rad",
        "gyro zero": "shows by the turn of the standing sole, of 0.07 rad",
        "left skin reports 80 %": "drawn plants that hands lead differ by 13 %; " + _AIR,
        "right skin reports 120 %": "drawn plants that hands lead differ by 13 %; " + _AIR,
        "left skin reports three times": _AIR,
        "left skin NaN": _AIR,
        "left skin zeros": _AIR,
        "right skin zeros": _AIR,
        "a third of the left taxels is silent": _AIR,
        "a third of the right taxels reads NaN": _AIR,
        "taxel order of the left sole reversed": "a flat sole's load is the same; shows as the body falls",
        "soles swapped": "both carry the same while the robot stands",
        "soles report half": "until the first single support has ended half is allowed",
        "soles with noise of 3 N": "twice the noise of a sound sole",
        "a left taxel is silent": "so is one over a gap of the ground",
        "a left taxel reads 60 N": _REPEATS,
        "a right taxel reads 100 N": _REPEATS,
        "a left taxel drifts by 50 N/s": _STONE,
        "a right taxel has noise of 50 N": "shows where it pulls for 0.04 s in all",
        "a right taxel reads five times its load": _STONE,
        "a left taxel reads 600 N at times": "5 ms in 50; an impact reads so",
        "a left taxel reads 600 N": "1.7 weights are left to landings",
        "a right taxel reads 600 N": "1.7 weights are left to landings",
        "a left taxel reads 600 N at a corner": "1.7 weights are left to landings",
        "one encoder stuck for 0.05 s": "its joint moves by less than 0.015 rad meanwhile",
        "a hip's encoder stuck": _STILL,
        "a knee's encoder stuck": _STILL,
        "an ankle's roll encoder stuck": _STILL,
        "a knee's encoder 50 ms late": _STILL + "; " + _LEARNED,
        "encoders 20 ms late": _STILL + "; " + _LEARNED,
        "encoders 50 ms late": _STILL + "; " + _LEARNED,
        "encoders 100 ms late": _STILL + "; " + _LEARNED,
        "encoders in steps of 5 mrad": _STILL,
        "encoders frozen": _STILL,
        "encoders frozen for 0.1 s": _STILL,
        "encoders of the legs exchanged": _STILL + ", and both legs' have about the same angles",
        "a knee's encoder drifts by 0.2 rad/s": "0.06 rad in 0.3 s; " + _LEARNED,
        "an ankle's encoder drifts by -0.2 rad/s": "0.06 rad in 0.3 s; " + _LEARNED,
        "a knee's drive at half its stiffness": _DRIVES,
        "battery sags: drives at 0.7 of their stiffness": _DRIVES,
    }
)
"""Why a fault that comes alone may stay without a name for 0.3 s."""
