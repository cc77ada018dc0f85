"""A proposer of your own: a reason to move a footstep, in one class, without touching the controller.

    python examples/walk_own_proposer.py

At the third step somebody asks to set the foot 4 cm further forward. A proposer sees a frozen `Tick` and returns a
`PlanChange`; the plan's owner decides, applies it and keeps a record.
"""

from dataclasses import replace

from plantar.gait.controller import Start, WalkingController
from plantar.gait.plan.plan_change import PlanChange
from plantar.gait.propose.proposer import Priority, was_applied
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene


class Further:
    """Moves one footstep and all after it forward, once, while the foot before it is in the air."""

    priority = Priority.COMMAND

    def __init__(self, step, distance):
        self.step, self.distance, self.change, self.done = step, distance, None, False

    def propose(self, tick):
        if self.change is not None and was_applied(self.change, tick):
            self.change, self.done = None, True
        if not self.done and self.change is None and tick.phase.step == self.step - 1:
            planned = tick.plan.foothold(self.step)
            moved = replace(planned, x=planned.x + self.distance)
            self.change = PlanChange("further", self.step, foothold=moved, shift=(self.distance, 0.0))
        return self.change


for mine in ((), (Further(2, 0.04),)):
    run = Simulation(load_scene("flat", ["steps=4", "settle=1.0"]))
    start = Start(run.feet, run.steps, run.scene.walk.begin, mine)
    run.controller = WalkingController(run.settings, start, run.robot.layouts, run.legs)
    summary = run.run()
    steps = ", ".join(f"{run.controller.plan.view.foothold(k).x:.2f}" for k in range(4))
    print(f"{'with' if mine else 'without'} it: steps at {steps} m; completed: {summary['completed']}")
