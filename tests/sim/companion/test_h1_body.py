"""The machine h1-body against the published figures, the walking robot h1 and the split of its skin."""

from collections import Counter

import mujoco
import numpy as np
import pytest

from plantar.robots import load_robot
from plantar.sim.body_skin.surface import skin_from_tables
from plantar.sim.companion.machine import load_machine


def test_mass_joints_and_height_of_the_centre_of_mass_are_the_published_ones():
    machine = load_machine("h1-body")
    model = machine.spec().compile()
    assert mujoco.mj_getTotalmass(model) == pytest.approx(86.0, abs=1e-3)
    assert (model.nv, model.nu, len(machine.joints)) == (36, 30, 30)
    data = mujoco.MjData(model)
    data.qpos[7:] = machine.posture
    mujoco.mj_forward(model, data)
    soles = [data.site(f"{side}_sole").xpos for side in ("left", "right")]
    middle = 0.5 * (soles[0] + soles[1])
    assert data.subtree_com[0] - middle == pytest.approx([0.022, 0.0, 0.8], abs=2e-3)
    assert data.body("head").xpos[2] + 0.2 - middle[2] == pytest.approx(1.65, abs=0.02)


def test_legs_are_those_of_the_walking_robot():
    machine, robot = load_machine("h1-body"), load_robot("h1")
    model = machine.spec().compile()
    efforts = dict(zip(machine.joints, machine.efforts, strict=True))
    for side in ("left", "right"):
        joints = robot.legs[side].joints
        assert [efforts[name] for name in joints] == pytest.approx(robot.biped.effort_limits)
        assert np.degrees(robot.posture[side]) == pytest.approx([machine.joints[name].posture for name in joints])
        assert sum(float(model.body(model.joint(n).bodyid[0]).mass[0]) for n in joints) == pytest.approx(11.26 + 0.273)


def test_the_skin_has_1260_taxels_and_mirrors():
    machine = load_machine("h1-body")
    skin = skin_from_tables(machine.spec().compile(), machine.patches, "h1-body")
    assert len(skin) == 1260
    assert len(skin.links) == 14
    counts = Counter({p.name: len(p) for p in skin.patches})
    assert counts["left_foot_sole"] == 42
    assert counts["left_hand_back"] == 7
    for name, count in counts.items():
        other = name.replace("left", "right")
        assert counts[other] == count
    for name in ("foot_sole", "upper_arm"):
        left, right = (skin.positions[skin.slices[f"{side}_{name}"]] for side in ("left", "right"))
        assert np.sort(left[:, 2]) == pytest.approx(np.sort(right[:, 2]), abs=1e-6)
