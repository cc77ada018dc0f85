"""Pairs of bodies are found by name and shape, and their cells compared."""

import mujoco
import numpy as np
from skin_pairs import other_name, pairs_of, row

ARM = '<geom type="capsule" size=".03 .08" pos=".01 {y} 0"/><geom type="box" size=".03 .02 .04" pos=".05 {y} .02"/>'


def arms(left: float, right: float) -> mujoco.MjModel:
    bodies = "".join(
        f'<body name="{name}"><joint/>{ARM.format(y=y)}</body>'
        for name, y in (("left_arm", left), ("right_arm", right))
    )
    return mujoco.MjModel.from_xml_string(f"<mujoco><worldbody>{bodies}</worldbody></mujoco>")


def test_names_of_the_other_side():
    names = {"left_foot", "FL_calf", "l_hand", "L_HAND", "LeftToe", "wheel"}
    found = [other_name(n, names) for n in ("right_foot", "FR_calf", "r_hand", "R_HAND", "RightToe", "wheer", "arm")]
    assert found == ["left_foot", "FL_calf", "l_hand", "L_HAND", "LeftToe", None, None]


def test_mirrored_arms_are_compared_and_others_are_not():
    (pair,) = pairs_of(arms(0.02, -0.02))
    assert pair.off < 1e-15
    assert np.array_equal(pair.way, np.diag([1.0, -1.0, 1.0]))
    found = row("arms", arms(0.02, -0.02), 4)
    assert found is not None
    assert float(found[5]) < 1e-12
    assert row("arms", arms(0.02, 0.02), 4) is None
