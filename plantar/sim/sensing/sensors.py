"""Encoders, IMU, ankles and soles, with their noise."""

from collections.abc import Callable, Collection, Mapping

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.gait.controller import Sensors
from plantar.kernels.sensors.noise_rows import SensedBody
from plantar.sensing.reading import Reading
from plantar.sim.model.contact_truth import ContactReader, FootContacts
from plantar.sim.model.world import World
from plantar.sim.plant.delay import Delay
from plantar.sim.plant.draw import TruePlant
from plantar.sim.plant.ground import GroundColours
from plantar.sim.plant.taxels import TaxelErrors
from plantar.sim.sensing.proximity import ProximitySensor, SoleProximity
from plantar.sim.sensing.settings import Sensing
from plantar.sim.sensing.skin import SkinSensor, SoleSkin
from plantar.sim.sensing.white_noise import white_noise

_RUBBER = 0.013  # of a sole's length that its rubber is thick: 3 mm for H1


class SensorSuite:
    """Reads all sensors of a world.

    `world`: the world; `sensing`: rates, noise and delay; `plant`: True differences; None for sensors as modelled.
    Attributes `body_skin`: upper body skin reader, or None.
    """

    def __init__(
        self,
        world: World,
        sensing: Sensing,
        seed: int,
        *,
        proximity: bool = False,
        force_torque: bool = False,
        plant: TruePlant | None = None,
    ) -> None:
        self._world = world
        self._sensing = sensing
        streams = np.random.SeedSequence([seed, 0x5E]).spawn(7)
        self._imu_to_base = imu_to(world, int(world.model.body_rootid[world.torso]))
        k = len(world.joint_qpos)
        noise = np.repeat([sensing.encoder_noise, sensing.gyro_noise, sensing.accelerometer_noise], [k, 3, 3])
        sensed = world.data.sensordata
        self._body = SensedBody(
            world.data.qpos,
            world.joint_qpos,
            sensed[world.gyro : world.gyro + 3],
            sensed[world.accelerometer : world.accelerometer + 3],
            white_noise(np.random.default_rng(streams[2]), 0.0, noise, k + 6),
            *((np.empty(0), np.empty(0)) if plant is None else (plant.encoder_offsets, plant.gyro_bias)),
        )
        self._ankle_noise = np.random.default_rng(streams[6]) if force_torque else None
        chance = np.random.default_rng(streams[5])
        dead = {side: _dead_taxels(len(world.robot.layouts[side]), sensing.dead_taxels, chance) for side in SIDES}
        self.proximity: dict[Side, ProximitySensor] = {}
        if proximity:
            colours = GroundColours(plant) if plant is not None and plant.reflectance else None
            self.proximity = {
                side: _proximity(world, sensing, side, dead[side], np.random.default_rng(stream), colours)
                for side, stream in zip(SIDES, streams[3:5], strict=True)
            }
        self.skins = {
            side: SkinSensor(
                _skin(world, sensing, side, 0.0 if plant is None else plant.rubber),
                sensing,
                np.random.default_rng(stream),
                self.proximity.get(side),
                None if plant is None else TaxelErrors(world.robot.layouts[side], plant, side),
                dead[side],
            )
            for side, stream in zip(SIDES, streams[:2], strict=True)
        }
        self._contacts = ContactReader(world.model, world.data, [self.skins[side].skin.geom_ids for side in SIDES])
        self._line: Delay[Sensors] | None = Delay(plant.sensor_delay) if plant and plant.sensor_delay else None
        self.skin_every = max(1, round(1.0 / (sensing.skin_rate * world.period)))
        self.readings: dict[Side, Reading] = {}
        self.body_skin: Callable[[], Reading] | None = None
        self.body_links: Callable[[], Mapping[str, tuple[NDArray[np.float64], NDArray[np.float64]]]] | None = None

    def read_skins(
        self,
        near: Collection[Side] = SIDES,
        everything: bool = False,
        contacts: tuple[FootContacts, ...] | None = None,
    ) -> tuple[FootContacts, ...]:
        """Read the soles, every `skin_every` physics steps.

        `everything`: measure all; same readings; `contacts` of the left and right sole after the last physics step,
        where they have been read already. Returns the contacts of both soles.
        """
        data = self._world.data
        feet = self._contacts.read() if contacts is None else contacts
        left, right = feet
        skins = self.skins
        self.readings = {
            "left": skins["left"].read(data, left, near="left" in near, everything=everything),
            "right": skins["right"].read(data, right, near="right" in near, everything=everything),
        }
        return feet

    def read_body(self) -> Sensors:
        """What has arrived of encoders, IMU and soles."""
        read = self._read_now()
        if self._line is None:
            return read
        arrived = self._line.passed(read.time, read)
        return arrived.changed(time=read.time, sampled=arrived.time)

    def _read_now(self) -> Sensors:
        joints, gyro, specific = self._body.read()
        if self._imu_to_base is not None:
            gyro = self._imu_to_base.dot(gyro)
            specific = self._imu_to_base.dot(specific)
        return Sensors(
            time=self._world.data.time,
            joint_positions=joints,
            gyro=gyro,
            accelerometer=specific,
            readings=self.readings,  # new ones with each sample
            ankles={} if self._ankle_noise is None else self._ankles(),
            skin=None if self.body_skin is None else self.body_skin(),
            links={} if self.body_links is None else self.body_links(),
        )

    def _ankles(self) -> dict[Side, NDArray[np.float64]]:
        """Wrench (6,) of each foot in the sensor's frame."""
        assert self._ankle_noise is not None
        s = self._sensing
        data = self._world.data.sensordata
        wrenches: dict[Side, NDArray[np.float64]] = {}
        scale = np.array([s.ankle_force_noise] * 3 + [s.ankle_torque_noise] * 3)
        noise = scale * self._ankle_noise.standard_normal((2, 6))
        for row, (side, (force, torque)) in zip(noise, self._world.ankle_wrench.items(), strict=True):
            # MuJoCo gives what the leg does to the foot.
            row[:3] -= data[force : force + 3]
            row[3:] -= data[torque : torque + 3]
            wrenches[side] = row
        return wrenches


def _dead_taxels(count: int, share: float, chance: np.random.Generator) -> list[int]:
    return chance.permutation(count)[: round(share * count)].tolist()  # type: ignore[no-any-return]


def _skin(world: World, sensing: Sensing, side: Side, foam: float) -> SoleSkin:
    geoms = [world.model.geom(g).name for g in world.sole_geoms[side]]
    site = world.robot.legs[side].sole_site
    rubber = _RUBBER * world.body.sole + foam
    layer = sensing.layer + foam if sensing.taxels == "elastic" else None
    return SoleSkin(
        world.model,
        world.robot.layouts[side],
        site,
        geoms,
        rubber=rubber,
        reach=world.reach,
        layer=layer,
        rim_stiffness=world.robot.rim_stiffness,
    )


def _proximity(
    world: World,
    sensing: Sensing,
    side: Side,
    dead: Collection[int],
    rng: np.random.Generator,
    colours: GroundColours | None,
) -> ProximitySensor:
    site = world.robot.legs[side].sole_site
    layout = world.robot.layouts[side]
    rays = SoleProximity(world.model, layout, site, sensing.proximity_range, world.ground_top, colours)
    return ProximitySensor(rays, sensing.proximity_noise, sensing.proximity_bias, rng, dead)


def imu_to(world: World, body: int) -> NDArray[np.float64] | None:
    """Returns the rotation (3, 3) from a `world`'s IMU to a `body`; None where equal."""
    data = mujoco.MjData(world.model)
    mujoco.mj_kinematics(world.model, data)
    rotation = data.xmat[body].reshape(3, 3).T @ data.site(world.robot.imu_site).xmat.reshape(3, 3)
    return None if np.allclose(rotation, np.eye(3), atol=1e-9) else rotation
