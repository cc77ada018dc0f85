"""Hands, guide and partner of a run, their skin and judge."""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.body_scale import BodyScale
from plantar.common.sides import Side
from plantar.gait.plan.footsteps import Footstep
from plantar.gait.plan.phases import WalkSchedule
from plantar.sensing.link_skin import BodySkin
from plantar.sim.arms.worn_arm import WornArm
from plantar.sim.judging.criteria.criterion import not_measured
from plantar.sim.judging.guide_truth import GuideTruth
from plantar.sim.judging.partner_support import PartnerSupport
from plantar.sim.judging.push_truth import Pushed, PushTruth, step_changes, strides
from plantar.sim.judging.step_count import Stand
from plantar.sim.model.world import World
from plantar.sim.partner.guide import Grip, Guide
from plantar.sim.partner.hand_pushes import HandPushes
from plantar.sim.partner.mobile_robot import MobileRobot
from plantar.sim.partner.touch import Partner, Touch
from plantar.sim.run.hand_pushing import hand_pushes
from plantar.sim.run.pushing import direction_name
from plantar.sim.run.scene import Scene


class Touched:
    """Hands and partner, from plan to verdict.

    `schedule`: returns the walk's planned phases; `seed` of noise and open choices; `reach`: a partner's hand height in
    the world in m; `period` of control in s; `worn`: the moving arm, or None. Attributes `partners` to be added to the
    world; `touch` in the world; None before `enter`; `support`: how much they carry.
    """

    def __init__(
        self,
        scene: Scene,
        skin: BodySkin,
        body: BodyScale,
        schedule: Callable[[], WalkSchedule],
        feet: Mapping[Side, Footstep],
        steps: Sequence[Footstep],
        seed: int,
        reach: float,
        period: float,
        worn: WornArm | None = None,
    ) -> None:
        self.support = PartnerSupport(body, period)
        self._scene = scene
        self._skin = skin
        self._body = body
        self._seed = seed
        self._feet = feet
        self._steps = steps
        timing = schedule().timing
        self._truth = PushTruth(body.mass, body.leg, 2.0 * (timing.single_support + timing.double_support))
        self.hands: HandPushes | None = None
        self.partner: MobileRobot | None = None
        self.touch: Touch | None = None
        self.partners: list[Partner] = []
        if scene.partner.kind == "mobile_robot":
            self.partner = MobileRobot(scene.partner, skin, body, reach, seed)
            self.partners.append(self.partner)
        if scene.push.by == "hands" and scene.push.strength > 0.0:
            self.hands = hand_pushes(scene.push, schedule, (feet, steps), skin, body, seed)
            self.partners.append(self.hands)
        self.guide: Guide | None = None
        self._led: GuideTruth | None = None
        self._worn = worn
        if worn is not None and scene.guide.way > 0.0:
            self.guide = Guide(scene.guide, Grip(*worn.surface(f"{worn.side}_lower_arm")), body, seed)
            self.partners.append(self.guide)

    def enter(self, world: World) -> Touch:
        """Find skin and partners in the compiled world; returns the skin."""
        self.touch = Touch(world, self._skin, self.partners, self._seed)
        if self.guide is not None and self._worn is not None:
            way = self.guide.sign * self.guide.settings.way
            worn = self._worn
            grip = self.guide.grip
            starts = self.guide.starts
            self._led = GuideTruth(world, grip.link, grip.point, tuple(worn.joints), worn.posture, way, starts)
        return self.touch

    def update(self, world: World, time: float, zmp: NDArray[np.float64] | None) -> None:
        """Take true `zmp` (2,) in m, or None, at `time` in s in the `world`, after its physics step."""
        if self.touch is not None:
            self.support.update(self.touch.force)
        if self.touch is not None and self.hands is not None:
            com = world.data.subtree_com[world.torso]
            self._truth.update(time, com, zmp, self.touch.wrench)
        if self._led is not None:
            self._led.update(time)

    def steps_reasons(self, stands: Sequence[Stand]) -> list[dict[str, Any]]:
        """`PushTruth.steps_reasons` by the feet's `stands`."""
        if self.hands is None:
            return not_measured("larger_pushes_step", "no hand pushed")
        return self._truth.steps_reasons(self._pushes(), step_changes(stands, self._feet, self._steps))

    def stride_reasons(self, stands: Sequence[Stand]) -> list[dict[str, Any]]:
        """`PushTruth.stride_reasons` by the feet's `stands`."""
        if self.hands is None:
            return not_measured("longer_strides", "no hand pushed")
        return self._truth.stride_reasons(self._pushes(), strides(stands, self._feet, self._steps))

    def acceleration_reasons(self) -> list[dict[str, Any]]:
        """`PushTruth.acceleration_reasons`."""
        if self.hands is None:
            return not_measured("com_accelerated", "no hand pushed")
        return self._truth.acceleration_reasons(self._pushes())

    def guide_reasons(self) -> list[dict[str, Any]]:
        """`GuideTruth.reasons`."""
        return not_measured("follows_guide", "no hand led") if self._led is None else self._led.reasons()

    def largest_impulse(self) -> float:
        """Largest true impulse in N s of the hands' pushes so far."""
        return max((float(np.hypot(*push.impulse)) for push in self._pushes()), default=0.0)

    def summary(self, stands: Sequence[Stand], walked: float) -> dict[str, Any]:
        """Returns the scene's "push", "partner" and "guide", by feet's `stands` and CoM way `walked` in m."""
        found: dict[str, Any] = {}
        if self.hands is not None:
            push = self._scene.push
            figures = self.hands.summary()
            for row, measured in zip(figures["pushes"], self._truth.accelerations(self._pushes()), strict=True):
                row |= {name: round(value, 3) for name, value in measured.items()}
            changes = step_changes(stands, self._feet, self._steps)
            ways = strides(stands, self._feet, self._steps)
            given = self.largest_impulse() if self._pushes() else None
            found["push"] = {
                "impulse_Ns": None if given is None else round(given, 4),
                "asked_Ns": round(push.strength, 4),
                "dv_m_s": None if given is None else round(given / self._body.mass, 4),
                "direction": direction_name(push, self._seed),
                "step_changes_m": [round(change, 4) for change in changes],
                "strides_m": [[round(v, 4) for v in way.true] for way in ways],
                **figures,
            }
        if self.partner is not None:
            found["partner"] = {**self.partner.summary(), "robot_moved_m": round(walked, 4)}
        if self.guide is not None and self._led is not None:
            found["guide"] = {**self.guide.summary(), **self._led.summary(), "robot_moved_m": round(walked, 4)}
        return found

    def _pushes(self) -> list[Pushed]:
        if self.hands is None:
            return []
        full = (1.0 - 1e-9) * self._scene.push.strength
        return [
            Pushed(p.step, p.start, p.end, p.delivered[:2], float(np.hypot(*p.impulse)) < full)
            for p in self.hands.pushes
            if p.start < math.inf
        ]
