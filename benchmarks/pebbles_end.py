"""What ends a walk on pebbles: `python benchmarks/pebbles_end.py` draws pebbles_end.png for h1.

The desired ZMP and the real one, sideways, over the last steps before the robot is lost, on a plant drawn with
ordinary care and a seed drawn from this script's name.
"""

import hashlib
from collections.abc import Sequence
from typing import Any

import numpy as np
from resumable import FOLDER, PLANTS

from plantar.common.sides import SIDES
from plantar.plotting import new_figure, save_figure
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene

SEED = int.from_bytes(hashlib.sha256(b"pebbles_end").digest()[:4], "big")
SHOWN = 2.0  # s before the end


class Followed(Simulation):
    """A run that keeps what its controller wanted and where the ground pushed at each tick."""

    def __init__(self, *arguments: Any) -> None:
        super().__init__(*arguments)
        self.kept: list[tuple[float, ...]] = []

    def after_tick(self) -> None:
        super().after_tick()
        if self.controller.safe_state is not None or self.judge.fall is not None:
            return
        reading, command, _ = self._tick
        true = self.judge.truth().zmp
        feet = [command.state.positions_sole[side][1] for side in SIDES]
        self.kept.append(
            (
                reading.time,
                command.reference.dcm[1],
                command.dcm[1],
                command.zmp_desired[1],
                np.nan if true is None else true[1],
                *(feet[i] if self.judge.loads[i] > 0.0 else np.nan for i in range(len(SIDES))),
            )
        )


def draw(rows: Sequence[tuple[float, ...]], half_width: float) -> Any:
    """Picture of the kept `rows`; `half_width` of a sole in m."""
    table = np.array(rows)
    table = table[table[:, 0] > table[-1, 0] - SHOWN]
    time, planned, dcm, wanted, true, *feet = table.T
    figure, axis = new_figure(9.0, 4.5)
    for side, y in zip(SIDES, feet, strict=True):
        edges = 1e3 * (y - half_width), 1e3 * (y + half_width)
        axis.fill_between(time, *edges, alpha=0.15, label=f"{side} sole, loaded")
    for values, style, label in (
        (planned, "k:", "DCM, planned"),
        (dcm, "k-", "DCM, estimated"),
        (wanted, "C2-", "ZMP, desired"),
        (true, "C3-", "ZMP, true"),
    ):
        axis.plot(time, 1e3 * values, style, label=label, linewidth=1.2)
    axis.set(xlabel="time [s]", ylabel="y [mm], left is up", ylim=(-250.0, 250.0))
    axis.set_title(f"h1 on pebbles, drawn plant, seed {SEED}", fontsize=10)
    axis.legend(fontsize=8, ncols=3, loc="upper left")
    return figure


def main() -> None:
    simulation = Followed(load_scene("pebbles", PLANTS["ordinary"], "h1"), SEED)
    summary = simulation.run()
    y = simulation.robot.layouts["left"].outline[:, 1]
    save_figure(draw(simulation.kept, 0.5 * float(np.ptp(y))), FOLDER / "pebbles_end.png")
    print(f"{summary['steps_taken']} of {summary['steps_planned']} steps; lost at {simulation.kept[-1][0]:.2f} s")


if __name__ == "__main__":
    main()
