"""What a proposer of plan changes has to keep."""

import numpy as np

from plantar.common.sides import SIDES
from plantar.errors import PlantarError
from plantar.gait.plan.feet_view import FeetView
from plantar.gait.plan.footsteps import straight_plan
from plantar.gait.plan.phases import Timing
from plantar.gait.plan.plan_change import PlanChange
from plantar.gait.plan.walk_plan import WalkPlan
from plantar.gait.propose.proposer import Priority, Proposer, Tick
from plantar.kernels.gait.command_frame import CommandFrame

_OMEGA = 3.5  # rad/s of a pendulum 0.8 m high
_STEPS = 6
_PERIOD = 0.02  # s between the ticks that are tried
_UNBOUNDED = np.empty((0, 2))


def check_proposer(proposer: Proposer) -> list[str]:
    """What a proposer lacks, a sentence each; empty if nothing.

    It is asked at the ticks of a walk of six level steps, and what it proposes is applied to the plan.

    Args:
        proposer: A fresh one.

    Returns:
        The sentences.
    """
    lacks: list[str] = []
    if not isinstance(getattr(proposer, "priority", None), Priority):
        lacks.append("priority is none of " + ", ".join(f"Priority.{p.name}" for p in Priority))
    feet, steps = straight_plan(_STEPS)
    plan = WalkPlan(feet, steps, Timing(), {side: np.array([0.02, 0.0]) for side in SIDES}, _OMEGA, 1.0)
    frame = CommandFrame(np.zeros(3), 0.005, 0.3)
    time = 0.0
    while time < plan.schedule.end:
        change = proposer.propose(_tick(plan, time, frame))
        if change is not None and not isinstance(change, PlanChange):
            return [*lacks, f"propose() returns a {type(change).__name__}; expected a PlanChange or None"]
        if change is not None:
            try:
                plan.apply(change, time, _UNBOUNDED)
            except PlantarError as error:
                return [*lacks, f"at {time:.2f} s its change cannot be applied: {error}"]
            if not change.reason:
                lacks.append("a change gives no reason, which the record of the plan holds")
        time += _PERIOD
    return list(dict.fromkeys(lacks))


def _tick(plan: WalkPlan, time: float, frame: CommandFrame) -> Tick:
    """The tick at a time in s, feet where the plan has them."""
    phase = plan.schedule.at(time)
    view = plan.view
    feet = straight_plan(0)[0]
    for k in range(view.first, phase.step):
        feet[view.foothold(k).side] = view.foothold(k)
    commanded = {side: (feet[side].position, feet[side].yaw) for side in SIDES}
    return Tick(time, phase, view, FeetView(commanded, phase.swing, landed=phase.swing is None), frame)
