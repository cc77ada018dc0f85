"""Whole-body skin tasks for any torque-, velocity- or position-controlled robot: a small companion of `plantar`.

Independent of walking and of any simulator: a model library supplies `RobotDynamics`, a skin supplies `SkinReading`,
and the result is joint torques.
"""
