"""Encoders and drives of a machine's joints: motors or servos."""

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.sim.companion.dynamics import MujocoDynamics
from plantar.sim.companion.experiment import CompanionControl, World
from plantar.sim.companion.machine import ServoTable
from plantar.wholebody.torque_resolver import SetPoint, TorqueResolver


class Encoders:
    """Measures positions and velocities with white noise, of a floating base too; its orientation is the IMU's."""

    def __init__(self, world: World, settings: CompanionControl, seed: int) -> None:
        self._world = world
        self._settings = settings
        self._floats = world.machine.base.kind == "floating"
        self._rng = np.random.default_rng([seed, 0xEC])

    def read(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Positions (nq,) and velocities (nv,), in the machine's model order."""
        world = self._world
        s = self._settings
        qpos = world.data.qpos[world.positions]
        qvel = world.data.qvel[world.speeds]
        moved = self._rng.normal(0.0, s.encoder_noise, len(qvel))
        qvel = qvel + self._rng.normal(0.0, s.velocity_noise, len(qvel))
        if not self._floats:
            return qpos + moved, qvel
        qvel[3:6] += self._rng.normal(0.0, s.gyro_noise, 3)
        qpos[:3] += moved[:3]
        qpos[7:] += moved[6:]
        turned = qpos[3:7].copy()
        mujoco.mju_quatIntegrate(turned, self._rng.normal(0.0, s.attitude_noise, 3), 1.0)
        qpos[3:7] = turned
        return qpos, qvel


_FASTEST = 1e3  # rad/s or m/s of a joint without a speed limit


class Drives:
    """Drives of kind and stiffness `servo`, commanded each `period` in s."""

    def __init__(self, world: World, servo: ServoTable, period: float) -> None:
        machine = world.machine
        self._world = world
        self._servo = servo
        self._period = period
        self._efforts = machine.efforts
        limits = np.where(np.isfinite(machine.velocities), machine.velocities, _FASTEST)
        self._gain = servo.velocity_gain * np.where(np.isfinite(self._efforts), self._efforts, 0.0) / limits
        self._resolver = None if servo.kind == "torque" else TorqueResolver(limits)
        self._torque = np.zeros(len(limits))
        self._bias = np.zeros(len(limits))
        self._goal: SetPoint | None = None
        if self._resolver is not None:
            self._hold_speeds_implicitly()

    def _hold_speeds_implicitly(self) -> None:
        # Apply servo damping implicitly: explicit, it shakes a light wrist.
        model = self._world.model
        motors = self._world.motors
        model.opt.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
        model.actuator_biastype[motors] = mujoco.mjtBias.mjBIAS_AFFINE
        model.actuator_biasprm[motors, 2] = -self._gain
        model.actuator_ctrllimited[motors] = False
        model.actuator_forcelimited[motors] = True
        model.actuator_forcerange[motors] = np.column_stack([-self._efforts, self._efforts])

    def command(self, robot: MujocoDynamics, torque: NDArray[np.float64]) -> None:
        """Take the `torque` (k,) in N m or N, bias included, for the measured `robot`."""
        if self._resolver is None:
            self._torque = torque
        else:
            self._goal = self._resolver.step(robot, torque, self._period)
            self._bias = robot.bias[robot.joints]

    def drive(self) -> None:
        """Set motor torques for a physics step; servos use true motion."""
        world = self._world
        if self._goal is not None:
            wanted = self._goal.velocity
            if self._servo.kind == "position":
                measured = world.data.qpos[world.positions[-len(wanted) :]]
                wanted = wanted + self._servo.position_gain * (self._goal.position - measured)
            world.data.ctrl[world.motors] = self._bias + self._gain * wanted
        else:
            world.data.ctrl[world.motors] = np.clip(self._torque, -self._efforts, self._efforts)
