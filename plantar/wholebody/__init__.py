"""Whole-body skin tasks for any torque-, velocity- or position-controlled robot: a small companion of `plantar`.

It shares the taxel mathematics of `plantar.sensing.body_skin` and does not know about walking, nor of any simulator: a
model library supplies `RobotDynamics`, a skin supplies `SkinReading`, and what comes out are joint torques.
"""
