"""Rotations, the pendulum between two points, and the program that shares a wrench between feet."""
