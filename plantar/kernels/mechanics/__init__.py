"""Rotations, pendulum, and the program that shares a wrench."""
