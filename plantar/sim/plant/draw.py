"""The true plant of a run: stated and drawn values."""

import math
import zlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.body_scale import BodyScale
from plantar.common.sides import SIDES, Side
from plantar.layouts.layout import SoleLayout
from plantar.sim.plant.settings import RANDOM, STATED, Plant

_LEVEL = 2.0  # at which `RANGES` hold

_GAIN_MOST = 0.9  # either way of a taxel's gain of 1: a taxel that reads nothing is dead, which is another fault


def _either_way(chance: np.random.Generator, limit: float) -> float:
    return 1.0 + limit * float(chance.uniform(-1.0, 1.0))


def _each_axis(chance: np.random.Generator, limit: float) -> NDArray[np.float64]:
    return limit * chance.uniform(-1.0, 1.0, 3)


def _in_ball(chance: np.random.Generator, limit: float) -> NDArray[np.float64]:
    way = chance.standard_normal(3)
    return np.asarray(limit * math.cbrt(chance.uniform()) / np.linalg.norm(way) * way)


def _less_than_one(chance: np.random.Generator, limit: float) -> float:
    return 1.0 - limit * float(chance.uniform())


def _up_to(chance: np.random.Generator, limit: float) -> float:
    return limit * float(chance.uniform())


def _whole(chance: np.random.Generator, limit: float) -> float:
    """The limit or more: a spread, or an item hardest at its limit."""
    return limit


class Range(NamedTuple):
    """Range that an item is drawn from.

    `limit`: largest difference at level 2; proportional at others; `unit` of the limit; body units grow with the robot.
    """

    limit: float
    unit: str
    draw: Callable[[np.random.Generator, float], Any]


RANGES: Mapping[str, Range] = {
    "gyro_bias": Range(0.005, "rad/s", _each_axis),
    "com_offset": Range(1 / 30, "leg", _in_ball),  # 2 cm on h1, any way
    "mass_ratio": Range(0.1, "1", _either_way),
    "encoder_offset": Range(0.3, "deg", _whole),
    "stiffness_ratio": Range(0.5, "1", _less_than_one),
    "friction_ratio": Range(0.6, "1", _less_than_one),
    "softness": Range(0.03, "s", _up_to),
    "taxel_gain": Range(0.15, "1", _whole),
    "crosstalk": Range(0.1, "1", _whole),
    "sensor_delay": Range(0.01, "s", _whole),
    "actuation_delay": Range(0.01, "s", _whole),
    "joint_friction": Range(0.005, "weight leg", _up_to),  # 2.5 N m on h1, 1.8 % of its knee's limit
    "backlash": Range(0.1, "deg", _up_to),
    "torque_ripple": Range(0.05, "1", _whole),
    "hysteresis": Range(0.1, "1", _whole),
    "taxel_drift": Range(0.002, "weight", _whole),  # 1.7 N on h1, as much as a taxel's noise
    "dropout": Range(0.02, "1", _whole),
    "rubber": Range(0.03, "sole", _up_to),  # 7 mm on h1
    "patchiness": Range(0.5, "1", _whole),
    "reflectance": Range(0.3, "1", _whole),
}
"""What each item is drawn from. What can be bought or met (IMU, encoders, electronics, ground) has limits in SI, for
every robot the same; a length of the robot has one that grows with it."""


@dataclass(frozen=True)
class TruePlant:
    """A run's differences in SI (`Plant`), of joints (k,), each sole's taxels (n,), or axes (3,).

    Attributes:
        gyro_bias: (3,) in rad/s, in the IMU's frame.
        com_offset: (3,) in m, in the torso's frame.
        load_place: (3,) in m from the torso's CoM, in its frame.
        encoder_offsets: (k,) in rad.
        softness: Time constant in s.
        taxel_gains: (n,) of each sole.
        sensor_delay: In s.
        actuation_delay: In s.
        joint_friction: In N m.
        backlash: In rad.
        taxel_drifts: Final drift (n,) in N.
        rubber: Thickness in m.
        seed: Of ground pieces and random events.
    """

    gyro_bias: NDArray[np.float64]
    com_offset: NDArray[np.float64]
    mass_ratio: float
    encoder_offsets: NDArray[np.float64]
    stiffness_ratio: float
    friction_ratio: float
    softness: float
    taxel_gains: Mapping[Side, NDArray[np.float64]]
    crosstalk: float
    sensor_delay: float
    actuation_delay: float
    joint_friction: float
    backlash: float
    torque_ripple: float
    hysteresis: float
    taxel_drifts: Mapping[Side, NDArray[np.float64]]
    dropout: float
    rubber: float
    patchiness: float
    reflectance: float
    joint_damping: float
    corner_speed: float
    load: float
    load_place: NDArray[np.float64]
    seed: int

    def summary(self) -> dict[str, Any]:
        """The differences that are not nominal."""
        gains, drifts = (
            np.concatenate([of_soles[side] for side in SIDES]) for of_soles in (self.taxel_gains, self.taxel_drifts)
        )
        stated: dict[str, tuple[Any, float]] = {  # each with its nominal value
            "gyro_bias_rad_s": (self.gyro_bias, 0.0),
            "com_offset_m": (self.com_offset, 0.0),
            "mass_ratio": (self.mass_ratio, 1.0),
            "encoder_offsets_deg": (np.degrees(self.encoder_offsets), 0.0),
            "stiffness_ratio": (self.stiffness_ratio, 1.0),
            "friction_ratio": (self.friction_ratio, 1.0),
            "softness_s": (self.softness, 0.0),
            "taxel_gain_spread": (gains.std(), 0.0),
            "crosstalk": (self.crosstalk, 0.0),
            "sensor_delay_s": (self.sensor_delay, 0.0),
            "actuation_delay_s": (self.actuation_delay, 0.0),
            "joint_friction_Nm": (self.joint_friction, 0.0),
            "backlash_deg": (math.degrees(self.backlash), 0.0),
            "torque_ripple": (self.torque_ripple, 0.0),
            "hysteresis": (self.hysteresis, 0.0),
            "taxel_drift_spread_N": (drifts.std(), 0.0),
            "dropout": (self.dropout, 0.0),
            "rubber_m": (self.rubber, 0.0),
            "patchiness": (self.patchiness, 0.0),
            "reflectance": (self.reflectance, 0.0),
            "joint_damping_Nms": (self.joint_damping, 0.0),
            "corner_speed": (self.corner_speed, 1.0),
            "load": (self.load, 0.0),
        }
        return {
            name: np.round(value, 6).tolist()
            for name, (value, nominal) in stated.items()
            if np.any(np.asarray(value) != nominal)
        }


def drawn_plant(
    plant: Plant, seed: int, body: BodyScale, joints: int, layouts: Mapping[Side, SoleLayout]
) -> TruePlant | None:
    """Returns the true plant of a run, None where nominal.

    Each item has its own random stream and scales with the level. Drawn by the scene's settings `plant` and the `seed`
    of the rest for the robot's size `body`, its leg `joints` and soles' `layouts`.
    """
    plant = plant.for_body(body)
    values = {name: _value(plant, name, seed) for name in (*plant.items(), *STATED)}
    values["backlash"] = math.radians(values["backlash"])
    most = math.radians(values.pop("encoder_offset"))
    spread = values.pop("taxel_gain")
    gains, drifts = (_of_each_taxel(stream(seed, name), layouts) for name in ("gains", "drifts"))
    drift = values.pop("taxel_drift")
    found = TruePlant(
        encoder_offsets=most * stream(seed, "zeros").uniform(-1.0, 1.0, joints),
        taxel_gains={side: 1.0 + np.clip(spread * row, -_GAIN_MOST, _GAIN_MOST) for side, row in gains.items()},
        taxel_drifts={side: drift * row for side, row in drifts.items()},
        seed=seed,
        **values,
    )
    return found if found.summary() else None


def _value(plant: Plant, name: str, seed: int) -> Any:
    stated = getattr(plant, name)
    if stated != RANDOM:
        return np.array(plant.vector(name)) if isinstance(stated, tuple) else stated
    limit, unit, draw = RANGES[name]
    in_si = 1.0 if unit == "deg" else plant.body.in_si(unit)
    return draw(stream(seed, name), plant.level / _LEVEL * limit * in_si)


def _of_each_taxel(chance: np.random.Generator, layouts: Mapping[Side, SoleLayout]) -> dict[Side, NDArray[np.float64]]:
    """Standard normal numbers (n,) for each sole."""
    return {side: chance.standard_normal(len(layouts[side])) for side in SIDES}


def stream(seed: int, name: str) -> np.random.Generator:
    """Returns the random generator of item `name` of a run with `seed`."""
    return np.random.default_rng([seed, 0x91, zlib.crc32(name.encode())])
