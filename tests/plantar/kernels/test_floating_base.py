"""The kernel of the floating base against the same equations in numpy, and its compiled form against its source."""

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from plantar import InputError, kernels
from plantar.kernels.gait import floating_base, gyro_bias, push_filter
from plantar.kernels.mechanics import rotations
from plantar.mechanics.rotation import heading, orthonormalised, rotation_from_vector, sine_vector
from plantar.mechanics.zmp import zmp_of_feet

OMEGA, PERIOD, GRAVITY = 3.5, 0.005, 9.81
AVERAGING, TILT, YAW, BANDWIDTH, LEAST = GAINS = (0.02, 0.1, 1.0, 10.0, 40.0)
SOURCES = {name: kernels.python_form(name) for name in ("rotations", "gyro_bias", "floating_base")}
EXACT = {"rtol": 1e-13, "atol": 1e-13}


def base_of(module, *identifies):
    """A base with its state, and what identifies its gyro's bias."""
    shapes = ((3, 3), (3,), (3,), (3,), (2, 3), (2, 3, 3), (2,), (3,))
    state = [np.zeros(shape) for shape in shapes]
    return module.FloatingBase(OMEGA, PERIOD, GRAVITY, GAINS, state, *identifies), state


def ticks(seed, count=60):
    """What comes in, tick by tick: postures, IMU, plan, loads and centres of pressure, feet in the air among them."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        turns = Rotation.from_rotvec(0.3 * rng.normal(size=(2, 3))).as_matrix()
        posture = (rng.normal(size=3), *rng.normal(size=(2, 3)), *turns)
        loads = rng.choice([0.0, 30.0, 1.0], 2) * rng.uniform(1.0, 20.0, 2)
        cops = [rng.normal(size=2) if load > 0.0 and rng.random() < 0.9 else None for load in loads]
        specific = np.array([0.0, 0.0, GRAVITY]) + rng.choice([0.1, 3.0]) * rng.normal(size=3)
        planned = rng.normal(size=2) if rng.random() < 0.7 else None
        missed = 1e-3 * rng.normal(size=3) if rng.random() < 0.3 else None
        yield posture, rng.normal(size=3), specific, planned, loads.tolist(), cops, missed, rng.normal(size=2).tolist()


def take(base, posture, loads, cops):
    """Hand over a posture and what the feet carry."""
    for side, (load, cop) in enumerate(zip(loads, cops, strict=True)):
        base.carry(side, load, cop is not None, *((math.nan, math.nan) if cop is None else cop.tolist()))
    base.watch(*posture)


class Reference:
    """The same in numpy, tick by tick from the state that the kernel had."""

    def __init__(self):
        self.samples, self.astray, self.headings = 0, 0.0, [None, None]

    def turned(self, rotation, posture, rate, specific, planned, loads, by_legs, missed):
        rate = rate.copy()
        up = rotation @ specific
        if planned is not None:
            up[:2] -= planned
        size = float(np.linalg.norm(up))
        if 0.2 * GRAVITY < size < 3.0 * GRAVITY:
            self.samples += 1
            since = PERIOD * (self.samples + 1)
            gain = 1.0 / since if since < AVERAGING else TILT
            rate += gain * rotation.T @ np.cross(up / GRAVITY, [0.0, 0.0, 1.0])
        if by_legs:
            self.astray -= 0.0 if missed is None else float(rotation[2] @ missed)
            error = self.astray
            self.astray -= PERIOD * YAW * error
        else:
            error = self.heading_error(rotation, posture, loads)
        rate -= YAW * error * rotation[2]
        return orthonormalised(rotation @ rotation_from_vector(PERIOD * rate))

    def heading_error(self, rotation, posture, loads):
        total = error = 0.0
        for k, load in enumerate(loads):
            if load <= LEAST:
                self.headings[k] = None
                continue
            yaw = heading(rotation @ posture[3 + k])
            if self.headings[k] is None:
                self.headings[k] = yaw
            error += (load - LEAST) * math.remainder(yaw - self.headings[k], 2.0 * math.pi)
            total += load - LEAST
        return error / total if total else 0.0


@pytest.mark.parametrize("by_legs", [False, True])
@pytest.mark.parametrize("seed", range(4))
def test_a_tick_is_that_of_the_equations(seed, by_legs):
    base, (rotation, position, com, velocity, places, turns, zmp, _) = base_of(floating_base)
    reference, past = Reference(), None
    for posture, rate, specific, planned, loads, cops, missed, push in ticks(seed):
        old, at, center, speed = rotation.copy(), position.copy(), com.copy(), velocity.copy()
        take(base, posture, loads, cops)
        base.take()
        if past is None:
            old, at = Rotation.from_rotvec([0.1, 0.2, 0.3]).as_matrix(), np.array([0.1, 0.2, 0.8])
            base.stand(old, at, 0.5, 0.6)
            np.testing.assert_allclose(com, at + old @ posture[0], **EXACT)
            reference.headings, past = [0.5, 0.6], posture
            continue
        base.turn(rate, specific, planned, by_legs, missed)
        np.testing.assert_allclose(
            rotation, reference.turned(old, posture, rate, specific, planned, loads, by_legs, missed), **EXACT
        )
        base.move()
        points = [(k, loads[k] - LEAST, c) for k, c in enumerate(cops) if c is not None and loads[k] > LEAST]
        moves = [
            old @ (past[1 + k] + past[3 + k][:, :2] @ c) - rotation @ (posture[1 + k] + posture[3 + k][:, :2] @ c)
            for k, _, c in points
        ]
        step = np.average(moves, axis=0, weights=[w for _, w, _ in points]) if points else PERIOD * speed
        np.testing.assert_allclose(position, at + step, **EXACT)
        carried = base.place()
        for k in range(2):
            np.testing.assert_allclose(places[k], position + rotation @ posture[1 + k], **EXACT)
            np.testing.assert_allclose(turns[k], rotation @ posture[3 + k], **EXACT)
        cop = [None if c is None else (places[k] + turns[k][:, :2] @ c)[:2] for k, c in enumerate(cops)]
        weights = [0.0 if c is None else load for c, load in zip(cops, loads, strict=True)]  # no point, no part in it
        expected = zmp_of_feet(cop, weights)
        carries = carried is not None
        assert carries == (expected is not None)
        assert not carries or np.array_equal(carried, zmp)
        np.testing.assert_allclose(zmp, [np.nan] * 2 if expected is None else expected, **EXACT)
        base.observe(*push)
        wanted = OMEGA**2 * (center[:2] - expected) if carries else np.zeros(2)
        acceleration = np.array([*(wanted + push), 0.0])
        error = position + rotation @ posture[0] - center - PERIOD * speed
        np.testing.assert_allclose(com, center + PERIOD * speed + 2.0 * BANDWIDTH * PERIOD * error, **EXACT)
        np.testing.assert_allclose(velocity, speed + PERIOD * acceleration + BANDWIDTH**2 * PERIOD * error, **EXACT)
        past = posture
    base.rest()
    assert not velocity.any()


@pytest.mark.parametrize("by_legs", [False, True])
def test_both_forms_agree_to_the_last_bit(by_legs):
    found = []
    for module in (floating_base, SOURCES["floating_base"]):
        base, state = base_of(module)
        first = True
        for posture, rate, specific, planned, loads, cops, missed, push in ticks(9, 30):
            take(base, posture, loads, cops)
            base.take()
            if first:
                base.stand(np.eye(3), np.zeros(3), 0.0, 0.0)
            else:
                base.stand_still(*loads)
                base.turn(rate, specific, planned, by_legs, missed)
                base.move()
            base.place()
            base.observe(*push)
            first = False
        found.append(np.concatenate([x.ravel() for x in state]))
    assert np.array_equal(*found, equal_nan=True)


def bias_of(module):
    """A gyro's bias, which takes in pieces of three ticks, and which feet it goes by."""
    value, missed = np.zeros(3), np.zeros(3)
    bias = module.GyroBias(PERIOD, 0.01, 0.05, 3, 6e-4, 0.1, 6, value, missed)
    return bias, module.SteadyLoad(0.8, 0.02, 40.0), value, missed


@pytest.mark.parametrize("identifies", [False, True])
def test_a_tick_in_one_call_is_its_steps(identifies):
    """The kernel as it runs against its steps, called one by one; the source of both against the compiled form."""
    found = []
    for module, bias_module in ((floating_base, gyro_bias), (SOURCES["floating_base"], SOURCES["gyro_bias"])):
        bias, steady, *_ = bias_of(bias_module)
        whole, state = base_of(module, *((bias, steady) if identifies else ()))
        parts, apart = base_of(module)
        other, other_steady, value, missed = bias_of(bias_module)
        for base in (whole, parts):
            base.stand(np.eye(3), np.zeros(3), 0.0, 0.0)
        for posture, rate, specific, planned, loads, cops, _, push in ticks(5):
            planned = np.zeros(2) if planned is None else planned
            for base in (whole, parts):
                take(base, posture, loads, cops)
            carried = whole.follow(*rate.tolist(), *specific.tolist(), *planned.tolist())
            parts.take()
            if identifies:
                other_steady.update(*(max(0.0, load - LEAST) for load in loads))
                still = other_steady.left, other_steady.right
                stands = parts.stand_still(*still)
                other.update(*rate.tolist(), stands, *apart[7].tolist(), min(still) > 0.0)
                rate = rate - value
            parts.turn(rate, specific, planned, identifies, missed if other.concluded else None)
            parts.move()
            apart_carried = parts.place()
            assert (carried is None) == (apart_carried is None)
            assert carried is None or np.array_equal(carried, apart_carried)
            for base in (whole, parts):
                base.observe(*push)
            assert all(np.array_equal(a, b, equal_nan=True) for a, b in zip(state, apart, strict=True))
            kept = [*state[:4], *state[4], *state[5]]
            assert all(np.array_equal(a, b) and a is not b for a, b in zip(whole.snapshot(), kept, strict=True))
        found.append(np.concatenate([x.ravel() for x in state]))
    assert np.array_equal(*found, equal_nan=True)


def test_what_is_not_finite_is_refused():
    for module in (floating_base, SOURCES["floating_base"]):
        base, _ = base_of(module)
        base.carry(0, 300.0, True, math.nan, 0.0)
        with pytest.raises(InputError, match=r"the ZMP or the vertical force of a foot is not finite"):
            base.place()


@pytest.mark.parametrize("weights", [(300.0, 100.0), (0.0, 50.0), (50.0, -1.0), (0.0, 0.0), (math.nan, 10.0)])
def test_the_mean_turn_of_soles_is_their_sine(weights):
    a, b, c, d = Rotation.from_rotvec(np.random.default_rng(0).normal(size=(4, 3))).as_matrix()
    told = []
    for module in (floating_base, SOURCES["floating_base"]):
        base, (*_, found) = base_of(module)
        for pair in ((a, b), (c, d)):
            base.watch(*np.zeros((3, 3)), *pair)
            base.take()
        assert base.stand_still(*weights) == any(w > 0.0 for w in weights)
        told.append(found)
    assert np.array_equal(*told)
    each = [w * sine_vector(x @ y.T) for w, x, y in zip(weights, (a, b), (c, d), strict=True) if w > 0.0]
    total = sum(w for w in weights if w > 0.0)
    np.testing.assert_allclose(found, np.sum(each, axis=0) / total if each else np.zeros(3), **EXACT)


@pytest.mark.parametrize("size", [0.0, 1e-9, 1e-6, 0.3, 3.0, 7.0])
def test_rotations_are_those_of_scipy(size):
    rng = np.random.default_rng(1)
    v, w = rng.normal(size=(2, 3))
    v *= size / np.linalg.norm(v)
    r = Rotation.from_rotvec(v).as_matrix()
    for module in (rotations, SOURCES["rotations"]):
        out, again, work, vector = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3)), np.empty(3)
        module.exponential(*v.tolist(), out)
        np.testing.assert_allclose(out, r, atol=1e-15)
        module.turn(r, w, vector)
        np.testing.assert_allclose(vector, r @ w, **EXACT)
        module.turn_back(r, w, vector)
        np.testing.assert_allclose(vector, r.T @ w, **EXACT)
        module.multiply(r, r, again)
        np.testing.assert_allclose(again, r @ r, **EXACT)
        module.orthonormalise(r + 1e-6 * w, work, again)
        np.testing.assert_allclose(again, orthonormalised(r + 1e-6 * w), **EXACT)


@pytest.mark.parametrize("seed", range(3))
def test_a_whole_tick_is_its_parts(seed):
    """`load`, `step` and `settle` against `carry`, `follow`, the feet's heights, a low pass and `observe`."""
    mu = 0.07
    turning = 0.3
    same = 0.4
    share = 0.02
    forms = (floating_base, SOURCES["floating_base"])
    filters = (push_filter, kernels.python_form("push_filter"))
    pushes = [module.PushFilter(0.4, 0.15, 0.05) for module in filters]
    made = [
        base_of(form, None, None, push, (mu, turning), (same, share)) for form, push in zip(forms, pushes, strict=True)
    ]
    plain, state = base_of(floating_base)
    low = np.zeros(2)
    acts = False
    heights = [math.nan, math.nan]
    rng = np.random.default_rng([seed, 1])
    acted = set()
    for posture, gyro, specific, planned, loads, cops, _, _ in ticks(seed):
        plan = np.zeros(2) if planned is None else planned
        swing = rng.normal(size=2)
        felt = rng.normal(size=2) if rng.random() < 0.2 else None
        base_acceleration = (plan - mu * swing) / (1.0 - 2.0 * mu)
        tare = 5.0 * rng.random()
        carried = [max(0.0, load - tare) for load in loads]
        take(plain, posture, carried, [np.zeros(2) if cop is None else cop for cop in cops])
        for side, cop in enumerate(cops):
            if cop is None:
                plain.carry(side, carried[side], False, 0.0, 0.0)
        zmp = plain.follow(*gyro, *specific, *base_acceleration)
        error = 0.0
        total = 0.0
        for side in range(2):
            weight = carried[side] - LEAST
            z = state[4][side, 2]
            if weight <= 0.0:
                heights[side] = math.nan
                continue
            if math.isnan(heights[side]):
                other = heights[1 - side]
                rise = z - state[4][1 - side, 2]
                heights[side] = z if math.isnan(other) else other if abs(rise) < same else other + rise
            error = error + weight * (z - heights[side])
            total = total + weight
        state[1][2] -= share * error / total if total > 0.0 else 0.0
        if zmp is None:
            low = np.zeros(2)
            acts = False
        else:
            pendulum = OMEGA**2 * (state[2][:2] - zmp) + turning * swing
            low = low + 0.4 * ((state[0] @ specific)[:2] - (base_acceleration - plan) - pendulum - low)
            acts = math.hypot(*low) > (0.05 if acts else 0.15)
        acted.add(acts)
        plain.observe(*(turning * swing + (felt if felt is not None else acts * low)))
        for (base, own), push in zip(made, pushes, strict=True):
            base.watch(*posture)
            assert [base.load(i, loads[i], tare, cops[i]) for i in range(2)] == carried
            found = base.step(gyro, specific, plan, swing)
            base.settle(specific, plan, swing, felt)
            assert (found is None) == (zmp is None)
            assert push.acts == acts
            np.testing.assert_allclose([push.x, push.y], low, **EXACT)
            for mine, wanted in zip(own, state, strict=True):
                np.testing.assert_allclose(mine, wanted, **EXACT)
    assert acted == {False, True}
