"""Contacts of faces: corners of the part that is covered, the same to the last bit in both forms."""

import math

import numpy as np
import pytest

from plantar.kernels import python_form
from plantar.kernels.contacts.face_contacts import FaceContacts
from plantar.mechanics.rotation import rotation_from_angles

FORMS = {"compiled": FaceContacts, "python": python_form("contacts.face_contacts").FaceContacts}


def contacts(form, kind, places, turns, sizes, margin=1e-3, sign=1.0):
    """Contacts (k, 10) that a form finds of geom 1 on geom 0."""
    found = np.zeros((8, 10))
    arrays = [np.ascontiguousarray(a, dtype=float) for a in (places, turns, sizes)]
    find = getattr(FORMS[form](80), kind)
    count = find(*(a.ctypes.data for a in arrays), 0, 1, margin, found.ctypes.data, sign)
    return found[: max(count, 0)], count


@pytest.mark.parametrize("form", FORMS)
def test_a_sole_across_a_beam_touches_at_the_corners_of_what_is_covered(form):
    found, _ = contacts(
        form, "box", [[0, 0, -0.1], [0.01, 0.2, 0.0059]], [np.eye(3)] * 2, [[0.06, 1, 0.1], [0.115, 0.08, 0.006]]
    )
    assert found[:, 0] == pytest.approx(-1e-4)
    corners = sorted(map(tuple, found[:, 1:3].round(9).tolist()))
    assert corners == [(-0.06, 0.12), (-0.06, 0.28), (0.06, 0.12), (0.06, 0.28)]
    assert np.allclose(found[:, 3], -5e-5)
    assert np.array_equal(found[:, 4:7], np.tile([0.0, 0.0, 1.0], (4, 1)))


@pytest.mark.parametrize("form", FORMS)
def test_a_sole_against_a_wall_is_pushed_sideways_and_one_that_is_clear_is_not(form):
    wall = [[0, 0, 0], [0.174, 0, -0.02]], [np.eye(3)] * 2, [[0.06, 1, 0.1], [0.115, 0.08, 0.006]]
    found, _ = contacts(form, "box", *wall, sign=-1.0)
    assert len(found) == 4
    assert np.allclose(found[:, 0], -1e-3)
    assert np.allclose(found[:, 4:7], [-1, 0, 0])
    wall[0][1][0] = 0.2
    assert contacts(form, "box", *wall)[1] == 0


@pytest.mark.parametrize("form", FORMS)
def test_a_sole_touches_a_post_s_end_on_its_rim_along_the_diagonals(form):
    found, _ = contacts(
        form, "cylinder", [[0, 0, -0.1], [0, 0, 0.0059]], [np.eye(3)] * 2, [[0.05, 0.1, 0], [0.115, 0.08, 0.006]]
    )
    assert np.hypot(found[:, 1], found[:, 2]) == pytest.approx([0.05] * 4)
    assert np.abs(found[:, 1:3]) == pytest.approx(0.05 / math.sqrt(2.0))
    upright = [np.eye(3), rotation_from_angles(0.0, 1.2, 0.0)]
    assert contacts(form, "cylinder", [[0, 0, -0.1], [0, 0, 0.02]], upright, [[0.05, 0.1, 0], [0.1, 0.1, 0.1]])[1] == -1


def test_both_forms_agree_to_the_last_bit():
    rng = np.random.default_rng(0)
    most = 0
    for _ in range(300):
        size = rng.uniform(0.02, 0.3, (2, 3))
        turns = [rotation_from_angles(*rng.normal(0.0, s, 3)) for s in (0.5, 10.0 ** rng.uniform(-4, 0))]
        turns[1] = turns[0] @ turns[1]
        shift = rng.uniform(-0.2, 0.2, 2)
        for kind in ("box", "cylinder"):
            height = size[0, 2 if kind == "box" else 1] + size[1, 2] - 3e-4
            places = np.array([np.zeros(3), turns[0] @ np.array([*shift, height])])
            given = contacts("compiled", kind, places, turns, size), contacts("python", kind, places, turns, size)
            assert given[0][1] == given[1][1]
            assert np.array_equal(given[0][0], given[1][0])
            most = max(most, given[0][1])
    assert most > 4
