"""Robots as data: built-in ones in a folder each, others from a TOML of the same form."""

from plantar.robots.robot import FootShape, LegNames, Robot
from plantar.robots.robot_file import builtin_robots, load_robot

__all__ = ["FootShape", "LegNames", "Robot", "builtin_robots", "load_robot"]
