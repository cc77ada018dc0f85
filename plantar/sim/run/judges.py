"""All that follows the true state of a walk, and passes nothing to the controller."""

import numpy as np

from plantar.common.sides import SIDES
from plantar.gait.command import Command, Sensors
from plantar.sim.judging.foothold_truth import FootholdTruth
from plantar.sim.judging.judge import Judge, PlainGround
from plantar.sim.judging.outside_force import Actor
from plantar.sim.judging.recovery import Recovery
from plantar.sim.judging.velocity_truth import VelocityTruth
from plantar.sim.judging.walk_goal import WalkGoal
from plantar.sim.judging.zmp_comparison import ZmpComparison
from plantar.sim.model.world import World
from plantar.sim.partner.touch import Touch
from plantar.sim.run.pushing import Pusher
from plantar.sim.run.touched import Touched
from plantar.sim.run.walker import Walker
from plantar.sim.terrain import Ground

_AROUND = 0.25  # leg around a sole within which an edge may be why a step is moved


class Judges:
    """Judges a walk from time 0 on, when the robot stands.

    Attributes:
        recovery: Of pushes, or None.
        zmps: Of skin and ankle sensors, or None.
        speeds: Against commanded velocities, or None.
    """

    def __init__(
        self,
        walker: Walker,
        world: World,
        ground: Ground,
        pusher: Pusher,
        touched: Touched | None,
        touch: Touch | None,
    ) -> None:
        scene = walker.scene
        layouts = walker.robot.layouts
        self._world = world
        self._pusher = pusher
        self._touched = touched
        self._touch = touch
        self.recovery = Recovery(pusher.shoves, walker.body) if scene.push.count else None
        self.zmps: ZmpComparison | None = None
        if scene.sensing.force_torque:
            self.zmps = ZmpComparison(layouts, scene.sensing.force_noise, walker.settings.period)
        self.footholds = FootholdTruth(world, ground)
        goal = WalkGoal(walker.feet, walker.steps, walker.body.leg, scene.guide.way)
        self.speeds: VelocityTruth | None = None
        if walker.velocities is not None:
            begin = goal.end(walker.controller.middles)
            self.speeds = VelocityTruth(world, walker.velocities, walker.settings.timing, begin)
        plain = PlainGround(ground, {s: layouts[s].outline for s in SIDES}, _AROUND * walker.body.leg)
        pushers: tuple[Actor, ...] = (pusher,) if pusher.shoves else ()
        actors = pushers if touch is None else (*pushers, touch.sensor)
        self.judge = Judge(
            world,
            walker.settings.com_height,
            goal,
            plain,
            scene.control.learn_strides,
            actors=actors,
        )
        if any(criterion.of_pieces for criterion in scene.outcome.values()):
            self.judge.follow_pieces(ground)

    def update(self, reading: Sensors, command: Command) -> None:
        """Judge a control tick by its `reading` and `command`; a partner that presses counts as a push."""
        judge = self.judge
        time = reading.time
        if command.footholds:
            self.footholds.update(command.footholds)
        pushed = self._pusher.pushing or (self._touch is not None and bool(np.any(self._touch.force)))
        judge.update(time, command.state.com, command.state.zmp, command.moved_steps, pushed)
        if self.speeds is not None:
            self.speeds.update(time)
        if self._touched is not None:
            self._touched.update(self._world, time, judge.truth().zmp)
        if self.zmps is not None:
            self.zmps.update(time, command)
        if self.recovery is not None:
            plan = command.reference
            com = self._world.data.subtree_com[self._world.torso, :2]
            self.recovery.update(time, judge.truth().zmp, com, plan.vrp, plan.com)
