"""Tests of how a foot stands: rotations, flat planes, tilt and toes."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

from shoes.foot.orientation import AXES, flat_share, forward_axis, levelled, rotation_forward, rotation_up

Shape = Callable[..., NDArray[np.float64]]


@pytest.mark.parametrize("axis", AXES)
def test_rotations_bring_their_axis_where_it_should_be(axis: str) -> None:
    direction = np.zeros(3)
    direction["xyz".index(axis[-1])] = -1.0 if axis[0] == "-" else 1.0
    up = rotation_up(axis)  # type: ignore[arg-type]
    np.testing.assert_array_equal(up @ direction, [0, 0, 1])
    assert np.linalg.det(up) == pytest.approx(1.0)
    if axis[-1] != "z":
        forward = rotation_forward(axis)  # type: ignore[arg-type]
        np.testing.assert_array_equal(forward @ direction, [1, 0, 0])
        np.testing.assert_array_equal(forward[2], [0, 0, 1])
        assert np.linalg.det(forward) == pytest.approx(1.0)


def test_flat_soles_are_told_from_round_ones(box: Shape) -> None:
    assert flat_share(box((0, 200), (0, 90), (0, 40))) == pytest.approx(1.0)
    assert flat_share(trimesh.creation.icosphere(radius=60.0).triangles) < 0.1
    assert flat_share(np.zeros((4, 3, 3))) == 0.0


@pytest.mark.parametrize("tilt", [-12.0, 3.0, 20.0])
def test_a_tilt_is_taken_out_and_small_and_large_ones_are_left(box: Shape, tilt: float) -> None:
    body = np.concatenate([box((-50, 150), (-40, 40), (0, 30)), box((-20, 20), (-20, 20), (30, 80))])

    def turned(degrees: float) -> NDArray[np.float64]:
        turn = trimesh.transformations.rotation_matrix(np.radians(degrees), [0.3, 1.0, 0.0])[:3, :3]
        return np.asarray(body @ turn.T)

    flat, taken = levelled(turned(tilt))
    assert taken == pytest.approx(abs(tilt), abs=1e-6)
    z = flat[..., 2]
    assert np.ptp(z) == pytest.approx(80.0, abs=1e-6)
    for small in (0.5, 40.0):
        same, none = levelled(turned(small))
        assert none == 0.0
        np.testing.assert_array_equal(same, turned(small))


def test_toes_are_along_x_or_where_the_foot_is_longer(box: Shape) -> None:
    assert forward_axis(box((0, 200), (0, 90), (0, 40)))[0] == "x"
    assert forward_axis(box((-45, 45), (-50, 150), (0, 40)))[0] == "y"
    assert forward_axis(box((-45, 45), (-150, 50), (0, 40)))[0] == "-y"
    assert forward_axis(box((-45, 45), (-100, 100), (0, 40)))[0] == "y"  # nothing tells: said so
    assert "or give the forward axis" in forward_axis(box((-45, 45), (-100, 100), (0, 40)))[1]
