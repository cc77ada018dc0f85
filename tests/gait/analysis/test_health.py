"""Silent cells and creeping gain are reported with the size of the error; healthy walks are not."""

from dataclasses import replace

import numpy as np
import pytest

from plantar.formats.nominal_insole import nominal_insole
from plantar.gait.analysis.health import (
    creep_doubts,
    scrambled_doubts,
    silent_cell_doubts,
    silent_cells,
    uneven_doubts,
)
from plantar.gait.analysis.metrics import metrics_of
from plantar.gait.analysis.parameters import analyse_feet
from plantar.gait.analysis.steps.baseline import without_baselines
from plantar.recordings.pressure_recording import FootRecording

from .test_activity import standing
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


def test_loads_that_differ_more_than_feet_do():
    recording = made_walk(strides=6, rate=50.0).recording
    parts = {s: np.array_split(foot.force, 5, axis=1) for s, foot in recording.feet.items()}
    few = {s: np.column_stack([part.sum(axis=1) for part in own]) for s, own in parts.items()}
    for cell, gain, told in (
        (0, 1.0, ""),
        (2, 0.1, "cell 3 carries"),
        (slice(None), 0.4, "the left foot carries no more than"),
    ):
        left = few["left"].copy()
        left[:, cell] *= gain
        feet = {s: FootRecording(s, left if s == "left" else few[s], None) for s in ("left", "right")}
        odd = replace(recording, feet=feet)
        notes = uneven_doubts(odd, analyse_feet(odd))
        assert all(told in note for note in notes[:1])
        assert bool(notes) == bool(told)


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


def with_forces(recording, change, raw=False):
    """The recording whose cells' forces (n, k) are changed, by side, without layouts."""
    feet = {s: replace(f, force=change(s, f.force), layout=None) for s, f in recording.feet.items()}
    return replace(recording, feet=feet, raw=raw)


def warnings_of(recording):
    clean = without_baselines(recording)
    return metrics_of(clean, analyse_feet(clean))["warnings"]


def few_cells(force):
    """Sums (n, 8) of a foot's cells from heel to toes, as eight FSRs read them."""
    return np.stack([part.sum(axis=1) for part in np.array_split(force, 8, axis=1)], axis=1)


@pytest.mark.parametrize("one_foot", [False, True])
@pytest.mark.parametrize(
    ("stride", "stance", "invert"),
    [
        (1.1, 0.62, lambda load: 1023.0 - 1.5 * load),
        (1.1, 0.62, lambda load: np.round(4095.0 - 3.0 * load.sum(axis=1, keepdims=True))),
        (1.1, 0.62, lambda load: 3.3 - 0.004 * load + np.random.default_rng(0).normal(0.0, 0.005, load.shape)),
        (1.6, 0.66, lambda load: 1023.0 - 1.5 * load),
        (0.7, 0.36, lambda load: 1023.0 - load),
    ],
)
def test_inverted_sensors_are_doubted(stride, stance, invert, one_foot):
    made = made_walk(strides=14, stride=stride, stance=stance).recording
    upright = with_forces(made, lambda side, force: few_cells(force), raw=True)
    inverted = with_forces(made, lambda side, force: invert(few_cells(force)), raw=True)
    for recording, expected in ((upright, 0), (inverted, 1)):
        given = replace(recording, feet={"left": recording.feet["left"]}) if one_foot else recording
        assert sum("the sensors may be inverted" in w for w in warnings_of(given)) == expected


@pytest.mark.parametrize("seconds", [8.0, 30.0])
@pytest.mark.parametrize("kind", ["still", "shift", "lift", "saturated"])
def test_upright_sensors_are_not_called_inverted(kind, seconds):
    """Standing, weight that goes from foot to foot, feet that are lifted in turns and sensors at their end."""
    made = standing(seconds)
    time = made.time
    for side, sign in (("left", 1.0), ("right", -1.0)):
        turn = sign * np.sin(2.0 * np.pi * time / 2.5)
        course = {
            "still": np.ones(len(time)),
            "shift": 1.0 + 0.5 * turn,
            "lift": 1.0 - np.clip(4.0 * (turn - 0.7), 0.0, 1.0) + np.clip(4.0 * (-turn - 0.7), 0.0, 1.0),
            "saturated": np.minimum(1.0 + 0.8 * turn, 1.3),
        }[kind]
        made.feet[side].force[:] *= course[:, None]
    assert not any("inverted" in w for w in warnings_of(made))


@pytest.mark.parametrize("stuck", [0.0, 20.0, 60.0, 100.0, 400.0])
@pytest.mark.parametrize("cell", [2, 5])
def test_a_dead_or_stuck_cell_of_few_is_named(cell, stuck):
    """What it lacks shows in the other foot, which has as many cells."""

    def broken(side, force):
        force = few_cells(force)
        if side == "left":
            force[:, cell] = stuck
        return force

    made = made_walk(strides=14).recording
    lines = warnings_of(with_forces(made, broken))
    (silent,) = [w for w in lines if "of 8 cells of the left foot read 0 throughout" in w]
    force = few_cells(made.feet["right"].force)
    lacking = 100.0 * force[:, cell].sum() / force.sum()
    assert f"other foot carry load ({cell + 1}): its forces are about {lacking:.2g} % too low" in silent
    assert sum(f"cell {cell + 1} of the left foot: what they read in swing" in w for w in lines) == (stuck > 0.0)
    assert not any("what each cell reads there is taken off" in w for w in lines)


@pytest.mark.parametrize("order", [1, -1])
def test_cells_at_the_edge_and_in_another_order_are_not_called_dead(order):
    """Both feet have as many cells that never carry."""

    def edged(side, force):
        return np.insert(few_cells(force), [0, 2], 0.0, axis=1)[:, :: order if side == "left" else 1]

    lines = warnings_of(with_forces(made_walk(strides=14, offset=1.0).recording, edged))
    assert not any("read 0 throughout" in w for w in lines)
