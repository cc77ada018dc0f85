"""Skin in the world, partners that press on it, and their physics step."""

from collections.abc import Sequence
from functools import partial
from typing import Any, Protocol

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.body_scale import REFERENCE_BODY, BodyScale
from plantar.mujoco.foam_skins import FoamSkins
from plantar.sensing.link_skin import BodySkin
from plantar.sensing.reading import Reading
from plantar.sim.body_skin.electronics import SkinElectronics, SkinSensing
from plantar.sim.model.world import World

_SLIP = (
    0.12  # leg/beat: 0.3 m/s for H1. Slower, the friction of 1 kN would turn a hand of 1.7 kg round in a physics step
)


class Partner(Protocol):
    """A moving body that touches the robot."""

    def add_to(self, spec: Any) -> None:
        """Add it to a world."""

    def bind(self, world: World) -> tuple[int, ...]:
        """Find it in the compiled world; returns the geom ids that skin measures."""

    def place(self, world: World) -> None:
        """Put it at its start in a `world` where the robot stands."""

    def near(self, time: float) -> bool:
        """Whether the skin may measure it at a time in s."""
        return True

    def drive(self, world: World, skin: FoamSkins) -> None:
        """Set its forces in the `world` for a physics step, after `skin`."""


def skin_material(body: BodyScale) -> SkinSensing:
    """Skin for a robot's size: the companion's on H1, scaled.

    Stiffness scales with weight / leg^3, damping with weight beat / leg^3, half force with weight, half distance with
    leg. Friction's slip speed is higher, for partners with mass.
    """
    weight, leg, beat = (getattr(body, name) / getattr(REFERENCE_BODY, name) for name in ("weight", "leg", "beat"))
    given = SkinSensing()
    return SkinSensing(
        stiffness=given.stiffness * weight / leg**3,
        damping=given.damping * weight * beat / leg**3,
        slip_speed=_SLIP * body.leg / body.beat,
        half_force=given.half_force * weight,
        half_distance=given.half_distance * leg,
    )


class Touch:
    """Upper body skin in a `world`, and partners that press on it."""

    def __init__(self, world: World, skin: BodySkin, partners: Sequence[Partner], seed: int) -> None:
        self._world = world
        self.partners = tuple(partners)
        geoms = [geom for partner in self.partners for geom in partner.bind(world)]
        material = skin_material(world.body)
        self.sensor = FoamSkins(world.model, skin, geoms, material.foam)
        self._electronics = SkinElectronics(skin, material, seed)
        self._near = True

    def place(self) -> None:
        """Put the partners at their start, once the robot stands."""
        for partner in self.partners:
            partner.place(self._world)
        mujoco.mj_forward(self._world.model, self._world.data)
        self.sensor.press(self._world.data)

    def read(self) -> Reading:
        """Read the skin."""
        data = self._world.data
        return self._electronics.read(float(data.time), partial(self.sensor.whole, data))

    @property
    def force(self) -> NDArray[np.float64]:
        """True force (3,) on the robot in N, world frame, last step."""
        return np.asarray(self.sensor.wrenches[:, :3].sum(axis=0))

    @property
    def wrench(self) -> NDArray[np.float64]:
        """True wrench (6,) on the robot about the world's origin in N and N m, last step."""
        found = self.sensor.wrenches.sum(axis=0)
        for link, wrench in zip(self.sensor.body_skin.links, self.sensor.wrenches, strict=True):
            if wrench.any():
                found[3:] += np.cross(self._world.data.body(link).xpos, wrench[:3])
        return np.asarray(found)

    def step(self) -> None:
        """One physics step with skin forces and partners."""
        world = self._world
        mujoco.mj_step1(world.model, world.data)
        near = any(partner.near(float(world.data.time)) for partner in self.partners)
        if near or self._near:
            self.sensor.press(world.data)
        self._near = near
        for partner in self.partners:
            partner.drive(world, self.sensor)
        mujoco.mj_step2(world.model, world.data)
