"""A stub of unitree_sdk2py: its modules by name, with MuJoCo's h1 behind `rt/lowstate` and `rt/lowcmd`.

Messages hold the fields of unitree_hg's LowState_ and LowCmd_ with their types, so that what a bridge reads and writes
can be checked: a float that is an array, or a motor that does not exist, fails as in the SDK.
"""

import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from types import ModuleType, SimpleNamespace
from typing import Any

import mujoco
import numpy as np

from plantar.robots.kinematics.robot_model import robot_spec
from plantar.robots.robot_file import load_robot

MOTORS = 35  # of a unitree_hg message; a robot has fewer


@dataclass
class MotorCmd:
    """unitree_hg::msg::dds_::MotorCmd_."""

    mode: int = 0
    q: float = 0.0
    dq: float = 0.0
    tau: float = 0.0
    kp: float = 0.0
    kd: float = 0.0
    reserve: int = 0

    def __setattr__(self, name: str, value: Any) -> None:
        wanted = int if name in ("mode", "reserve") else float
        if type(value) is not wanted or name not in type(self).__dataclass_fields__:
            raise TypeError(f"MotorCmd_.{name} takes no {type(value).__name__}")
        super().__setattr__(name, value)


@dataclass
class LowCmd:
    """unitree_hg::msg::dds_::LowCmd_."""

    mode_pr: int = 0
    mode_machine: int = 0
    motor_cmd: list[MotorCmd] = field(default_factory=lambda: [MotorCmd() for _ in range(MOTORS)])
    reserve: list[int] = field(default_factory=lambda: [0] * 4)
    crc: int = 0


class StubRobot:
    """h1 in MuJoCo, which reports LowStates and takes LowCmds at 500 Hz.

    `until`: time in s at which it ends; it hangs in a gantry, its soles on the floor, for the first `hangs` s.
    Attributes `heights`: of the base in m, a tick each; `ended`: once it has.
    """

    def __init__(self, until: float, hangs: float = 3.0) -> None:
        robot = load_robot("h1")
        spec = robot_spec(robot)
        spec.option.timestep = 0.001
        spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
        spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1], friction=[0.8, 0.005, 0.0001])
        self.model = spec.compile()
        self.data = mujoco.MjData(self.model)
        joints = [self.model.joint(name) for side in ("left", "right") for name in robot.legs[side].joints]
        self._qpos = [joint.qposadr[0] for joint in joints]
        self._motors = [list(self.model.actuator_trnid[:, 0]).index(joint.id) for joint in joints]
        self._until = until
        self._hangs = hangs
        self._moved = threading.Condition()
        self._command: LowCmd | None = None
        self.heights: list[float] = []
        self.ended = False

    def stand(self, position: Any, angles: Any) -> None:
        """Put it where it stands."""
        self.data.qpos[:3] = position
        self.data.qpos[self._qpos] = angles
        mujoco.mj_forward(self.model, self.data)

    def take(self, command: LowCmd) -> None:
        """What `rt/lowcmd` publishes."""
        assert command.crc == 1
        self._command = command

    def run(self, answer: Callable[[Any], None]) -> None:
        """Report until the end."""
        try:
            while self.data.time < self._until:
                answer(self._state())
                assert self._command is not None
                self._exert(self._command.motor_cmd)
                self.heights.append(float(self.data.qpos[2]))
                with self._moved:
                    self._moved.notify_all()
        finally:  # a bridge that raises must not leave the other thread waiting
            with self._moved:
                self.ended = True
                self._moved.notify_all()

    def wait(self, time: float) -> None:
        """Wait, in another thread, for a time in s of the robot's, or its end."""
        with self._moved:
            self._moved.wait_for(lambda: self.ended or self.data.time >= time)

    def _exert(self, commands: list[MotorCmd]) -> None:
        model = self.model
        for motor, c in zip(self._motors, commands, strict=False):
            assert c.mode == 1
            model.actuator_gainprm[motor, 0] = 1.0
            model.actuator_biasprm[motor, 1:3] = -c.kp, -c.kd
            self.data.ctrl[motor] = c.kp * c.q + c.kd * c.dq + c.tau
        place = self.data.qpos[:7].copy()
        mujoco.mj_step(model, self.data, 2)
        if self.data.time < self._hangs:
            self.data.qpos[:7] = place
            self.data.qvel[:6] = 0.0

    def _state(self) -> SimpleNamespace:
        data = self.data
        motors = [SimpleNamespace(mode=1, q=0.0, dq=0.0, ddq=0.0, tau_est=0.0) for _ in range(MOTORS)]
        for motor, at, own in zip(motors, self._qpos, self._motors, strict=False):
            motor.q = float(data.qpos[at])
            motor.tau_est = float(data.actuator_force[own])
        hangs = data.time < self._hangs  # upright, at rest
        imu = SimpleNamespace(
            quaternion=data.qpos[3:7].tolist(),
            gyroscope=[0.0] * 3 if hangs else data.sensor("imu_gyro").data.tolist(),
            accelerometer=[0.0, 0.0, 9.81] if hangs else data.sensor("imu_accelerometer").data.tolist(),
        )
        return SimpleNamespace(
            mode_machine=5, tick=round(1000.0 * data.time) + 123_456, imu_state=imu, motor_state=motors
        )


def typed(robot: StubRobot, lines: dict[float, str]) -> Iterator[str]:
    """Lines that are typed at times in s of the robot's, until its end."""
    for time, line in lines.items():
        robot.wait(time)
        yield f"{line}\n"
    robot.wait(np.inf)


def stub_modules(robot: StubRobot) -> dict[str, ModuleType]:
    """The SDK's modules by name, for `sys.modules`."""

    class Publisher:
        def __init__(self, topic: str, kind: type) -> None:
            assert (topic, kind) == ("rt/lowcmd", LowCmd)

        def Init(self) -> None:
            self.Write = robot.take

    class Subscriber:
        def __init__(self, topic: str, kind: type) -> None:
            assert (topic, kind.__name__) == ("rt/lowstate", "SimpleNamespace")

        def Init(self, handler: Callable[[Any], None], depth: int) -> None:
            threading.Thread(target=robot.run, args=(handler,), daemon=True).start()

    contents: dict[str, dict[str, Any]] = {
        "core.channel": {
            "ChannelFactoryInitialize": lambda domain, network=None: None,
            "ChannelPublisher": Publisher,
            "ChannelSubscriber": Subscriber,
        },
        "idl.default": {"unitree_hg_msg_dds__LowCmd_": LowCmd},
        "idl.unitree_hg.msg.dds_": {"LowCmd_": LowCmd, "LowState_": SimpleNamespace},
        "utils.crc": {"CRC": lambda: SimpleNamespace(Crc=lambda command: 1)},
    }
    modules: dict[str, ModuleType] = {}
    for name, content in contents.items():
        parts = ["unitree_sdk2py", *name.split(".")]
        for depth in range(len(parts)):
            modules.setdefault(".".join(parts[: depth + 1]), ModuleType(".".join(parts[: depth + 1])))
        vars(modules[".".join(parts)]).update(content)
    return modules
