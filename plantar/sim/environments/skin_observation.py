"""Adds plantar skin to observations of any MuJoCo Gymnasium environment."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.arguments import instance
from plantar.errors import InputError
from plantar.mujoco.bound_skin import BoundSkin, SkinReading
from plantar.mujoco.skin import Skin
from plantar.sensing.taxel_faults import TaxelFaults, WornFaults
from plantar.sim.environments.gymnasium_base import ObservationWrapper, spaces


class SkinObservation(ObservationWrapper[Any, Any, Any]):
    """Adds the forces on skins to the observation, which becomes a Dict.

    Others keep their keys, or "observation" if not a Dict; each skin's name has the force (n,) in N.

    Args:
        env: Its `unwrapped` has `model` and `data`.
        skins: By name.
        faults: Of taxels, drawn at each reset, or None.

    Attributes:
        readings: Latest, without faults (`plantar.mujoco.SkinReading`).

    Raises:
        InputError: If model or name is invalid.
        RobotError: If a skin misses its body.
    """

    def __init__(self, env: Any, skins: Mapping[str, Skin], faults: TaxelFaults | None = None) -> None:
        super().__init__(env)
        model = getattr(env.unwrapped, "model", None)
        if model is None or getattr(env.unwrapped, "data", None) is None:
            raise InputError("skin needs an environment with MuJoCo's model and data: env.unwrapped.model and .data")
        if not isinstance(skins, Mapping) or not all(isinstance(skin, Skin) for skin in skins.values()):
            raise InputError(f"skins are {skins!r:.60}; allowed: names and Skin objects, {{'left': Skin(body='foot')}}")
        own = env.observation_space
        boxes = dict(own.spaces) if isinstance(own, spaces.Dict) else {"observation": own}
        taken = sorted(boxes.keys() & skins.keys())
        if taken:
            raise InputError(f"observation already has {', '.join(taken)}; allowed: other names for the skins")
        self._is_dict = isinstance(own, spaces.Dict)
        self._skins: dict[str, BoundSkin] = {name: skin.bind(model) for name, skin in skins.items()}
        self._faults = None if faults is None else instance(faults, TaxelFaults, "faults")
        self._worn: dict[str, WornFaults] = {}
        self.readings: dict[str, SkinReading] = {}
        for name, skin in self._skins.items():
            low = 0.0 if faults is None and skin.layout.is_flat else -np.inf  # shear pulls at inclined cells
            boxes[name] = spaces.Box(low, np.inf, (len(skin),), np.float32)
        self.observation_space = spaces.Dict(boxes)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Reset with `seed`, also of faults, and `options`; returns observation and info."""
        observation, info = self.env.reset(seed=seed, options=options)
        if self._faults is not None:
            rng = self.env.unwrapped.np_random
            self._worn = {
                name: self._faults.worn(skin.layout, int(rng.integers(2**63))) for name, skin in self._skins.items()
            }
        return self.observation(observation), info

    def observation(self, observation: Any) -> dict[str, Any]:
        """The environment's `observation` with forces (n,) of each skin, 0 for dead taxels."""
        data = self.env.unwrapped.data
        self.readings = {name: skin(data) for name, skin in self._skins.items()}
        seen = dict(observation) if self._is_dict else {"observation": observation}
        for name, reading in self.readings.items():
            force: NDArray[np.float64] = reading.force
            if name in self._worn:
                force = np.nan_to_num(self._worn[name].read(reading.time, force, reading.vectors))
            seen[name] = force.astype(np.float32)
        return seen
