"""Robots as data: built-in ones, others from TOML files."""

from plantar.robots.robot import FootShape, LegNames, Robot
from plantar.robots.robot_file import builtin_robots, load_robot

__all__ = ["FootShape", "LegNames", "Robot", "builtin_robots", "load_robot"]
