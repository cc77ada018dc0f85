"""The kernel of contacts as a sole sees them, against numpy, in both forms."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.kernels import python_form
from plantar.kernels.contacts import contacts_in_sole, foot_contacts

FORMS = (
    (contacts_in_sole, foot_contacts),
    (python_form("contacts_in_sole"), python_form("foot_contacts")),
)


@pytest.mark.parametrize("seed", range(5))
def test_contacts_are_seen_from_the_sole_wherever_it_is(seed):
    rng = np.random.default_rng(seed)
    origin, rotation = np.zeros(3), np.eye(3)
    seen = [forms[0].ContactsInSole() for forms in FORMS]
    for one in seen:
        one.look_from(origin, rotation)
    for k in (4, 1, 0, 3, 30, 2, 1):
        origin[:], rotation[:] = rng.normal(size=3), np.linalg.qr(rng.normal(size=(3, 3)))[0]
        vectors = rng.normal(size=(3 * k, 3))
        shifted = vectors.copy()
        shifted[::3] -= origin
        found = []
        for one, (_, lists) in zip(seen, FORMS, strict=True):
            foot = lists.FootContacts(np.zeros(1, dtype=np.uint8))
            foot.take(np.zeros((k, 2), dtype=np.int32), vectors, np.zeros(k), np.ones(k, dtype=np.uint8))
            one.turn(foot)
            found.append(np.array(one.vectors)[: 3 * k])
        assert np.array_equal(*found)
        assert found[0] == pytest.approx(shifted @ rotation, abs=1e-14)
        if k == 1:
            assert np.array_equal(found[0], np.vstack([row[None] @ rotation for row in shifted]))
    assert [(one.pressed, one.in_air) for one in seen] == [(6, 1)] * 2
