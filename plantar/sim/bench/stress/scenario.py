"""A stress run: scene, robot, settings, place and faulty sensors."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np

from plantar.gait.controller_tables import CONTROLLER_TABLES, controller_keys
from plantar.sim.bench.stress.faults import Faults
from plantar.sim.sensing.settings import Sensing

ROBOTS = ("h1", "hrp2kai")
"""Robots that are drawn from."""

_ALWAYS = ("balance", "estimator", "identification", "landing")
_SEES = (*_ALWAYS, "compliance", "touchdown", "ground_map")
_FINDS = (*_ALWAYS, "contact", "foothold")
_REACTS = (*_ALWAYS, "step_adjustment", "step_region")

SCENES: Mapping[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "flat": ((), _ALWAYS),
    "balance": (("push.count=0", "push.dv=0"), _ALWAYS),
    "turn": ((), _ALWAYS),
    "wander": ((), _ALWAYS),
    "stop": ((), _ALWAYS),
    "uneven": ((), _SEES),
    "obstacle": (("terrain.step=1",), _SEES),
    "tilt": (("terrain.step=1",), _SEES),
    "pebbles": ((), _SEES),
    "stones": ((), _FINDS),
    "beam": ((), _FINDS),
    "partial-front": (("terrain.step=1",), _FINDS),
    "partial-outer": (("terrain.step=1",), _FINDS),
    "partial-third": (("terrain.step=1",), _FINDS),
    "feasibility-1": (("terrain.step=1",), (*_SEES, "feasibility")),
    "push": (("push.step=1", "control.step_adjustment=true"), _REACTS),
}
"""Scenes that are drawn from, with what makes them short and the controller's tables that count in them: level ground,
edges, steps down to nothing, stones that tip a foot, and pushes."""

_ANYWHERE = ("flat", "push")  # Scenes on an endless plane: they may be put anywhere, under any heading

_SHORT = ("walk.start=0.4", "walk.end=0.3", "walk.settle=0.2")
_PLANT = {"mass_ratio": (0.5, 2.0), "stiffness_ratio": (0.3, 3.0), "friction_ratio": (0.1, 2.0), "softness": (0.0, 0.1)}
_READ = (
    "skin_rate",
    "force_noise",
    "delay_periods",
    "dead_taxels",
    "encoder_noise",
    "gyro_noise",
    "accelerometer_noise",
)
_RATES = ("sensing.skin_rate", (50.0, 125.0, 250.0, 1000.0)), ("control.period", (0.002, 0.005, 0.01, 0.02))


@dataclass(frozen=True)
class Scenario:
    """One stress run, determined by its values.

    `settings`: changes of scene, as `key=value`; `place`: start: x and y in m, heading in rad.
    """

    number: int
    scene: str
    robot: str
    settings: tuple[str, ...] = ()
    place: tuple[float, float, float] = (0.0, 0.0, 0.0)
    faults: Faults = field(default_factory=Faults)


def draw_scenario(number: int) -> Scenario:
    """The scenario of a number; a scene may refuse its settings together.

    Example:
        >>> draw_scenario(7) == draw_scenario(7), draw_scenario(7) == draw_scenario(8)
        (True, False)
    """
    rng = np.random.default_rng([number, 0x57])
    scene = str(rng.choice(list(SCENES)))
    robot = str(rng.choice(ROBOTS))
    own, tables = SCENES[scene]
    settings = [*own, *_SHORT]
    if scene not in ("balance", "stop", "turn", "wander"):  # those walk by velocities, or not at all
        settings.append(f"steps={rng.integers(2, 4)}")
    for name, (low, high) in _PLANT.items():
        if rng.random() < 0.3:
            settings.append(f"plant.{name}={rng.uniform(low, high):.6g}")
    for name, choices in _RATES:
        if rng.random() < 0.2:
            settings.append(f"{name}={rng.choice(choices)}")
    settings += [f"sensing.{name}={value}" for name, value in _drawn(Sensing, rng, 0.1).items() if name in _READ]
    for table in rng.choice(tables, 2, replace=False).tolist():
        drawn = _drawn(CONTROLLER_TABLES[table][0], rng, 0.15)
        keys = controller_keys(table)
        settings += [f"{table}.{name}={value}" for name, value in drawn.items() if name in keys]
    place = (0.0, 0.0, 0.0)
    if scene in _ANYWHERE and rng.random() < 0.7:
        distance = float(rng.choice([0.0, 10.0, 1000.0]))
        angle, yaw = rng.uniform(-math.pi, math.pi, 2).tolist()
        place = (distance * math.cos(angle), distance * math.sin(angle), yaw)
    return Scenario(number, scene, robot, tuple(settings), place, Faults.drawn(rng))


def _drawn(kind: type[Any], rng: np.random.Generator, chance: float) -> dict[str, str]:
    found: dict[str, str] = {}
    for setting in fields(kind):
        low, high = (float(setting.metadata.get(end, math.nan)) for end in ("low", "high"))
        if not (math.isfinite(low) and math.isfinite(high)) or rng.random() >= chance:
            continue
        at = rng.choice([0.0, 1.0, rng.random(), rng.random() ** 4])
        value = low + float(at) * (high - low)
        found[setting.name] = str(round(value)) if isinstance(setting.default, int) else f"{value:.6g}"
    return found
