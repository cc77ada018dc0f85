"""What a kind of ground has to keep."""

import json
import math
from collections.abc import Mapping

import mujoco
import numpy as np

from plantar.common.sides import SIDES
from plantar.errors import PlantarError
from plantar.gait.plan.footsteps import Footstep, straight_plan
from plantar.sim.terrain import Footprint, Ground, PlannedFeet, Terrain

_SEEDS = 5
_HALF = (0.12, 0.07)  # m: half of a sole


def check_terrain(terrain: Terrain) -> list[str]:
    """What a kind of ground lacks, a sentence each; empty if nothing.

    Args:
        terrain: An instance of its class, with its settings.

    Returns:
        The sentences.
    """
    lacks: list[str] = []
    for count in (0, 1, 8):
        feet = _planned(count)
        for seed in range(_SEEDS):
            where = f"of a walk of {count} steps, seed {seed}: "
            try:
                ground = terrain.ground(feet, np.random.default_rng(seed))
            except PlantarError:  # a walk that it is not for
                continue
            again = terrain.ground(feet, np.random.default_rng(seed))
            if not isinstance(ground, Ground):
                return [f"{where}ground() returns a {type(ground).__name__}; expected a Ground"]
            if _text(ground) != _text(again):
                lacks.append(f"{where}two grounds of one seed differ: draw from the given generator alone")
            lacks += [f"{where}{text}" for text in _lacks_of(ground)]
    return list(dict.fromkeys(lacks))


def _lacks_of(ground: Ground) -> list[str]:
    try:
        json.dumps(dict(ground.facts), allow_nan=False)
    except (TypeError, ValueError) as error:
        return [f"facts are no plain numbers, which a summary holds ({error})"]
    for i, solid in enumerate(ground.solids):
        numbers = [*solid.size, *np.ravel(solid.position), *np.ravel(solid.rotation)]
        if not all(map(math.isfinite, numbers)):
            return [f"solid {i} holds a number that is not finite"]
        if not np.allclose(np.asarray(solid.rotation) @ np.asarray(solid.rotation).T, np.eye(3), atol=1e-9):
            return [f"the rotation of solid {i} is none"]
    spec = mujoco.MjSpec()
    spec.add_material(name="ground")
    try:
        ground.add_to(spec)
        spec.compile()
    except (ValueError, KeyError) as error:
        return [f"MuJoCo cannot simulate it: {' '.join(str(error).split())}"]
    return []


def _text(ground: Ground) -> str:
    solids = [(s.shape, s.size, np.ravel(s.position).tolist(), np.ravel(s.rotation).tolist()) for s in ground.solids]
    return repr((solids, ground.floor, ground.friction, dict(ground.facts)))


def _planned(count: int) -> PlannedFeet:
    standing, steps = straight_plan(count)
    placed: Mapping[str, Footprint] = {side: _print(standing[side]) for side in SIDES}
    times = [(1.0 + 1.2 * i, 1.9 + 1.2 * i) for i in range(count)]
    return PlannedFeet(placed, tuple(_print(s, *t) for s, t in zip(steps, times, strict=True)))  # type: ignore[arg-type]


def _print(step: Footstep, lift_off: float = -math.inf, touchdown: float = -math.inf) -> Footprint:
    place = np.array([step.x, step.y])
    return Footprint(step.side, place, step.yaw, _HALF, place, lift_off, touchdown, step.z)
