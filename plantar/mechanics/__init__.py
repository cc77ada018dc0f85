"""Rotations, wrenches, contacts, cones, pendulum, ZMP, base state."""
