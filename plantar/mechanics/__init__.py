"""Rotations, wrenches, contacts, wrench cones, pendulum, ZMP and base state."""
