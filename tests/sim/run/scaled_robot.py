"""H1 made smaller or larger, lighter or heavier: a robot that walks as H1 does, up to scale."""

import json
import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from plantar.common.sides import SIDES
from plantar.layouts.layout import SoleLayout
from plantar.layouts.layout_file import write_layout
from plantar.robots import Robot, load_robot
from plantar.robots.kinematics.robot_model import robot_spec

_TOML = """name = "h1 times {s:g}"
[model]
kind = "mjcf"
file = "robot.xml"
[shoe]
layout = "layout_{{side}}.json"
origin = [0.0, 0.0, {origin!r}]
thickness = {thickness!r}
mass = {shoe!r}
{legs}
[torso]
body = "base"
imu_site = "imu"
[posture]
left = {posture}
right = {posture}
[gait]
com_height = {com_height!r}
stance_width = {stance_width!r}
trunk_lean = {trunk_lean!r}
largest_crouch = {crouch!r}
single_support = {single_support!r}
double_support = {double_support!r}
[servo]
stiffness = {stiffness!r}
damping = {damping!r}
effort_limits = {efforts}
velocity_limits = {speeds}
[balance]
law = "com_admittance"
dcm_gain = {dcm_gain!r}
zmp_gain = {zmp_gain!r}
com_gain = {com_gain!r}
"""


def scaled_h1(folder: Path, s: float, mass: float = 0.0) -> Path:
    """Write H1 with every length times s, and a mass; gravity stays.

    Dynamic similarity says how all else goes with the factor s of lengths and m of masses: times by sqrt(s), forces by
    m, torques and stiffnesses of joints by m s, their dampings by m s sqrt(s), inertias by m s^2.
    """
    folder.mkdir(parents=True, exist_ok=True)
    h1 = load_robot("h1")
    m, root = (mass / h1.biped.total_mass if mass else s**3), math.sqrt(s)
    (folder / "robot.xml").write_text(_model(h1, s, m), encoding="utf-8")
    for side in SIDES:
        write_layout(_layout(h1.layouts[side], s, m), folder / f"layout_{side}.json")
    biped = h1.biped
    legs = "\n".join(
        f'[legs.{side}]\njoints = {json.dumps(h1.legs[side].joints)}\nfoot_body = "{side}_foot"' for side in SIDES
    )
    text = _TOML.format(
        s=s,
        origin=-s * (biped.ankle_height + h1.shoe_thickness),
        thickness=s * h1.shoe_thickness,
        shoe=m * h1.shoe_mass,
        legs=legs,
        posture=[math.degrees(v) for v in h1.posture["left"]],
        com_height=s * h1.com_height,
        stance_width=s * h1.stance_width,
        trunk_lean=h1.trunk_lean / s,
        crouch=s * h1.largest_crouch,
        single_support=root * h1.single_support,
        double_support=root * h1.double_support,
        stiffness=m * s * 8000.0,
        damping=m * s * root * 150.0,
        efforts=[m * s * v for v in biped.effort_limits],
        speeds=[v / root for v in biped.velocity_limits],
        **{name: float(h1.balance[name]) / root for name in ("dcm_gain", "zmp_gain", "com_gain")},
    )
    path = folder / "robot.toml"
    path.write_text(text, encoding="utf-8")
    return path


def _model(h1: Robot, s: float, m: float) -> str:
    """MJCF of the scaled robot without soles and shoes, which come as parts of their own."""
    spec = robot_spec(h1)
    for side in SIDES:
        spec.delete(spec.geom(f"{side}_sole_box"))
        spec.delete(spec.geom(f"{side}_foot_shape"))
        spec.delete(spec.site(f"{side}_sole"))
        foot = spec.body(f"{side}_foot")
        foot.mass = foot.mass - h1.shoe_mass
    for body in spec.bodies[1:]:
        body.pos, body.ipos = s * np.array(body.pos), s * np.array(body.ipos)
        body.mass, body.inertia = m * body.mass, m * s * s * np.array(body.inertia)
    for joint in spec.joints:
        joint.armature = m * s * s * joint.armature
    for part in (*spec.geoms, *spec.sites):
        part.pos, part.size = s * np.array(part.pos), s * np.array(part.size)
        if isinstance(part, mujoco.MjsGeom) and np.isfinite(part.fromto[0]):
            part.fromto = s * np.array(part.fromto)
    for geom in [g for g in spec.geoms if g.contype]:
        spec.delete(geom)  # shapes of the legs: the simulator makes them anew
    spec.compile()
    return str(spec.to_xml())


def _layout(layout: SoleLayout, s: float, m: float) -> SoleLayout:
    ranges: Mapping[str, Any] = layout.ranges
    scaled = {
        **ranges,
        "force": tuple(m * v for v in ranges["force"]),
        "proximity": tuple(s * v for v in ranges["proximity"]),
    }
    thresholds = {"force": m, "proximity": s}
    return replace(
        layout,
        name=f"{layout.name} times {s:g}",
        positions=s * layout.positions,
        vertices=s * layout.vertices,
        areas=s * s * layout.areas,
        outline=s * layout.outline,
        cell_area=s * s * layout.cell_area,
        ranges=scaled,
        thresholds={k: thresholds.get(k, 1.0) * v for k, v in layout.thresholds.items()},
    )
