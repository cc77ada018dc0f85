"""Draw the figure of docs/concepts.md from a recording of a beam walk.

plantar sim beam --seed 2 --set steps=12 --record beam.mcap
python tools/concept_figure.py beam.mcap docs/images/concepts.png
"""

import sys

import numpy as np

from plantar import Percept, Reading
from plantar.plotting import COLOURS, draw_cells, new_figure, save_figure
from plantar.recordings.recording import read_mcap

SHOWN = (6.0, 13.0)  # s of the walk
MOMENT = 10.6  # s at which the left sole is shown: it stands on the beam


def main(recording: str, path: str) -> None:
    """Draw it.

    Args:
        recording: MCAP file of the walk.
        path: PNG to write.
    """
    run = read_mcap(recording)
    plan = run.topics["/reference"]
    figure, (over_time, sole) = new_figure(9.5, 3.4, 1, 2, width_ratios=[2.4, 1.0])
    rows = (plan.time >= SHOWN[0]) & (plan.time <= SHOWN[1])
    for field, name, style in (("zmp", "VRP", "-"), ("dcm", "DCM", "--"), ("com", "CoM", "-.")):
        over_time.plot(plan.time[rows], plan.fields[field][rows, 1], style, label=name)
    over_time.set_xlabel("time [s]")
    over_time.set_ylabel("to the left [m]")
    over_time.grid(alpha=0.3)
    over_time.legend()
    layout, skin = run.layouts["left"], run.topics["/skin/left"]
    force = skin.fields["force"][np.searchsorted(skin.time, MOMENT)]
    percept = Percept(layout, Reading(MOMENT, force))
    cells = draw_cells(sole, layout, force, float(force.max()))
    figure.colorbar(cells, ax=sole, label="force on a taxel [N]")
    cop = percept.position_cop_in_sole
    if cop is not None:
        sole.plot(-cop[1], cop[0], "+", ms=14, mew=3, color=COLOURS["cop"])
    sole.set_aspect("equal")
    sole.axis("off")
    save_figure(figure, path)


if __name__ == "__main__":
    main(*sys.argv[1:])
