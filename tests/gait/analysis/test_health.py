"""Silent cells and creeping gain are reported with the size of the error; healthy walks are not."""

from dataclasses import replace

import numpy as np
import pytest

from plantar.formats.nominal_insole import nominal_insole
from plantar.gait.analysis.health import creep_doubts, scrambled_doubts, silent_cell_doubts, silent_cells
from plantar.gait.analysis.parameters import analyse_feet

from .vendor_texts import matrix_insoles
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


def test_half_a_sole_that_is_silent_shows_by_the_other_foot():
    """The cells of two equal matrices mirror each other by place, not by number."""
    recording = made_walk(strides=3, rate=50.0, layouts=matrix_insoles(24, 8, 0.011)).recording
    foot = recording.feet["left"]
    force = np.where(foot.layout.positions[:, 0] > 0.12, 0.0, foot.force)
    (line,) = silent_cell_doubts(replace(recording, feet={**recording.feet, "left": replace(foot, force=force)}))
    assert "of the left foot read 0 throughout" in line


@pytest.mark.parametrize(
    "layouts", [matrix_insoles(24, 8, 0.011), {s: nominal_insole("x", s) for s in ("left", "right")}]
)
def test_cells_in_another_order_than_the_layout(layouts):
    recording = made_walk(strides=3, rate=50.0, noise=0.5, layouts=layouts).recording
    assert scrambled_doubts(recording) == []
    foot = recording.feet["left"]
    order = np.argsort(np.arange(foot.force.shape[1]) % 9, kind="stable")  # as if written column by column
    mixed = {**recording.feet, "left": replace(foot, force=foot.force[:, order])}
    (line,) = scrambled_doubts(replace(recording, feet=mixed))
    assert "neighbouring cells of the left foot" in line
