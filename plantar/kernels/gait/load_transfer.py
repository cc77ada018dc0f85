"""Kernel of `plantar.gait.balance.load_transfer`."""

from ..base import memory, vectors

__all__ = ["shared_load"]

_LEFT, _RIGHT = 1, 2


def shared_load(zmp, acceleration, mass, gravity, left, right, stance):
    """Share the force of the pendulum, m (a_x, a_y, g), between two feet.

    Args:
        zmp: Desired ZMP (2,) in m.
        acceleration: Acceleration (2,) of the CoM in m/s^2.
        mass: Mass m in kg.
        gravity: g in m/s^2.
        left: Left foot, with `position` (3,) in m and `rotation` (3, 3) of its sole frame, and the point `center` (2,)
            to load in it; `right` likewise.
        stance: The only carrying foot: 1 left, 2 right, 0 for none.

    Returns:
        Force (3,) on the left foot in N, where it acts (2,) in m, and the same of the right one.
    """
    goal, rate = memory.values(zmp), memory.values(acceleration)
    lx, ly = _loaded(left)
    rx, ry = _loaded(right)
    x, y = goal[0], goal[1]
    if stance == _LEFT:
        share = 1.0
    elif stance == _RIGHT:
        share = 0.0
    else:
        dx, dy = lx - rx, ly - ry
        apart = dx * dx + dy * dy
        share = min(1.0, max(0.0, ((x - rx) * dx + (y - ry) * dy) / apart)) if apart > 0.0 else 0.5
    other = 1.0 - share
    fx, fy, fz = mass * rate[0], mass * rate[1], mass * gravity
    x, y = x - (share * lx + other * rx), y - (share * ly + other * ry)
    return (
        vectors.vector(share * fx, share * fy, share * fz),
        vectors.vector2(lx + x, ly + y),
        vectors.vector(other * fx, other * fy, other * fz),
        vectors.vector2(rx + x, ry + y),
    )


def _loaded(foot):
    place, turn, middle = memory.values(foot.position), memory.values(foot.rotation), memory.values(foot.center)
    x, y = middle[0], middle[1]
    return place[0] + (turn[0] * x + turn[1] * y), place[1] + (turn[3] * x + turn[4] * y)
