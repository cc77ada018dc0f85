"""What a user states of a robot where its model, or the fit, would be taken otherwise."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from typing import Any

from plantar.errors import InputError, RobotError


@dataclass(frozen=True)
class Wishes:
    """Levers of an introduction; each is found by itself where it is None.

    Attributes:
        height: CoM above the outer soles in m while walking.
        stance: Distance of the ankles in m.
        posture: Of arms, head and waist: a keyframe's name, "zero", or angles in degrees, "elbow=90,waist=0".
        imu: Name of the site or body of the IMU.
        feet: Names of the bodies that wear the shoes, in any order.
        leg: Length in m that steps, clearance and times are shares of: a shorter one than hip over knee to ankle.
    """

    height: float | None = None
    stance: float | None = None
    posture: str | None = None
    imu: str | None = None
    feet: tuple[str, str] | None = None
    leg: float | None = None


NO_WISHES = Wishes()
"""All is found."""


def feet_named(text: str) -> tuple[str, str]:
    """Returns the two feet that a `text` names, separated by a comma.

    Raises:
        InputError: If it does not name two.

    Example:
        >>> feet_named("l_foot, r_foot")
        ('l_foot', 'r_foot')
    """
    names = [name.strip() for name in text.split(",")]
    if len(names) != 2 or not all(names) or names[0] == names[1]:
        raise InputError(f"--foot is '{text}'; allowed: two names of bodies, separated by a comma")
    return names[0], names[1]


def angles_of(text: str, hinges: Sequence[str], where: str) -> Mapping[str, float]:
    """Returns angles in rad by joint of a `text` such as "elbow=90,waist=0", in degrees.

    Raises:
        RobotError: If one is no angle or no joint of `hinges`; the message begins with `where`.

    Example:
        >>> angles_of("elbow=180", ["elbow"], "robot.urdf")
        {'elbow': 3.141592653589793}
    """
    angles = {}
    for part in text.split(","):
        name, _, value = (word.strip() for word in part.partition("="))
        if name not in hinges:
            raise RobotError(f"{where}: --posture names joint '{name}'; {_nearest(name, hinges)}")
        try:
            angles[name] = math.radians(float(value))
        except ValueError:
            raise RobotError(f"{where}: --posture gives '{name}' the angle '{value}'; allowed: degrees") from None
        if not abs(angles[name]) <= 2.0 * math.pi:
            raise RobotError(f"{where}: --posture gives '{name}' {value} degrees; allowed: -360 to 360")
    return angles


def found(names: Sequence[str], name: str, what: str, where: str) -> str:
    """Returns `name` if it is one of `names`.

    Raises:
        RobotError: If it is not; the message begins with `where` and lists those that are alike.

    Example:
        >>> found(["pelvis"], "pelvis", "--imu", "robot.urdf")
        'pelvis'
    """
    if name not in names:
        raise RobotError(f"{where}: {what} names '{name}'; {_nearest(name, names)}")
    return name


def _nearest(name: str, names: Sequence[Any]) -> str:
    near = get_close_matches(name, names, 4, 0.5) or list(names)[:12]
    return f"the model has {', '.join(near)}" if near else "the model has none"
