"""Time of a control tick over the number of touched instances, with and without skipping silent ones.

The machine is h1-body on its left leg with the thirteen instances of `multi-contact` (T 3.2.4.1). In made readings
three taxels in the middle of each touched instance measure 2 N. Both controllers get the same state and reading in
turn.

    OMP_NUM_THREADS=1 python benchmarks/companion_ticks.py        (writes companion_ticks.md and companion_ticks.png)
"""

from pathlib import Path
from statistics import median
from time import perf_counter

import numpy as np
from numpy.typing import NDArray
from resumable import write_table

from plantar.bench.tables import markdown_table
from plantar.plotting import COLOURS, new_figure, save_figure
from plantar.sensing.link_skin import BodySkin
from plantar.sensing.reading import Reading
from plantar.sim.companion.experiments.multi_contact import MultiContact
from plantar.sim.companion.runner import Companion
from plantar.sim.run.scene_kind import open_scene
from plantar.wholebody.dynamics import RobotDynamics
from plantar.wholebody.tasks.skin_interaction import DirectInteraction, SkinInteraction
from plantar.wholebody.tasks.task import Demand

HERE = Path(__file__).parent
ROUNDS = 400
LIMITS = {2: 400.0, 13: 1500.0}
"""Wanted time in us by the number of touched instances."""


class NeverSilent(DirectInteraction):
    """Direct interaction that works for every taxel and link, as if all were touched."""

    def demand(self, robot: RobotDynamics, skin: Reading | None) -> Demand | None:
        return SkinInteraction.demand(self, robot, skin)

    def signal(self, skin: Reading) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        return self.gain * skin.force, self.counted


def reading(skin: BodySkin, names: list[str]) -> Reading:
    """The skin's reading when instances are touched."""
    force = np.zeros(len(skin))
    for name in names:
        patch = skin.patch(MultiContact.instances[name][0])
        force[skin.slices[patch.name]][patch.from_middle[:3]] = 2.0
    return Reading(0.0, force, np.full(len(skin), np.inf), None)


def main() -> None:
    companion = Companion(open_scene("multi-contact"), 0)
    experiment, robot = companion.experiment, companion.robot
    skin = companion.controller.skin
    skipping = companion.controller
    plain = experiment.controller(experiment.machine, skin)
    last = plain.stack.levels[-1]
    last[:] = [
        NeverSilent(skin, task.gain, MultiContact.instances[name])
        for task, name in zip(last, MultiContact.instances, strict=False)
    ] + last[len(MultiContact.instances) :]
    state = experiment.first, np.zeros(robot.model.nv)
    names = list(MultiContact.instances)
    table = []
    for count in range(len(names) + 1):
        touched = reading(skin, names[:count])
        took: dict[str, list[float]] = {"skipping": [], "not": []}
        jacobians = {}
        for _ in range(ROUNDS):
            for kind, controller in (("skipping", skipping), ("not", plain)):
                before = robot.jacobians
                began = perf_counter()
                robot.update(*state, 0.0)
                controller.step(robot, touched)
                took[kind].append(1e6 * (perf_counter() - began))
                jacobians[kind] = robot.jacobians - before
        table.append((count, median(took["skipping"]), median(took["not"]), jacobians["skipping"], jacobians["not"]))
        print(*table[-1], flush=True)
    head = ("touched", "skipping [us]", "not [us]", "Jacobians", "Jacobians, not skipping")
    shown = markdown_table(head, [(n, f"{a:.0f}", f"{b:.0f}", j, k) for n, a, b, j, k in table])
    write_table(HERE / "companion_ticks.md", [shown])
    draw(np.array(table))


def draw(table: NDArray[np.float64]) -> None:
    figure, axes = new_figure(7.0, 4.0)
    axes.plot(table[:, 0], table[:, 2], "s--", color=COLOURS["right"], label="every instance computed")
    axes.plot(table[:, 0], table[:, 1], "o-", color=COLOURS["left"], label="silent instances skipped")
    axes.plot(list(LIMITS), list(LIMITS.values()), "v", color="0.3", label="wanted at most")
    axes.set(xlabel="touched instances of 13", ylabel="control tick, median [us]", ylim=(0.0, None))
    axes.legend(loc="upper left")
    save_figure(figure, HERE / "companion_ticks.png")


if __name__ == "__main__":
    main()
