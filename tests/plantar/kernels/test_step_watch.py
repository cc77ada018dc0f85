"""The kernels of the judge, which follow each physics step, against plain counting; both forms."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from plantar.kernels import python_form
from plantar.kernels.contacts import foot_contacts, ground_reaction
from plantar.kernels.judging import applied_forces, estimate_error, joint_extremes, stance_force, step_watch

MODULES = (foot_contacts, ground_reaction, joint_extremes, stance_force, applied_forces, step_watch, estimate_error)
NAMES = tuple(module.__name__.split(".")[-1] for module in MODULES)
COMPILED = SimpleNamespace(**dict(zip(NAMES, MODULES, strict=True)))
PYTHON = SimpleNamespace(**{name: python_form(name) for name in NAMES})
FORMS = pytest.mark.parametrize("forms", [COMPILED, PYTHON], ids=["compiled", "python"])
REACH = 5e-4
GROUND = np.array([0, 0, 1, 0], dtype=np.uint8)  # the feet are geoms 0 and 1, the ground 2, another leg 3
TILTED, LOWEST = math.cos(math.radians(40.0)), 0.5
WINDOWS = (30, 20, 60)


@FORMS
def test_a_stand_is_where_it_carried_last_and_slips_from_where_it_did_first(forms):
    rng, watch = np.random.default_rng(1), forms.stance_force.StandWatch(100.0)
    first, stands, slip = [None, None], [[None], [None]], 0.0
    for step in range(1, 3000):
        foot = int(rng.integers(2))
        if rng.random() < 0.01:
            watch.begin(foot, step)
            first[foot] = None
            stands[foot].append((step, foot))
        force = float(rng.choice([99.9, 100.0, 400.0, np.nan]))
        x, y, yaw = rng.normal(size=3).tolist()
        watch.carry(foot, force, x, y, yaw)
        if force >= 100.0:
            first[foot] = first[foot] or (x, y)
            if stands[foot][-1] is not None:
                stands[foot][-1] = (*stands[foot][-1][:2], x, y, yaw)
            slip = max(slip, math.dist(first[foot], (x, y)))
        assert watch.slip == pytest.approx(slip, rel=1e-14)
    wanted = sorted(s for side in stands for s in side[1:] if len(s) == 5)
    assert watch.stands() == wanted
    assert len(wanted) > 10


@FORMS
def test_the_first_stand_slips_too(forms):
    watch = forms.stance_force.StandWatch(100.0)
    watch.carry(0, 400.0, 0.0, 0.0, 0.0)
    watch.carry(0, 400.0, 0.034, 0.0, 0.0)
    watch.begin(0, 7)
    watch.carry(0, 400.0, 0.2, 0.0, 0.0)
    assert watch.slip == 0.034
    assert watch.stands() == [(7, 0, 0.2, 0.0, 0.0)]


@FORMS
def test_extremes_and_limits_are_those_of_all_steps(forms):
    rng = np.random.default_rng(4)
    speeds, torques = np.zeros(9), np.zeros(12)
    places, servos = rng.permutation(9)[:6], rng.permutation(12)[:6]
    limits = np.array([10.0, 20.0, np.inf, 5.0, 8.0, 40.0])
    joints = forms.joint_extremes.JointExtremes(speeds, places, 1.0 / limits, torques, servos, 1.0 / (1.5 * limits))
    rows, loads = [], []
    for _ in range(400):
        speeds[:] = 0.9 * speeds + rng.normal(0.0, 3.0, 9)
        torques[:] = 0.9 * torques + rng.normal(0.0, 4.0, 12)
        joints.step()
        rows.append(speeds[places])
        loads.append(torques[servos])
    shares, held = np.abs(rows) / limits, np.abs(loads) * (1.0 / (1.5 * limits)) >= 1.0
    assert np.array_equal(joints.high, np.max([np.zeros(6), *rows], axis=0))
    assert np.array_equal(joints.low, np.min([np.zeros(6), *rows], axis=0))
    assert np.array_equal(joints.longest, [max(map(len, runs_of(column))) for column in shares.T > 1.0])
    assert np.array_equal(joints.held, held.sum(axis=0))
    assert joints.any_held == held.any(axis=1).sum()
    assert joints.steps == 400


def runs_of(flags):
    """Indices of each run of what is true; one empty run at least."""
    runs = [[]]
    for k, flag in enumerate(flags):
        if flag:
            runs[-1].append(k)
        elif runs[-1]:
            runs.append([])
    return runs


@FORMS
def test_what_is_no_number_is_beyond_a_limit(forms):
    speeds, torques, every = np.array([np.nan]), np.array([np.nan]), np.array([0])
    joints = forms.joint_extremes.JointExtremes(speeds, every, np.array([0.1]), torques, every, np.array([0.1]))
    joints.step()
    assert math.isnan(joints.high[0])
    assert (joints.longest[0], joints.held[0]) == (1, 1)


def foot_of(forms, rng, own):
    """A foot with up to 6 contacts somewhere: with the ground, or with another leg."""
    k = int(rng.integers(0, 7))
    vectors = np.zeros((3 * k, 3))
    vectors[::3], vectors[1::3] = rng.normal(0.0, 0.1, (k, 3)), rng.uniform([-9, -9, 0], [9, 9, 99], (k, 3))
    ids = np.column_stack([np.full(k, own), rng.choice([2, 2, 2, 3, -1], k)]).astype(np.int32)
    foot = forms.foot_contacts.FootContacts(np.zeros(1, dtype=np.uint8))
    foot.take(ids, vectors, np.zeros(k), np.ones(k, dtype=np.uint8))
    grounded = ids[:, 1] != 3
    alone = forms.foot_contacts.FootContacts(np.zeros(1, dtype=np.uint8))
    alone.take(
        ids[grounded],
        vectors.reshape(-1, 3, 3)[grounded].reshape(-1, 3),
        np.zeros(grounded.sum()),
        np.ones(grounded.sum(), dtype=np.uint8),
    )
    return foot, alone, float(vectors[1::3, 2][grounded].sum())


class Follower:
    """The kernel on a made-up run, and what plain Python finds."""

    def __init__(self, forms, seed):
        self.forms, self.rng = forms, np.random.default_rng(seed)
        self.reaction = forms.ground_reaction.GroundReaction(math.nan, 50.0, REACH, GROUND)
        self.other = forms.ground_reaction.GroundReaction(math.nan, 50.0, REACH)
        self.upright, self.center, self.legs = np.eye(3).ravel(), np.zeros(3), np.zeros(1)
        self.places, self.turns = np.zeros((2, 3)), np.zeros((2, 9))
        self.warnings = np.zeros((8, 2), dtype=np.int32)[:, 1]
        self.stands = forms.stance_force.StandWatch(100.0)
        joints = forms.joint_extremes.JointExtremes(*[np.zeros(1), np.zeros(1, dtype=np.intp), np.ones(1)] * 2)
        stance = forms.stance_force.StanceForce(self.reaction, self.center, 80.0, 9.81, 1e-3, (2, 5), 20.0, 2e-3)
        self.events = np.random.default_rng([seed, 1])
        self.applied = np.zeros((4, 6))
        self.known = np.zeros((4, 6))
        axes = np.zeros(3)
        own = np.array([0, 2])
        self.watch = forms.step_watch.StepWatch(
            self.reaction,
            self.stands,
            joints,
            stance,
            forms.applied_forces.AppliedForces(self.applied, self.known, axes, own, np.zeros(6), 1e-9),
            self.upright,
            self.center,
            list(self.places),
            list(self.turns),
            self.legs,
            self.warnings,
            np.array([5, 6]),
            20.0,
            WINDOWS,
            (TILTED, LOWEST),
        )
        self.landings, self.last, self.margin, self.up = [], [0, 0], math.inf, 1.0

    def step(self, now, in_air):
        """One step, with feet that are in the air or not."""
        rng = self.rng
        self.upright[8], self.center[:] = rng.uniform(0.75, 1.0), rng.normal([0.0, 0.0, 0.8], 0.1)
        self.places[:], self.turns[:] = rng.normal(0.0, 0.1, (2, 3)), rng.normal(size=(2, 9))
        self.legs[:] = rng.choice([0.0, 0.0, 1.0])
        drawn = [foot_of(self.forms, rng, own) for own in range(2)]
        for (foot, alone, _), up in zip(drawn, in_air, strict=True):
            if up:
                foot.clear()
                alone.clear()
        loads = [0.0 if up else load for (*_, load), up in zip(drawn, in_air, strict=True)]
        feet = tuple(foot for foot, _, _ in drawn)
        more = int(self.events.choice([0, 0, 1]))
        stood_for = bool(self.events.integers(2))
        self.applied[2, 1] = 3.0
        self.known[2, 1] = 3.0 * stood_for
        seen = self.watch.step(feet, sum(foot.size for foot in feet) + more)
        self.other.update(tuple(alone for _, alone, _ in drawn))
        wanted = self.forms.step_watch.LEGS * int(self.legs[0]) + self.forms.step_watch.OTHERS * more
        if not stood_for:
            wanted += self.forms.step_watch.OUTSIDE
        if self.upright[8] < TILTED or self.center[2] - self.places[:, 2].min() < LOWEST:
            wanted += self.forms.step_watch.FALLING
        for foot in range(2):
            if loads[foot] >= 20.0:
                if now - self.last[foot] > WINDOWS[0]:
                    wanted += 1 + foot
                    self.landings.append([now, foot, 0.0, 0.0, math.inf])
                self.last[foot] = now
        assert seen == wanted
        assert list(self.reaction.loads) == pytest.approx(loads, abs=1e-9)
        _, _, _, depth, _ = self.other.found_now()
        if depth is not None:
            self.margin = min(self.margin, depth)
            if self.landings:
                self.landings[-1][4] = min(self.landings[-1][4], depth)
        self.up = min(self.up, self.upright[8])
        for foot in range(2):
            mine = [row for row in self.landings if row[1] == foot]
            if mine and now - mine[-1][0] <= WINDOWS[1]:
                mine[-1][2] = max(mine[-1][2], loads[foot])
            if mine and now - mine[-1][0] <= WINDOWS[2]:
                mine[-1][3] = max(mine[-1][3], self.other.area(foot))


def followed(forms, seed):
    run = Follower(forms, seed)
    up = [0, 0]
    for now in range(1, 1200):
        for foot in range(2):
            if up[foot] <= 0 and run.rng.random() < 0.01:
                up[foot] = int(run.rng.choice([10, 45]))
            up[foot] -= 1
        run.step(now, [n > 0 for n in up])
    return run


@FORMS
@pytest.mark.parametrize("seed", range(2))
def test_each_step_is_what_plain_python_finds(forms, seed):
    """Only the ground counts: a leg that presses on a foot changes no force, margin or area."""
    run = followed(forms, seed)
    assert (run.watch.margin, run.watch.up) == (pytest.approx(run.margin, abs=1e-12), run.up)
    assert len(run.landings) > 5
    for found, wanted in zip(run.watch.landings(), run.landings, strict=True):
        assert list(found) == pytest.approx(wanted, abs=1e-9)


def test_the_two_forms_agree_to_the_last_bit():
    one, other = (followed(forms, 7) for forms in (COMPILED, PYTHON))
    assert one.watch.landings() == other.watch.landings()
    assert (one.watch.margin, one.watch.up) == (other.watch.margin, other.watch.up)
    assert one.stands.stands() == other.stands.stands()
    assert one.stands.slip == other.stands.slip


@FORMS
def test_a_state_that_diverged_is_reported(forms):
    run = Follower(forms, 0)
    run.center[2] = 0.8
    nobody = tuple(forms.foot_contacts.FootContacts(np.zeros(1, dtype=np.uint8)) for _ in range(2))
    run.warnings[4] = 3  # of something else
    assert run.watch.step(nobody, 0) == 0
    run.warnings[6] = 1
    assert run.watch.step(nobody, 0) == forms.step_watch.DIVERGED


@FORMS
@pytest.mark.parametrize("value", [3.0, -2e-9, math.nan, math.inf])
def test_any_force_that_is_not_known_is_found(forms, value):
    on_bodies = np.zeros((5, 6))
    known = np.zeros((5, 6))
    on_joints = np.zeros(7)
    springs = np.zeros(6)
    applied = forms.applied_forces.AppliedForces(on_bodies, known, on_joints, np.array([1, 4]), springs, 1e-9)
    assert not applied.sprung()
    springs[5] = value
    assert applied.sprung()
    assert not applied.unknown()
    for place in np.ndindex(5, 6):
        on_bodies[place] = value
        assert applied.unknown()
        if math.isfinite(value):
            known[place] = value
            assert not applied.unknown()
            assert not known.any()  # what was known counts for one step
            assert applied.unknown()
        on_bodies[place] = 0.0
    for axis in range(7):
        on_joints[axis] = value
        assert applied.unknown() == (axis in (1, 4))
        on_joints[axis] = 0.0


@FORMS
def test_estimates_are_compared_with_the_truth(forms):
    rng, center = np.random.default_rng(3), np.zeros(3)
    reaction = forms.ground_reaction.GroundReaction(math.nan, 50.0, REACH, GROUND)
    error = forms.estimate_error.EstimateError(center, reaction)
    most, squares = np.zeros(3), []
    for _ in range(300):
        reaction.update(tuple(foot_of(forms, rng, own)[0] for own in range(2)))
        center[:], com = rng.normal(size=3), rng.normal(size=3)
        zmp = None if rng.random() < 0.3 else rng.normal(size=2).tolist()
        error.update(com.tolist(), zmp)
        most = np.maximum(most, np.abs(com - center))
        if zmp is not None and reaction.found:
            squares.append((zmp[0] - reaction.x) ** 2 + (zmp[1] - reaction.y) ** 2)
    assert np.array_equal(error.com, most)
    assert error.compared == len(squares)
    assert error.squares == pytest.approx(sum(squares), rel=1e-12)
    error.update([math.nan, 0.0, 0.0], None)
    assert math.isnan(error.com[0])
