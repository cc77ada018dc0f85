"""Walk a robot by the messages of unitree_sdk2: LowState in, LowCmd out, 500 times a second.

    python examples/walk_unitree.py out/g1/robot.toml eth0        a robot made by `plantar robot MODEL`, its network

Then type velocities, forward and left in m/s, turn in rad/s, such as 0.2 0 0; an empty line stops. Motors 0 to 11 are
the legs', in the model's order; others are held. Hang the robot in a gantry at first, and read docs/safety.md.
"""

import sys

import numpy as np
from unitree_sdk2py.core.channel import ChannelFactoryInitialize, ChannelPublisher, ChannelSubscriber
from unitree_sdk2py.idl.default import unitree_hg_msg_dds__LowCmd_
from unitree_sdk2py.idl.unitree_hg.msg.dds_ import LowCmd_, LowState_
from unitree_sdk2py.utils.crc import CRC

import plantar
from plantar.gait.command import MotorCommand, Sensors

RISES = 3.0  # s from where the legs are to the stance
GAINS = {"hip": (100.0, 2.0), "knee": (150.0, 4.0), "ankle": (40.0, 2.0)}  # N m/rad, N m s/rad, as the maker has them
HELD = 40.0, 1.0  # of the other joints
control = {"control": {"period": 0.002, "drives": "torque"}}
joints = plantar.load_controller(sys.argv[1]).joints
gains = {name: pair for name in joints for part, pair in GAINS.items() if part in name}
walker = plantar.load_controller(sys.argv[1], control, commanded=True, gains=gains, soles="torques")
command, crc = unitree_hg_msg_dds__LowCmd_(), CRC()
first = []  # the first LowState's time in s, and angles


def answer(state):
    """One tick: answer a LowState by a LowCmd."""
    angles = np.array([motor.q for motor in state.motor_state])
    first.extend([] if first else [1e-3 * state.tick, angles])
    legs = slice(0, len(joints))
    time = 1e-3 * state.tick - first[0] - RISES
    if time < 0.0:
        q = walker.stance.angles + (first[1][legs] - walker.stance.angles) * -time / RISES
        motors = MotorCommand(q, 0.0 * q, *walker.gains, walker.stance.torques * (1.0 + time / RISES))
    else:
        torques = np.array([motor.tau_est for motor in state.motor_state[legs]])
        imu = np.array(state.imu_state.gyroscope, float), np.array(state.imu_state.accelerometer, float)
        motors = walker.motor_command(walker.step(Sensors(time, angles[legs], *imu, {}, torques=torques)))
    rest = [(q, 0.0, *HELD, 0.0) for q in first[1][len(joints) :]]
    for motor, values in zip(command.motor_cmd, [*zip(*motors, strict=True), *rest], strict=True):
        motor.mode = 1
        motor.q, motor.dq, motor.kp, motor.kd, motor.tau = map(float, values)
    command.mode_machine = state.mode_machine
    command.crc = crc.Crc(command)
    publisher.Write(command)


ChannelFactoryInitialize(0, *sys.argv[2:])
publisher, subscriber = ChannelPublisher("rt/lowcmd", LowCmd_), ChannelSubscriber("rt/lowstate", LowState_)
publisher.Init()
subscriber.Init(answer, 10)
for line in sys.stdin:
    (walker.set_velocity if line.strip() else walker.stop)(*map(float, line.split()))
