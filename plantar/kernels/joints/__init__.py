"""Inverse kinematics, whole-body torque, static loads, and set-points of servos."""
