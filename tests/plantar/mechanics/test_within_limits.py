import numpy as np

from plantar.mechanics.within_limits import Box, nearest_within


def cube(size, end):
    """Limits of each coordinate, all of them soft."""
    return Box.of(np.zeros((0, size)), np.zeros(0), np.zeros(0), np.eye(size), np.full(size, -end), np.full(size, end))


def test_what_keeps_the_limits_is_taken_as_it_is():
    own, target = np.eye(3)[:2], np.array([0.5, -0.2])
    box = cube(3, 1.0)
    same, found = nearest_within(box, np.zeros(3), np.eye(3), own, target, np.ones(2))
    assert same is box
    assert found is target


def test_the_rest_makes_room_for_what_is_wanted():
    """One direction through two coordinates, of which the first is at its end: the other takes all of it."""
    own = np.array([[1.0, 1.0]]) / np.sqrt(2.0)
    box = cube(2, 1.0)
    found = nearest_within(box, np.zeros(2), np.eye(2), own, np.array([1.2 * np.sqrt(2.0) / 2.0]), np.ones(1))[1]
    assert np.allclose(found, 1.2 * np.sqrt(2.0) / 2.0)
    found = nearest_within(box, np.array([0.9, 0.0]), np.eye(2), own, np.array([0.5]), np.ones(1))[1]
    assert np.allclose(found, 0.5)
    found = nearest_within(box, np.zeros(2), np.eye(2), own, np.array([9.0]), np.ones(1))[1]
    assert np.allclose(found, np.sqrt(2.0))


def test_of_limits_that_nothing_keeps_the_soft_ones_give_way():
    one = np.ones(1)
    box = Box.of(np.eye(2)[:1], -one, one, np.eye(2)[:1], 3.0 * one, 4.0 * one)
    wide, found = nearest_within(box, np.zeros(2), np.eye(2), np.eye(2), np.array([5.0, 0.5]), np.ones(2))
    assert np.allclose(found, [1.0, 0.5], atol=1e-4)
    assert np.allclose(wide.low, [-1.0, 1.0], atol=1e-4)
    assert wide.high[0] < 1.0 + 1e-4
