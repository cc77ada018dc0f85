"""Effects of contact parameters on slip, penetration, landing and run time."""

import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np
from contact_comparison import PLANE, Rig
from contact_soles import CANDIDATES, MASS, Contact, bounding_rectangle, build_sole

from plantar.layouts.layout import SoleLayout
from plantar.mechanics.lip import GRAVITY
from plantar.sim.model.contact_truth import contact_wrench_in_world, foot_contacts

_SOFT = (0.9, 0.95, 0.001, 0.5, 2.0)
_HARD = (0.99, 0.999, 0.001, 0.5, 2.0)

PARAMETERS: tuple[tuple[str, Contact], ...] = (
    ("recommended", Contact()),
    ("MuJoCo's defaults", Contact(0.02, 1.0, _SOFT, 3, "pyramidal", 1.0)),
    ("solref 0.002", Contact(time_constant=0.002)),
    ("solref 0.01", Contact(time_constant=0.01)),
    ("solref 0.02", Contact(time_constant=0.02)),
    ("solimp 0.9 0.95", Contact(impedance=_SOFT)),
    ("solimp 0.99 0.999", Contact(impedance=_HARD)),
    ("condim 4", Contact(condim=4)),
    ("pyramidal cone", Contact(cone="pyramidal")),
    ("impratio 1", Contact(friction_ratio=1.0)),
    ("impratio 100", Contact(friction_ratio=100.0)),
)
"""One change at a time against the recommended values, and MuJoCo's defaults."""


@dataclass(frozen=True)
class ParameterRow:
    """Figures of one set of contact parameters on the box sole.

    Attributes:
        name: What differs from recommended values.
        penetration_mm: Of the sole under 844 N.
        slip_mm_s: Creep under half the friction limit.
        twist_deg_s: Creep about z under 5 N m at 422 N.
        landing_N: Peak of a 3 kg foot landing at 0.15 m/s under 40 kg on a stiff servo.
        rebounds: How often it lifts off within 0.3 s.
        ripple_N: Of the normal force in quiet stance.
    """

    name: str
    penetration_mm: float
    slip_mm_s: float
    twist_deg_s: float
    landing_N: float
    rebounds: int
    ripple_N: float
    step_us: float


def study_contact_parameters(layout: SoleLayout, progress: Callable[[float, str], None]) -> list[ParameterRow]:
    """Returns a row for each of `PARAMETERS` on a `layout`'s box; `progress` gets fraction and text."""
    rows = []
    for i, (name, contact) in enumerate(PARAMETERS):
        progress(i / len(PARAMETERS), name)
        rows.append(_measure(name, contact, layout))
    return rows


def _measure(name: str, contact: Contact, layout: SoleLayout) -> ParameterRow:
    sole = build_sole(CANDIDATES[0], layout, PLANE, contact)
    middle = bounding_rectangle(layout)[0]
    weight = MASS * GRAVITY

    rig = Rig(sole, layout)
    rig.push(2.0 * weight, middle)
    rig.step(500)
    depth = -float(rig.data.contact.dist.min()) * 1e3
    force = []
    times = []
    for _ in range(300):
        start = time.perf_counter()
        rig.step()
        times.append(time.perf_counter() - start)
        force.append(float(rig.wrench()[2]))

    slip, _ = _creep(Rig(sole, layout), middle, (0.5 * contact.friction * weight, 0.0), 0.0)
    _, twist = _creep(Rig(sole, layout), middle, (0.0, 0.0), 5.0)
    landing, rebounds = _land(contact, layout)
    return ParameterRow(
        name=name,
        penetration_mm=depth,
        slip_mm_s=slip * 1e3,
        twist_deg_s=math.degrees(twist),
        landing_N=landing,
        rebounds=rebounds,
        ripple_N=float(np.std(force)),
        step_us=float(np.median(times)) * 1e6,
    )


def _creep(rig: Rig, middle: Any, tangential: tuple[float, float], twist: float) -> tuple[float, float]:
    """Speed in m/s and turning rate in rad/s over 0.5 s, after 0.3 s."""
    data = rig.data
    for _ in range(30):
        rig.push(MASS * GRAVITY, middle, tangential, twist)
        rig.step(10)
    place = data.qpos[:2].copy()
    turn = 2.0 * float(data.qpos[6])
    for _ in range(50):
        rig.push(MASS * GRAVITY, middle, tangential, twist)
        rig.step(10)
    return float(np.hypot(*(data.qpos[:2] - place))) / 0.5, abs(2.0 * float(data.qpos[6]) - turn) / 0.5


def _land(contact: Contact, layout: SoleLayout) -> tuple[float, int]:
    """Peak force in N and rebounds of a foot on a 2e5 N/m servo."""
    half = bounding_rectangle(layout)[1]
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco><option timestep="0.001" cone="{contact.cone}" impratio="{contact.friction_ratio:g}"
          integrator="implicitfast"/>
        <worldbody>{PLANE.format(contact=contact.geom_attributes())}
          <body name="leg" pos="0 0 0.5"><joint type="slide" axis="0 0 1"/>
            <geom type="sphere" size="0.05" mass="40" contype="0" conaffinity="0"/>
            <body name="foot" pos="0 0 -0.5"><joint name="leg" type="slide" axis="0 0 1"/>
              <geom name="sole" type="box" size="{half[0]} {half[1]} 0.01" pos="0 0 0.01" mass="3"
                {contact.geom_attributes()}/></body></body></worldbody>
        <actuator><position joint="leg" kp="2e5" kv="3e3"/></actuator></mujoco>"""
    )
    data = mujoco.MjData(model)
    data.qpos[0] = 2e-3
    data.qvel[0] = -0.15
    data.qpos[1] = 3.0 * GRAVITY / 2e5  # the servo carries the foot's weight
    sole = {model.geom("sole").id}
    peak = 0.0
    rebounds = 0
    before = False
    for _ in range(300):
        mujoco.mj_step(model, data)
        force = float(contact_wrench_in_world(foot_contacts(model, data, sole), data.xpos[2])[2])
        peak = max(peak, force)
        rebounds += before and force == 0.0
        before = force > 0.0
    return peak, int(rebounds)
