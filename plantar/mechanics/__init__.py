"""Mechanics below gait and whole-body tasks: rotations, wrenches, contacts, wrench cones, pendulum, ZMP, base state."""
