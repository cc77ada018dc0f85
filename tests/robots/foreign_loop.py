"""A control loop of a caller's own, without Plantar's simulator: MuJoCo is the robot and takes low-level commands."""

from collections.abc import Sequence

import mujoco
import numpy as np

from plantar.gait.command import MotorCommand, Sensors
from plantar.gait.propose.velocity_command import STOP
from plantar.mujoco import Skin
from plantar.robots.controller import RobotController
from plantar.robots.kinematics.robot_model import robot_spec

MOVES = (
    (0.2, 0.0, 0.0),
    (0.0, 0.0, 0.3),
    STOP,
    (0.0, 0.06, 0.0),
    (-0.1, 0.0, 0.0),
    (0.0, -0.06, 0.0),
    (0.15, 0.0, -0.2),
    (0.0, 0.0, -0.3),
    (0.1, 0.04, 0.1),
    STOP,
)
"""Forward, turning, stopping, sideways, back and mixed: m/s, m/s, rad/s."""


class ForeignLoop:
    """A robot on a floor.

    `walker`: its controller; `soles`: what measures their loads, as in `load_controller`.
    """

    def __init__(self, walker: RobotController, soles: str = "taxels") -> None:
        self.walker = walker
        self._soles = soles
        spec = robot_spec(walker.robot)
        spec.option.timestep = 0.001
        spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
        spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1], friction=[0.8, 0.005, 0.0001])
        self.model = spec.compile()
        self.data = mujoco.MjData(self.model)
        joints = [self.model.joint(name) for name in walker.joints]
        self._qpos = [joint.qposadr[0] for joint in joints]
        self._motors = [list(self.model.actuator_trnid[:, 0]).index(joint.id) for joint in joints]
        self._skins = {
            side: Skin(walker.robot.layouts[side], leg.foot_body, site=leg.sole_site).bind(self.model)
            for side, leg in walker.robot.legs.items()
        }
        self.data.qpos[:3] = walker.base_position
        self.data.qpos[self._qpos] = walker.stance.angles
        self._servos(walker, 500)  # the soles settle on the floor
        self._began = float(self.data.time)

    def walk(self, commands: Sequence[tuple[float, tuple[float, ...] | None]], until: float) -> float:
        """Walk by `commands`, each with its time in s; returns its end in s, `until` unless it fell or gave up."""
        walker = self.walker
        left = list(commands)
        ticks = round(until / walker.period)
        for tick in range(ticks):
            now = tick * walker.period
            while left and left[0][0] <= now:
                velocity = left.pop(0)[1]
                if velocity is STOP:
                    walker.stop()
                else:
                    walker.set_velocity(*velocity)
            self._exert(walker.motor_command(walker.step(self.sense())))
            if walker.state is not None or self.data.body(walker.robot.torso_body).xmat[8] < 0.7:
                return now
        return until

    def sense(self) -> Sensors:
        """What the robot's computer reads."""
        data = self.data
        readings = {side: skin(data) for side, skin in self._skins.items()} if self._soles == "taxels" else {}
        return Sensors(
            data.time - self._began,
            data.qpos[self._qpos],
            data.sensor("imu_gyro").data.copy(),
            data.sensor("imu_accelerometer").data.copy(),
            readings,
            {side: self._ankle(side) for side in ("left", "right")} if self._soles == "force_torque" else {},
            torques=data.actuator_force[self._motors] if self._soles == "torques" else None,
        )

    def _ankle(self, side: str) -> np.ndarray:
        """Wrench (6,) of a foot on its leg: MuJoCo's sensors report that of the leg on the foot."""
        return -np.concatenate([self.data.sensor(f"{side}_ankle_{what}").data for what in ("force", "torque")])

    def _servos(self, walker: RobotController, steps: int) -> None:
        """Hold the stance by the model's own servos for physics steps."""
        stiffness = self.model.actuator_gainprm[self._motors, 0]
        self.data.ctrl[self._motors] = walker.stance.angles + walker.stance.torques / stiffness
        mujoco.mj_step(self.model, self.data, steps)

    def _exert(self, motors: MotorCommand) -> None:
        """kp (q - angle) + kd (dq - rate) + torque in each joint, until the next tick."""
        model = self.model
        model.actuator_gainprm[self._motors, 0] = 1.0
        model.actuator_biasprm[self._motors, 1:3] = -np.column_stack([motors.kp, motors.kd])
        self.data.ctrl[self._motors] = motors.kp * motors.q + motors.kd * motors.dq + motors.torque
        mujoco.mj_step(model, self.data, round(self.walker.period / model.opt.timestep))


def drawn_commands(seed: int, until: float) -> list[tuple[float, tuple[float, ...] | None]]:
    """All of `MOVES` in a drawn order, each for 1 to 8 s, over and over, and a stop 5 s before the end."""
    rng = np.random.default_rng(seed)
    found: list[tuple[float, tuple[float, ...] | None]] = []
    time = 1.0
    while time < until - 5.0:
        for k in rng.permutation(len(MOVES)):
            if time < until - 5.0:
                found.append((time, MOVES[k]))
            time += float(rng.uniform(1.0, 8.0))
    return [*found, (until - 5.0, STOP)]
