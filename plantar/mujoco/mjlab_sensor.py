"""Plantar skin as a sensor of mjlab (`pip install mjlab`)."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import mujoco

from plantar.layouts.layout import SoleLayout
from plantar.mujoco.bound_skin import BoundSkin
from plantar.mujoco.skin import Skin
from plantar.mujoco.warp_skin import WarpSkin

try:
    import torch
    import warp as wp
    from mjlab.sensor import Sensor, SensorCfg

    _Sensor: Any = Sensor[torch.Tensor]
except ImportError as problem:
    _PROBLEM = str(problem)

    class _Missing:
        def __new__(cls, *_: object, **__: object) -> _Missing:
            raise ImportError(f"{_PROBLEM}; a skin sensor needs mjlab: pip install mjlab")

    _Sensor = _Missing
    SensorCfg = _Missing


@dataclass
class SkinSensorCfg(SensorCfg):
    """A skin on a body of an entity.

    Attributes:
        name: Of sensor.
        entity: Name of entity in scene, for example "robot".
        body: Name of body in it, for example "left_ankle_roll_link".
        layout: Layout, or path of its file; None fits hexagons to the body.
        options: Further arguments of `Skin`; names as in the scene.
        contacts: Most contacts of sole in one world.
    """

    entity: str
    body: str
    layout: SoleLayout | str | os.PathLike[str] | None = None
    options: Mapping[str, Any] = field(default_factory=dict)
    contacts: int = 32

    def build(self) -> SkinSensor:
        """The sensor."""
        return SkinSensor(self)


class SkinSensor(_Sensor):
    """Reads a skin in all B worlds of an mjlab scene.

    `data` is the force (B, N, 3) on each taxel in N, sole frame, float32.

    `skin` in the scene's model, after `initialize`.
    """

    skin: BoundSkin

    def __init__(self, cfg: SkinSensorCfg) -> None:
        super().__init__()
        self.cfg = cfg
        self._skin = Skin(cfg.layout, f"{cfg.entity}/{cfg.body}", **cfg.options)

    def edit_spec(self, scene_spec: mujoco.MjSpec, entities: dict[str, Any]) -> None:
        """Add a sole frame to `scene_spec` of `entities`; RobotError as `Skin.edit`."""
        self._skin.edit(scene_spec)

    def initialize(self, mj_model: mujoco.MjModel, model: Any, data: Any, device: str) -> None:
        """Bind to `mj_model`, and Warp's `model` and `data` on a `device`; RobotError as `Skin.bind`."""
        self.skin = self._skin.bind(mj_model)
        self._worlds = getattr(data, "struct", data)
        self._torch_device = torch.device(device)
        self._device = wp.device_from_torch(self._torch_device)
        self._force: torch.Tensor | None = None
        self._time = 0.0
        cone = bool(getattr(model, "struct", model).opt.cone)
        with wp.ScopedDevice(self._device):
            self._many = WarpSkin(self.skin, self._worlds.nworld, self.cfg.contacts, elliptic=cone)

    @property
    def force(self) -> torch.Tensor:
        """Force (B, N) along each taxel's axis in N; with `faults`, what the taxels read, NaN if dead."""
        _ = self.data  # of this step
        if self._force is None:
            self._time = max(self._time, float(self._worlds.time.numpy().max()))  # worlds begin again one by one
            self._force = torch.as_tensor(self._many.force(self._time)).float().to(self._torch_device)
        return self._force.clone()

    @property
    def wrench(self) -> torch.Tensor:
        """Wrench (B, 6) of the contacts about sole origin in N and N m."""
        return self._read(self._many.wrench).float()

    @property
    def carried(self) -> torch.Tensor:
        """Whether (B,) the taxels have the whole wrench."""
        return self._read(self._many.carried).bool()

    def _compute_data(self) -> torch.Tensor:
        self._force = None
        with wp.ScopedDevice(self._device):
            self._many.read(self._worlds)
            if not self._device.is_cpu:  # PyTorch has its own stream
                wp.synchronize_stream(self._device)
        return torch.as_tensor(wp.to_torch(self._many.vectors)).float()

    def _read(self, values: Any) -> torch.Tensor:
        _ = self.data  # of this step
        return torch.as_tensor(wp.to_torch(values)).clone()
