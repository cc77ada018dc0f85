"""Silent cells and creeping gain are reported with the size of the error; healthy walks are not."""

from dataclasses import replace

import numpy as np
import pytest

from plantar.gait.analysis.health import creep_doubts, silent_cell_doubts, silent_cells
from plantar.gait.analysis.parameters import analyse_feet

from .walks import made_walk


@pytest.mark.parametrize("share", [0.1, 0.3])
def test_silent_cells_and_what_they_lack(share):
    recording = made_walk(strides=5, rate=50.0).recording
    foot = recording.feet["left"]
    random = np.random.default_rng(1)
    dead = random.choice(99, round(share * 99), replace=False)
    force = foot.force.copy()
    force[:, dead] = 0.0
    broken = replace(recording, feet={**recording.feet, "left": replace(foot, force=force)})
    found = silent_cells(broken.feet["left"], broken.feet["right"])
    assert set(found.cells.tolist()) <= set(dead.tolist())
    lost = 1.0 - force.sum() / foot.force.sum()
    assert found.missing == pytest.approx(lost, rel=0.35)
    assert any("% too low" in line for line in silent_cell_doubts(broken))
    assert silent_cell_doubts(recording) == []


def test_gain_that_creeps():
    gains = np.linspace(1.0, 1.3, 20)
    for side_gains, expected in ((gains, 2), (None, 0)):
        feet = analyse_feet(made_walk(strides=20, rate=50.0, gains=side_gains).recording)
        lines = creep_doubts(feet)
        assert len(lines) == expected
        assert all("gain creeps" in line for line in lines)
