import numpy as np
import pytest

from plantar.common.plane_points import plane_point, plane_points
from plantar.errors import InputError


@pytest.mark.parametrize("shape", [(), (2,), (4,), (3, 3), (0, 3), (2, 2, 2), (2, 1)])
def test_points_are_pairs_in_rows(shape):
    with pytest.raises(InputError, match=rf"polygon: shape {str(shape).replace('(', '.').replace(')', '.')}; exp"):
        plane_points(np.zeros(shape))


def test_no_points_are_no_points():
    assert plane_points([]).shape == plane_points(np.empty((0, 2))).shape == (0, 2)


def test_a_point_is_two_numbers():
    assert plane_point(np.array([1, 2], dtype=np.int8)) == (1.0, 2.0)
    for value in (None, 1.0, [1.0], [1.0, 2.0, 3.0], [[1.0, 2.0]], "ab", (1.0, None)):
        with pytest.raises(InputError, match=r"^point: (not|shape)"):
            plane_point(value)
