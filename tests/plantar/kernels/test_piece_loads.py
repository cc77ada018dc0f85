"""What pieces of ground carry: sums over feet, peaks and longest times, by both forms of the kernel."""

from typing import Any

import numpy as np
import pytest

from plantar.kernels import python_form
from plantar.kernels.contacts.foot_contacts import FootContacts
from plantar.kernels.judging.piece_loads import PieceLoads

OWN = np.array([1, 0, 0, 0], dtype=np.uint8)  # the foot is geom 0
PIECES = np.array([-1, 0, -1, 1], dtype=np.intp)  # geoms 1 and 3 are pieces; 2 is the floor
FORMS = {"compiled": (PieceLoads, FootContacts)}
FORMS["python"] = (
    python_form("judging.piece_loads").PieceLoads,
    python_form("contacts.foot_contacts").FootContacts,
)


def foot(form: Any, contacts: list[tuple[int, float]]) -> Any:
    """A foot's contacts by the other geom and the vertical force in N."""
    found = form(OWN)
    vectors = np.zeros((3 * len(contacts), 3))
    vectors[1::3, 2] = [force for _, force in contacts]
    ids = np.array([(0, geom) for geom, _ in contacts], dtype=np.int32).reshape(-1, 2)
    found.take(ids, vectors, np.zeros(len(contacts)), np.ones(len(contacts), dtype=np.uint8))
    return found


@pytest.mark.parametrize("form", FORMS)
def test_forces_of_both_feet_on_a_piece_add_up_and_the_longest_time_in_a_row_counts(form):
    loads, contacts = FORMS[form]
    watch = loads(PIECES, 100.0)
    steps = [
        ([(1, 60.0)], [(1, 50.0)]),  # together it carries
        ([(1, 120.0), (3, 30.0)], [(2, 500.0)]),
        ([(1, 99.0)], [(3, 100.0), (-1, 900.0)]),  # a break of one, and a flex that is no piece
        ([(1, 30.0), (1, 40.0), (1, 40.0)], []),
    ]
    for left, right in steps:
        watch.step((foot(contacts, left), foot(contacts, right)))
    assert list(watch.longest) == [2, 1]
    assert list(watch.largest) == [120.0, 100.0]


@pytest.mark.parametrize("form", FORMS)
def test_ground_without_pieces_has_none(form):
    loads, contacts = FORMS[form]
    watch = loads(np.full(4, -1, dtype=np.intp), 100.0)
    watch.step((foot(contacts, [(2, 500.0)]),))
    assert len(watch.longest) == len(watch.largest) == 0
