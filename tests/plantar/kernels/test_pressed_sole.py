"""The kernel of a sole that several things press on: both forms, and against one load at a time."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plantar import hex_layout
from plantar.kernels import compiled, python_form
from plantar.kernels.contacts.foot_contacts import ContactsInSole, FootContacts
from plantar.kernels.contacts.pressed_sole import PressedSole
from plantar.sim.sensing import sole_pressure
from plantar.sim.sensing.sole_pressure import SolePressure

from ...examples import examples

LAYOUT = hex_layout([[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]], cell_area=600e-6)
REACH = 5e-4
seeds = st.integers(0, 2**32 - 1)


def contacts(seed: int):
    """Contacts of a sole with up to three pieces of ground, in the sole frame, which stay in place as loads change."""
    rng = np.random.default_rng(seed)
    k = int(rng.integers(1, 30))
    ids = np.column_stack([np.zeros(k, int), rng.integers(1, 4, k)]).astype(np.int32)
    positions = rng.uniform([-0.1, -0.05, -1e-3], [0.1, 0.05, 1e-3], (k, 3))
    for _ in range(4):
        vectors = np.zeros((3 * k + 2, 3))
        carries = rng.random(k) < 0.7
        vectors[: 3 * k : 3] = positions + rng.normal(0.0, 1e-7, (k, 3))
        vectors[1 : 3 * k : 3] = carries[:, None] * rng.normal([0.0, 0.0, 50.0], 20.0, (k, 3))
        vectors[2 : 3 * k : 3] = carries[:, None] * rng.normal(0.0, 0.1, (k, 3))
        yield ids, vectors, rng.uniform(-REACH, 3.0 * REACH, k), carries.astype(np.uint8)


def foot_of(ids, vectors, gaps, carries, module=None):
    foot = (FootContacts if module is None else module.FootContacts)(np.zeros(1, dtype=np.uint8))
    foot.take(ids, vectors[: 3 * len(gaps)], gaps, carries)
    return foot


@given(seeds)
def test_all_contacts_at_once_carry_what_each_pair_carries_alone(seed):
    together, alone = SolePressure(LAYOUT), SolePressure(LAYOUT)
    for ids, vectors, gaps, carries in contacts(seed):
        foot = foot_of(ids, vectors, gaps, carries)
        wanted = np.zeros(len(LAYOUT))
        for force, about_x, about_y, points in foot.pair_loads(vectors, REACH):
            if force > 0.0:
                wanted += alone.spread(points, force, (-about_y / force, about_x / force))
        assert np.array_equal(together.springs.press(foot, vectors, REACH), wanted)


@pytest.mark.skipif(not compiled, reason="without a compiler there is one form only")
@examples(20)
@given(seeds)
def test_the_two_forms_agree_to_the_last_bit(seed):
    compiled, other = SolePressure(LAYOUT), SolePressure(LAYOUT)
    source, lists, patches = (python_form(name) for name in ("pressed_sole", "foot_contacts", "pressed_patch"))
    python = source.PressedSole(np.ones(len(LAYOUT)), 1e-4, 256, other._make_patch)
    for case in contacts(seed):
        one = compiled.springs.press(foot_of(*case), case[1], REACH)
        with pytest.MonkeyPatch.context() as context:
            context.setattr(sole_pressure, "PressedPatch", patches.PressedPatch)
            assert np.array_equal(one, python.press(foot_of(*case, lists), case[1], REACH))
            assert np.array_equal(one, python.forces)
            assert np.array_equal(one, compiled.springs.forces)


@examples(20)
@given(seeds)
def test_contacts_in_the_world_press_where_the_sole_sees_them(seed):
    rng = np.random.default_rng(seed)
    pressure, rotation = SolePressure(LAYOUT), np.linalg.qr(rng.normal(size=(3, 3)))[0]
    seen = ContactsInSole()
    seen.look_from(rng.normal(size=3), rotation)
    for ids, vectors, gaps, carries in contacts(seed):
        foot = foot_of(ids, vectors @ rotation.T, gaps, carries)
        pressure.springs.stand(foot, seen, REACH)
        stood = np.array(pressure.springs.forces)
        assert np.array_equal(stood, pressure.springs.press(foot, np.asarray(seen.vectors), REACH))
        pressure.springs.stand(foot_of(ids[:0], vectors[:0], gaps[:0], carries[:0]), seen, REACH)
        assert not np.any(pressure.springs.forces)


def test_patches_that_were_not_pressed_for_long_are_forgotten():
    made = []
    pressure = SolePressure(LAYOUT)

    def make(points):
        made.append(len(points))
        return pressure._make_patch(points)

    sole = PressedSole(np.ones(len(LAYOUT)), 1e-4, 3, make)
    corners = [(-0.05, -0.03), (0.05, -0.03), (0.05, 0.03), (-0.05, 0.03)]
    for far in (0.0, 0.0, 2e-5, 0.01, 0.02, 0.03, 0.04, 0.05, 0.0):  # those that agree within the grid are one
        sole.spread([(x + far, y) for x, y in corners], 100.0, 0.0, 0.0)
        assert len(sole.made) <= 3
    assert len(made) == 7
