"""Write the MJCF of the machine `h1-body`: `python tools/h1_body.py .../companion/machines/h1-body/h1_body.xml`.

Legs, pelvis and total mass are those of the walking robot h1 (`plantar/robots/h1/robot.toml`); two waist joints, a
torso, two arms of seven joints and a head of two replace its chest. Lengths and masses of the upper body are assumed,
for 1.65 m in all; the torso takes the rest of the mass, and its centre of mass is where the whole robot's comes out at
the published 0.80 m above the soles in the machine's posture.
"""

import sys
import tomllib
from pathlib import Path

import mujoco
import numpy as np

from plantar.robots import load_robot
from plantar.robots.biped import BipedParameters, biped_mjcf

WAIST_Z, TORSO_Z = -0.02, 0.02  # m: waist in the base, torso in the waist
CHEST_Z, SHOULDER = 0.10, (0.0, 0.245, 0.50)  # m: lower edge of the chest and left arm in the torso
UPPER_ARM, LOWER_ARM, HAND = 0.28, 0.25, 0.16  # m
ARM_MASSES = (0.9, 0.7, 1.4, 0.5, 1.0, 0.3, 0.6)  # kg, shoulder to hand: 5.4
WAIST_MASS, HEAD_MASSES = 3.0, (0.4, 2.1)  # kg
CHEST = (0.22, 0.38, 0.46)  # m: depth, width, height of the torso
ARMATURE = {"waist": 0.08, "shoulder": 0.05, "elbow": 0.05, "wrist": 0.01, "head": 0.01}  # kg m^2


def arm(side: str) -> str:
    """One arm; its joints turn the same way on both sides."""
    s = 1.0 if side == "left" else -1.0
    m = ARM_MASSES
    x, y, z = SHOULDER

    def joint(name: str, axis: str, low: float, high: float, kind: str) -> str:
        return f'<joint name="{side}_{name}" axis="{axis}" range="{low} {high}" armature="{ARMATURE[kind]}"/>'

    def lump(mass: float, size: tuple[float, float, float], at: tuple[float, float, float]) -> str:
        a, b, c = np.array(size) ** 2
        i = mass / 12.0 * np.array([b + c, a + c, a + b])
        return f'<inertial pos="{at[0]} {at[1]} {at[2]}" mass="{mass}" diaginertia="{i[0]:.6g} {i[1]:.6g} {i[2]:.6g}"/>'

    return f"""
    <body name="{side}_shoulder_pitch_link" pos="{x} {s * y} {z}">
      {lump(m[0], (0.1, 0.1, 0.1), (0, 0, 0))}{joint("shoulder_pitch", "0 -1 0", -60, 150, "shoulder")}
      <geom class="look" type="sphere" size=".06"/>
      <body name="{side}_shoulder_roll_link">
        {lump(m[1], (0.1, 0.1, 0.1), (0, 0, 0))}{joint("shoulder_roll", f"{s} 0 0", -5, 110, "shoulder")}
        <body name="{side}_upper_arm">
          {lump(m[2], (0.1, 0.1, UPPER_ARM), (0, 0, -UPPER_ARM / 2))}
          {joint("shoulder_yaw", f"0 0 {s}", -90, 90, "shoulder")}
          <geom class="look" type="capsule" size=".055" fromto="0 0 -.03 0 0 {-UPPER_ARM + 0.01}"/>
          <body name="{side}_elbow_link" pos="0 0 {-UPPER_ARM}">
            {lump(m[3], (0.08, 0.08, 0.08), (0, 0, 0))}{joint("elbow", "0 -1 0", 0, 135, "elbow")}
            <body name="{side}_lower_arm">
              {lump(m[4], (0.08, 0.08, LOWER_ARM), (0, 0, -LOWER_ARM / 2))}
              {joint("wrist_yaw", f"0 0 {s}", -110, 110, "elbow")}
              <geom class="look" type="capsule" size=".045" fromto="0 0 -.02 0 0 {-LOWER_ARM + 0.03}"/>
              <body name="{side}_wrist" pos="0 0 {-LOWER_ARM}">
                {lump(m[5], (0.05, 0.05, 0.05), (0, 0, 0))}{joint("wrist_roll", f"{s} 0 0", -60, 60, "wrist")}
                <body name="{side}_hand">
                  {lump(m[6], (0.09, 0.05, HAND), (0, 0, -HAND / 2))}{joint("wrist_pitch", "0 -1 0", -60, 60, "wrist")}
                  <geom class="look" type="box" size=".045 .025 {HAND / 2 - 0.01}" pos="0 0 {-HAND / 2 - 0.01}"/>
                </body>
              </body>
            </body>
          </body>
        </body>
      </body>
    </body>"""


def torso(mass: float, com_z: float) -> str:
    """Waist, torso, arms and head."""
    d, w, h = CHEST
    inertia = mass / 12.0 * np.array([w * w + h * h, d * d + h * h, d * d + w * w])
    turning = " ".join(f"{i:.6g}" for i in inertia)
    middle = CHEST_Z + 0.5 * h
    return f"""
  <body name="waist" pos="0 0 {WAIST_Z}">
    <inertial pos="0 0 0.03" mass="{WAIST_MASS}" diaginertia="0.02 0.02 0.02"/>
    <joint name="waist_yaw" axis="0 0 1" range="-75 75" armature="{ARMATURE["waist"]}"/>
    <geom class="look" type="cylinder" size=".08 .05" pos="0 0 .03" rgba=".25 .27 .3 1"/>
    <body name="torso" pos="0 0 {TORSO_Z}">
      <inertial pos="0 0 {com_z:.6g}" mass="{mass:.6g}" diaginertia="{turning}"/>
      <joint name="waist_pitch" axis="0 1 0" range="-15 45" armature="{ARMATURE["waist"]}"/>
      <geom class="look" type="box" size="{d / 2} {w / 2} {h / 2}" pos="0 0 {middle:.6g}"/>
      <body name="neck" pos="0 0 {CHEST_Z + h:.6g}">
        <inertial pos="0 0 .03" mass="{HEAD_MASSES[0]}" diaginertia="0.001 0.001 0.001"/>
        <joint name="head_yaw" axis="0 0 1" range="-70 70" armature="{ARMATURE["head"]}"/>
        <body name="head" pos="0 0 .06">
          <inertial pos="0 0 .09" mass="{HEAD_MASSES[1]}" diaginertia="0.012 0.012 0.012"/>
          <joint name="head_pitch" axis="0 1 0" range="-15 45" armature="{ARMATURE["head"]}"/>
          <geom class="look" type="sphere" size=".1" pos="0 0 .1"/>
        </body>
      </body>{arm("left")}{arm("right")}
    </body>
  </body>"""


def mjcf(mass: float, com_z: float) -> str:
    """The machine's MJCF with a torso of a mass in kg whose centre of mass is at a height in m of its frame."""
    robot = load_robot("h1")
    p: BipedParameters = robot.biped
    center, half = robot.sole_rectangle("left")
    text = biped_mjcf(
        p,
        name="h1-body",
        posture=np.degrees(robot.posture["left"]).tolist(),
        sole_center=center,
        sole_half_size=half,
        shoe_thickness=robot.shoe_thickness,
        shoe_mass=robot.shoe_mass,
        stiffness=[1.0] * 6,
        damping=[1.0] * 6,
    )
    begin, end = text.index('<body name="chest">'), text.index('<body name="left_hip_yaw_link"')
    text = text[:begin] + torso(mass, com_z).lstrip() + "\n    " + text[end:]
    return text[: text.index("  <actuator>")] + "</mujoco>\n"


def com_height(model: mujoco.MjModel, angles: dict[str, float]) -> float:
    """Height in m of the centre of mass above the left sole with joints at angles in degrees."""
    data = mujoco.MjData(model)
    for name, angle in angles.items():
        data.qpos[model.joint(name).qposadr[0]] = np.radians(angle)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    return float(data.subtree_com[0][2] - data.site("left_sole").xpos[2])


def main(path: Path) -> None:
    """Write the file; the posture is that of the machine's TOML next to it."""
    joints = tomllib.loads((path.parent / "machine.toml").read_text())["joints"]
    posture = {name: table.get("posture", 0.0) for name, table in joints.items()}
    robot = load_robot("h1")
    rest = float(mujoco.MjModel.from_xml_string(mjcf(1.0, 0.0)).body_mass.sum()) - 1.0
    mass = robot.biped.total_mass - rest
    low, high = (com_height(mujoco.MjModel.from_xml_string(mjcf(mass, z)), posture) for z in (0.0, 0.1))
    com_z = 0.1 * (robot.biped.com_height - low) / (high - low)
    path.write_text(mjcf(mass, com_z))
    print(f"torso {mass:.3f} kg, its centre of mass {com_z:.4f} m above the waist pitch joint")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
