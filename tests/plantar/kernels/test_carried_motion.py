"""A command's torques, in both forms: the load of its forces, and then that of its motion."""

from types import SimpleNamespace

import numpy as np
import pytest

from plantar.kernels import python_form
from plantar.kernels.joints import carried_motion


def test_the_loads_are_added_in_order_with_the_momentum_as_a_couple():
    calls = []
    static = SimpleNamespace(stand=lambda *arrays: calls.append(("stand", arrays)) or 0.25)
    motion = SimpleNamespace(
        move=lambda *arrays: calls.append(("move", arrays)), add=lambda *numbers: calls.append(("add", numbers))
    )
    parts = [lambda name=name: calls.append((name, ())) for name in ("place", "turn", "fall")]
    kernel = python_form("carried_motion").CarriedMotion(
        parts[0], static, ("levers",), motion, parts[1], parts[2], 100.0
    )
    left, right = (SimpleNamespace(force=k, center_of_pressure=k + 1, position=k + 2) for k in (1, 4))
    kernel.take(left, right, "speeds", "changes", np.array([0.1, 0.2]), True)
    assert [name for name, _ in calls] == ["place", "stand", "move", "turn", "fall", "add"]
    assert calls[1][1] == (("levers",), 1, 2, 3, 4, 5, 6)
    assert calls[5][1] == ("changes", 0.25, pytest.approx(20.0), pytest.approx(-10.0), True)


@pytest.mark.parametrize("module", [carried_motion, python_form("carried_motion")])
def test_other_strides_are_refused_before_anything_is_done(module):
    calls = []
    kernel = module.CarriedMotion(lambda: calls.append("placed"), None, (), None, None, None, 100.0)
    with pytest.raises(ValueError, match="contiguous"):
        kernel.take(None, None, np.zeros(9), np.zeros(9), np.zeros((2, 2))[:, 0], True)
    assert not calls
