"""MJCF of a parametric biped: 6-DoF legs with position servos, upper body welded to the base.

Hip yaw about z, hip roll about x, hip pitch, knee and ankle pitch about y, ankle roll about x; the hip axes meet in one
point, the ankle axes in another.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.unknown_keys import refuse_unknown_keys
from plantar.common.sides import SIDES, Side
from plantar.errors import RobotError

_JOINTS = ("hip_yaw", "hip_roll", "hip_pitch", "knee", "ankle_pitch", "ankle_roll")
_AXES = ("0 0 1", "1 0 0", "0 1 0", "0 1 0", "0 1 0", "1 0 0")
_BASE_COM_Z = -0.06
_MIRRORED = (True, True, False, False, False, True)


@dataclass(frozen=True)
class BipedParameters:
    """Dimensions of a generated biped in m, kg and degrees.

    Attributes:
        total_mass: With skin and shoes; the chest has the rest.
        com_height: Above the outer sole in given posture.
        hip_offset: Left hip (3,) in base frame.
        ankle_offset: Left ankle against left hip (x, y) at zero angles.
        ankle_height: Ankle axes above bare sole.
        link_masses: Six, hip yaw to foot (without shoe).
        joint_lower: Six limits of left leg; `joint_upper` likewise.
        effort_limits: Six, in N m.
        velocity_limits: Six, in rad/s.
        chest_size: Box (3,) of upper body.
        armature: Reflected rotor inertia of a joint in kg m^2.
    """

    total_mass: float
    base_mass: float
    com_height: float
    hip_offset: tuple[float, float, float]
    ankle_offset: tuple[float, float]
    thigh_length: float
    shank_length: float
    ankle_height: float
    link_masses: tuple[float, ...]
    joint_lower: tuple[float, ...]
    joint_upper: tuple[float, ...]
    effort_limits: tuple[float, ...]
    velocity_limits: tuple[float, ...]
    chest_size: tuple[float, float, float]
    armature: float

    @classmethod
    def from_table(cls, table: Mapping[str, Any], where: str) -> "BipedParameters":
        """Read and check a `[biped]` table, named `where` in a RobotError. Returns the dimensions."""
        fields = list(cls.__dataclass_fields__)
        refuse_unknown_keys(table, fields, f"{where}: [biped]", RobotError)
        missing = next((key for key in fields if key not in table), None)
        if missing is not None:
            raise RobotError(f"{where}: [biped] lacks '{missing}'")
        try:
            return cls(**table)
        except RobotError as error:
            raise RobotError(f"{where}: [biped] {error}") from None

    def __post_init__(self) -> None:
        for key in self.__dataclass_fields__:
            object.__setattr__(self, key, _dimension(getattr(self, key), key))


# How many numbers a dimension has that is not a single one
_COUNTS: Mapping[str, int] = {
    "hip_offset": 3,
    "ankle_offset": 2,
    "link_masses": 6,
    "joint_lower": 6,
    "joint_upper": 6,
    "effort_limits": 6,
    "velocity_limits": 6,
    "chest_size": 3,
}


def _dimension(value: Any, key: str) -> float | tuple[float, ...]:
    many = isinstance(value, (list, tuple))
    items = value if many else (value,)
    if many != (key in _COUNTS) or len(items) != _COUNTS.get(key, 1):
        raise RobotError(f"{key} needs {_COUNTS.get(key, 1)} number(s)")
    if not all(isinstance(item, (int, float)) and math.isfinite(item) for item in items):
        raise RobotError(f"{key} holds a value that is not a finite number")
    return tuple(map(float, items)) if many else float(value)


def _mass_attributes(mass: float, size: Sequence[float], position: Sequence[float]) -> str:
    x, y, z = size
    inertia = mass / 12.0 * np.array([y * y + z * z, x * x + z * z, x * x + y * y])
    return (
        f'<inertial pos="{position[0]:.6g} {position[1]:.6g} {position[2]:.6g}" mass="{mass:.6g}" '
        f'diaginertia="{inertia[0]:.6g} {inertia[1]:.6g} {inertia[2]:.6g}"/>'
    )


def _leg(side: Side, p: BipedParameters, sole: Mapping[str, Any], shoe_mass: float, thickness: float) -> str:
    mirror = 1.0 if side == "left" else -1.0
    lower = list(p.joint_lower)
    upper = list(p.joint_upper)
    if side == "right":
        for i, flipped in enumerate(_MIRRORED):
            if flipped:
                lower[i], upper[i] = -upper[i], -lower[i]

    def joint(i: int) -> str:
        return (
            f'<joint name="{side}_{_JOINTS[i]}" axis="{_AXES[i]}" range="{lower[i]:.6g} {upper[i]:.6g}" '
            f'armature="{p.armature:.6g}"/>'
        )

    m = p.link_masses
    hx, hy, hz = p.hip_offset
    ax, ay = p.ankle_offset
    cx, cy = sole["center"]
    lx, ly = sole["half_size"]
    knee = f"{ax:.6g} {mirror * ay:.6g} {-p.thigh_length:.6g}"
    bottom = -(p.ankle_height + thickness)
    foot_x = 2 * lx * 0.9
    foot_y = 2 * ly * 0.9
    foot_z = 0.05
    return f"""
    <body name="{side}_hip_yaw_link" pos="{hx:.6g} {mirror * hy:.6g} {hz:.6g}">
      {_mass_attributes(m[0], (0.08, 0.08, 0.08), (0, 0, 0.03))}
      {joint(0)}
      <body name="{side}_hip_roll_link">
        {_mass_attributes(m[1], (0.08, 0.08, 0.08), (0, 0, 0))}
        {joint(1)}
        <geom class="look" type="sphere" size="0.055" rgba=".25 .27 .3 1"/>
        <body name="{side}_thigh">
          {_mass_attributes(m[2], (0.11, 0.11, p.thigh_length), (0, 0, -p.thigh_length / 2))}
          {joint(2)}
          <geom class="look" type="capsule" size="0.055" fromto="0 0 -.03 {knee}"/>
          <body name="{side}_shank" pos="{knee}">
            {_mass_attributes(m[3], (0.09, 0.09, p.shank_length), (0, 0, -p.shank_length / 2))}
            {joint(3)}
            <geom class="look" type="capsule" size="0.045" rgba=".25 .27 .3 1"
              fromto="0 0 0 0 0 {-p.shank_length:.6g}"/>
            <body name="{side}_ankle" pos="0 0 {-p.shank_length:.6g}">
              {_mass_attributes(m[4], (0.06, 0.06, 0.06), (0, 0, 0))}
              {joint(4)}
              <body name="{side}_foot">
                {_mass_attributes(m[5] + shoe_mass, (foot_x, foot_y, foot_z), (cx, mirror * cy, bottom + 0.035))}
                {joint(5)}
                <site name="{side}_sole" pos="0 0 {bottom:.6g}" size="0.005"/>
                <site name="{side}_ankle_force_torque" pos="0 0 0" size="0.005"/>
                <geom class="look" type="box" size="{lx * 0.86:.6g} {ly * 0.86:.6g} .02"
                  pos="{cx:.6g} {mirror * cy:.6g} {bottom + thickness + 0.02:.6g}"/>
                <geom class="look" type="capsule" size=".042" rgba=".25 .27 .3 1"
                  fromto="0 0 0 0 0 {bottom + thickness + 0.05:.6g}"/>
                <geom name="{side}_sole_box" class="sole" type="box" size="{lx:.6g} {ly:.6g} {0.5 * thickness:.6g}"
                  pos="{cx:.6g} {mirror * cy:.6g} {bottom + 0.5 * thickness:.6g}"/>
              </body>
            </body>
          </body>
        </body>
      </body>
    </body>"""


def _chest_height(p: BipedParameters, posture: NDArray[np.float64], shoe_mass: float, thickness: float) -> float:
    """Chest's CoM above the base for a CoM at `com_height`."""
    hip = math.radians(posture[2])
    knee = math.radians(posture[3])
    hip_z = p.hip_offset[2]
    knee_z = hip_z - p.thigh_length * math.cos(hip)
    ankle_z = knee_z - p.shank_length * math.cos(hip + knee)
    base_height = p.ankle_height + thickness - ankle_z
    m = p.link_masses
    leg_moment = (
        m[0] * (hip_z + 0.03)
        + m[1] * hip_z
        + m[2] * 0.5 * (hip_z + knee_z)
        + m[3] * 0.5 * (knee_z + ankle_z)
        + m[4] * ankle_z
        + (m[5] + shoe_mass) * (0.035 - base_height)
    )
    chest = p.total_mass - p.base_mass - 2.0 * (sum(m) + shoe_mass)
    rest = 2.0 * leg_moment + p.base_mass * _BASE_COM_Z
    return (p.total_mass * (p.com_height - base_height) - rest) / chest


def biped_mjcf(
    p: BipedParameters,
    *,
    name: str,
    posture: Sequence[float],
    sole_center: tuple[float, float],
    sole_half_size: tuple[float, float],
    shoe_thickness: float,
    shoe_mass: float,
    stiffness: Sequence[float],
    damping: Sequence[float],
) -> str:
    """MJCF text of the biped, without ground.

    Args:
        posture: Six left-leg joint angles in degrees for `com_height`.
        sole_center: Center (x, y) of left contact rectangle against ankle in m.
        sole_half_size: Its half lengths (x, y) in m.
        shoe_thickness: Outer contact face below bare sole in m.
        shoe_mass: One shoe, in kg.
        stiffness: Position gains of a leg's six servos in N m/rad.
        damping: Velocity gains in N m s/rad.

    Returns:
        MJCF with bodies "base", "<side>_foot", sites "<side>_sole", "imu", geoms "<side>_sole_box" and a position
        actuator a joint.
    """
    chest = p.total_mass - p.base_mass - 2.0 * (sum(p.link_masses) + shoe_mass)
    if chest <= 0.0:
        raise RobotError(f"robot '{name}': the links weigh more than total_mass = {p.total_mass} kg")
    chest_z = _chest_height(p, np.asarray(posture, dtype=float), shoe_mass, shoe_thickness)
    w = p.chest_size[1]
    d = p.chest_size[0]
    h = p.chest_size[2]

    def arm(side: Side) -> str:
        mirror = 1.0 if side == "left" else -1.0
        shoulder = f"0 {mirror * w * 0.5:.6g} {chest_z + 0.28:.6g}"
        return (
            f'<geom name="{side}_arm_shape" class="look" type="capsule" size=".045" '
            f'fromto="{shoulder} 0 {mirror * w * 0.62:.6g} {chest_z - 0.25:.6g}"/>'
        )

    sole = {"center": sole_center, "half_size": sole_half_size}
    legs = "".join(_leg(side, p, sole, shoe_mass, shoe_thickness) for side in SIDES)
    servos = "\n".join(
        f'    <position name="{side}_{joint}" joint="{side}_{joint}" kp="{stiffness[i]:.6g}" kv="{damping[i]:.6g}" '
        f'forcerange="{-p.effort_limits[i]:.6g} {p.effort_limits[i]:.6g}"/>'
        for side in SIDES
        for i, joint in enumerate(_JOINTS)
    )
    return f"""<mujoco model="{name}">
  <compiler angle="degree" autolimits="true"/>
  <default>
    <default class="look"><geom contype="0" conaffinity="0" group="1" mass="0" rgba=".82 .83 .86 1"/></default>
    <default class="sole"><geom contype="1" conaffinity="2" group="0" mass="0" rgba=".1 .1 .12 1"/></default>
  </default>
  <worldbody>
    <body name="base" pos="0 0 {p.com_height + 0.1:.6g}">
      <freejoint name="root"/>
      {_mass_attributes(p.base_mass, (0.18, 0.26, 0.16), (0, 0, _BASE_COM_Z))}
      <site name="imu" pos="0 0 0" size="0.01"/>
      <geom class="look" type="box" size=".09 .13 .08" pos="0 0 -.06" rgba=".25 .27 .3 1"/>
      <body name="chest">
        {_mass_attributes(chest, (d, w, h), (0, 0, chest_z))}
        <geom class="look" type="box" size="{d * 0.4:.6g} {w * 0.4:.6g} {h * 0.5:.6g}" pos="0 0 {chest_z + 0.08:.6g}"/>
        <geom class="look" type="sphere" size=".09" pos="0 0 {chest_z + 0.5 * h + 0.2:.6g}"/>
        {arm("left")}
        {arm("right")}
      </body>{legs}
    </body>
  </worldbody>
  <actuator>
{servos}
  </actuator>
  <sensor>
    <gyro name="imu_gyro" site="imu"/>
    <accelerometer name="imu_accelerometer" site="imu"/>
    <force name="left_ankle_force" site="left_ankle_force_torque"/>
    <torque name="left_ankle_torque" site="left_ankle_force_torque"/>
    <force name="right_ankle_force" site="right_ankle_force_torque"/>
    <torque name="right_ankle_torque" site="right_ankle_force_torque"/>
  </sensor>
</mujoco>
"""
