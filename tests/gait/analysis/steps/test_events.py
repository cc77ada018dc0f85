"""Heel strikes and toe offs against contacts that are known."""

from collections.abc import Callable
from typing import get_args

import numpy as np
import pytest

from plantar.gait.analysis.steps.events import Kind, find_contacts, force_levels, threshold_levels

from ..walks import two_humps


def steps(rate: float = 100.0, n: int = 5, peak: float = 700.0, rest: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Half-sine contacts of 0.6 s every second, from 0.2 s on."""
    time = np.arange(0.0, n, 1.0 / rate)
    phase = (time % 1.0 - 0.2) / 0.6
    force = np.where((phase > 0) & (phase < 1), (peak - rest) * np.sin(np.pi * np.clip(phase, 0, 1)), 0.0)
    return time, force + rest


@pytest.mark.parametrize("rate", [31.25, 75.0, 100.0, 250.0])
def test_half_sine_contacts_are_timed_between_samples(rate):
    time, force = steps(rate)
    levels = threshold_levels(force_levels(force), 35.0)
    contacts = find_contacts(time, force, levels)
    assert len(contacts) == 5
    late = 0.6 / np.pi * np.arcsin(levels.release / 700.0)  # where the half sine crosses the level
    for i, contact in enumerate(contacts):
        assert contact.heel_strike == pytest.approx(i + 0.2 + late, abs=0.25 / rate)
        assert contact.toe_off == pytest.approx(i + 0.8 - late, abs=0.25 / rate)


@pytest.mark.parametrize("scale", [0.05, 1.0, 20.0])
@pytest.mark.parametrize("rest", [0.0, 0.04])
def test_levels_follow_the_foot(scale, rest):
    time, force = steps(peak=700.0 * scale, rest=700.0 * scale * rest)
    assert [c.complete for c in find_contacts(time, force)] == [True] * 5
    for kind in get_args(Kind):
        found, usual = force_levels(force, kind), force_levels(force / scale, kind)
        assert found.release == pytest.approx(scale * usual.release)
        assert found.rest == pytest.approx(scale * usual.rest)


def toe_offs(course: Callable[[np.ndarray], np.ndarray], rate: float, stride: float) -> tuple[np.ndarray, np.ndarray]:
    """Toe offs found in insoles, and the ends of contacts over 62 % of each stride."""
    time = np.arange(0.0, 10.0 * stride, 1.0 / rate)
    share = (time - 0.137) % stride / (0.62 * stride)
    force = np.where((time > 0.137) & (share < 1.0), 700.0 * course(np.clip(share, 0.0, 1.0)), 0.0)
    levels = force_levels(force, "insole")
    contacts = [c for c in find_contacts(time, np.asarray(force, dtype=np.float64), levels) if c.complete]
    return np.array([c.toe_off for c in contacts]), 0.137 + 0.62 * stride + stride * np.arange(len(contacts))


@pytest.mark.parametrize("rate", [50.0, 100.0, 500.0])
@pytest.mark.parametrize("stride", [0.8, 1.1, 1.9])
@pytest.mark.parametrize(
    "course",
    [
        two_humps,
        lambda share: np.sin(np.pi * share),
        lambda share: np.clip(10.0 * np.minimum(share, 1.0 - share), 0, 1),
    ],
    ids=["walk", "half sine", "trapezium"],
)
def test_toe_off_from_an_insole_is_where_push_off_ends(course, rate, stride):
    """A foot that leaves slowly has left 10 ms after its force falls below makers' level, 13 % of the range."""
    found, end = toe_offs(course, rate, stride)
    share = np.linspace(0.0, 1.0, 10001)[:-1]
    force = np.asarray(course(share))
    below = share[np.flatnonzero(force >= 0.13 * np.percentile(force, 90.0))[-1]]
    early = max(0.0, (1.0 - float(below)) * 0.62 * stride - 0.010)
    assert len(found) >= 9
    assert np.abs(found - (end - early)).max() < 0.008


def test_what_a_shoe_presses_after_push_off_is_not_the_foot():
    def with_tail(share: np.ndarray) -> np.ndarray:
        """Push-off that would end at 0.9 of the contact, and 8 % of the peak until its end."""
        return np.asarray(np.maximum(np.clip(6.0 * np.minimum(share, 0.9 - share), 0.0, 1.0), 0.08 * (share < 1.0)))

    found, true = toe_offs(with_tail, 200.0, 1.1)
    early = 0.13 / 6.0 * 0.62 * 1.1 - 0.010  # at makers' level of 13 %, and 10 ms
    assert found == pytest.approx((true - 0.1 * 0.62 * 1.1 - early).tolist(), abs=0.004)


@pytest.mark.parametrize("stands", [2.0, 20.0, 300.0])
def test_levels_do_not_depend_on_how_long_someone_stands(stands):
    _, force = steps()
    alone = force_levels(force)
    before = np.concatenate([np.full(round(stands * 100.0), 350.0), force])
    found = force_levels(before)
    assert (found.peak, found.release) == pytest.approx((alone.peak, alone.release), rel=1e-9)
    assert sum(c.complete for c in find_contacts(np.arange(len(before)) * 0.01, before)) == 5


def test_a_single_leap_does_not_raise_the_levels_of_a_walk():
    _, force = steps(n=12)
    leap = force.copy()
    leap[500:600] *= 4.0
    before, after = force_levels(force), force_levels(leap)
    assert after.release == pytest.approx(before.release, rel=0.01)


def test_contacts_cut_by_the_ends_are_incomplete():
    time, force = steps()
    keep = (time >= 0.5) & (time < 4.5)
    contacts = find_contacts(time[keep], force[keep])
    assert [c.complete for c in contacts] == [False, True, True, True, False]
    assert contacts[0].heel_strike is None
    assert contacts[0].toe_off == pytest.approx(0.78, abs=0.02)
    assert contacts[-1].heel_strike == pytest.approx(4.22, abs=0.02)
    assert contacts[-1].toe_off is None


def test_standing_and_silence_have_no_complete_contact():
    time = np.arange(0.0, 10.0, 0.01)
    random = np.random.default_rng(0)
    assert find_contacts(time, np.zeros_like(time)) == []
    assert find_contacts(time, random.normal(0.0, 9.5, len(time))) == []
    assert find_contacts(time, np.maximum(random.normal(0.0, 9.5, len(time)), 0.0)) == []
    taxels = np.maximum(random.normal(0.0, 1.47, (len(time), 42)), 0.0)
    assert find_contacts(time, taxels.sum(axis=1)) == []  # a mean of 25 N from noise that is clipped at zero
    standing = find_contacts(time, 400.0 + random.normal(0.0, 9.5, len(time)))
    assert [(c.heel_strike, c.toe_off) for c in standing] == [(None, None)]
    assert find_contacts(time[:2], np.zeros(2)) == []
    assert find_contacts(time, np.full_like(time, np.nan)) == []


def test_a_short_loss_does_not_split_a_contact_and_a_brush_is_none():
    time, force = steps()
    force[(time > 2.48) & (time < 2.52)] = 0.0  # 40 ms within the third contact
    force[(time > 3.93) & (time < 3.97)] = 300.0  # 40 ms in swing
    assert len(find_contacts(time, force)) == 5


def test_a_light_landing_that_chatters_is_one_contact():
    """A touch, 90 ms of air, then 0.2 s of chatter that often stays below the contact level."""
    time = np.arange(0.0, 6.0, 0.004)
    random = np.random.default_rng(4)
    force = np.full(len(time), 400.0)
    force[(time > 1.0) & (time < 2.0)] = 0.0
    force[(time >= 2.004) & (time < 2.094)] = 0.0
    chatter = (time >= 2.1) & (time < 2.4)
    force[chatter] = random.uniform(0.0, 38.0, chatter.sum())  # the contact level is at 40 N
    force[time >= 2.4] = 150.0
    force[np.searchsorted(time, [2.1, 2.25])] = 60.0
    contacts = find_contacts(time, force)
    assert [(c.heel_strike is None, c.toe_off is None) for c in contacts] == [(True, False), (False, True)]
    assert contacts[1].heel_strike == pytest.approx(2.0, abs=0.004)


def test_a_spike_of_noise_in_swing_does_not_join_two_contacts():
    time, force = steps()
    force[(time > 2.98) & (time < 3.0)] = 50.0  # above the event level of 35 N, below the contact level of 70 N
    contacts = find_contacts(time, force)
    assert len(contacts) == 5
    assert contacts[3].heel_strike == pytest.approx(3.21, abs=0.01)


def test_dropouts_are_bridged_when_short_and_cut_when_long():
    time, force = steps()
    short, long = force.copy(), force.copy()
    short[(time > 2.46) & (time < 2.54)] = np.nan
    assert [c.complete for c in find_contacts(time, short)] == [True] * 5
    long[(time > 2.4) & (time < 2.6)] = np.nan
    contacts = find_contacts(time, long)
    assert [c.complete for c in contacts] == [True, True, False, False, True, True]
    # A filled zero would have made an event at the edge of the gap.
    assert contacts[2].toe_off is None
    assert contacts[3].heel_strike is None


def test_a_stretch_between_gaps_may_hold_no_contact():
    time, force = steps()
    force[(time > 2.0) & (time < 2.17)] = np.nan
    force[(time > 2.19) & (time < 2.9)] = np.nan  # leaves two frames of swing between the gaps
    assert [c.complete for c in find_contacts(time, force)] == [True] * 4


def test_one_damaged_frame_is_not_a_peak():
    time, force = steps()
    force[55] = 1e6
    assert [c.complete for c in find_contacts(time, force)] == [True] * 5


@pytest.mark.parametrize("clip", [False, True])
@pytest.mark.parametrize("seed", range(5))
def test_noisy_robot_soles_land_within_10_ms(walk, clip, seed):
    made = walk(steps=20, noise=1.4715, clip=clip, seed=seed)
    for side, foot in made.recording.feet.items():
        contacts = find_contacts(made.recording.time, foot.vertical_force)
        landings = [c.heel_strike for c in contacts if c.heel_strike is not None]
        truth = made.touchdowns[side]
        assert len(landings) == len(truth) == 10
        assert np.abs(np.array(landings) - truth).max() < 0.010
        assert sum(c.complete for c in contacts) == 9  # the last contact stands until the end
