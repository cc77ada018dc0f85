"""Whole-body skin tasks for torque-, velocity- or position-controlled robots: a companion of `plantar`.

Independent of walking and simulators: a model gives `RobotDynamics`, a skin a `Reading`; the result is joint torques.
"""
