"""Forces from outside: those of a scene's actors are theirs, all others are found."""

from types import SimpleNamespace
from typing import Any

import mujoco
import numpy as np
import pytest

from plantar.sim.judging.other_contact import OtherContact
from plantar.sim.judging.outside_force import OutsideForce

XML = """<mujoco><worldbody><geom name="floor" type="plane" size="0 0 1"/>
<body name="base" pos="0 0 1"><freejoint name="root"/><geom name="trunk" size="0.1"/>
<body name="leg"><joint name="knee" axis="0 1 0"/><geom name="shank" size="0.05" pos="0 0 -0.3"/></body></body>
<body name="partner" pos="3 0 1"><joint name="slide" type="slide"/><geom size="0.1"/></body></worldbody></mujoco>"""


class Pusher:
    """Pushes a body as it says."""

    def __init__(self, body: int, force: float) -> None:
        self.body, self.force = body, force

    def add_applied(self, forces: np.ndarray) -> None:
        forces[self.body, 0] += self.force


def world(*actors: Any) -> tuple[Any, Any, OutsideForce]:
    model = mujoco.MjModel.from_xml_string(XML)
    data = mujoco.MjData(model)
    return model, data, OutsideForce(model, data, model.body("base").id, actors)


def test_what_no_actor_does_is_found_and_named():
    _, data, outside = world()
    outside.step()
    assert outside.reasons() == []
    data.time = 1.5
    data.body("leg").xfrc_applied[2] = 3.0
    outside.step()
    data.time = 2.0
    data.body("leg").xfrc_applied[2] = 2.0
    outside.step()
    data.body("leg").xfrc_applied[2] = 0.0
    outside.step()
    (reason,) = outside.reasons()
    assert (reason["criterion"], reason["value"], reason["limit"]) == ("outside_force", 3.0, 0.0)
    assert "leg was pushed from outside by 3 N or N m, first at 1.50 s" in reason["text"]


def test_an_actor_may_push_as_it_says_and_no_harder():
    pusher = Pusher(1, 20.0)
    _, data, outside = world(pusher)
    data.body("base").xfrc_applied[0] = 20.0
    outside.step()
    assert outside.reasons() == []
    data.body("base").xfrc_applied[0] = 25.0
    outside.step()
    assert outside.reasons()[0]["value"] == pytest.approx(5.0)


def test_an_actor_that_says_it_pushes_and_does_not_is_found():
    _, _, outside = world(Pusher(1, 20.0))
    outside.step()
    assert outside.reasons()[0]["value"] == pytest.approx(20.0)


def test_torques_on_the_robot_are_found_and_those_of_a_partners_own_drive_are_not():
    _, data, outside = world()
    data.joint("slide").qfrc_applied[0] = 7.0
    outside.step()
    assert outside.reasons() == []
    data.joint("knee").qfrc_applied[0] = -4.0
    outside.step()
    (reason,) = outside.reasons()
    assert reason["value"] == pytest.approx(4.0)
    assert reason["text"].startswith("knee was pushed")


def test_a_force_that_is_no_number_is_found():
    _, data, outside = world()
    data.body("base").xfrc_applied[0] = np.inf
    outside.step()
    assert outside.reasons()


@pytest.mark.parametrize(("height", "part"), [(1.0, None), (0.34, "leg")])
def test_a_leg_that_touches_the_ground_is_found(height, part):
    model, data, _ = world()
    data.qpos[2] = height
    mujoco.mj_forward(model, data)
    made = SimpleNamespace(model=model, data=data, torso=model.body("base").id, sole_geoms={}, period=0.002)
    others = OtherContact(made)
    others.step()
    assert (others.first[1] if others.first else None) == part
    assert bool(others.reasons()) == (part is not None)


def test_a_sole_that_touches_the_ground_is_none_of_the_others():
    model, data, _ = world()
    data.qpos[2] = 0.34
    mujoco.mj_forward(model, data)
    sole = {"left": (model.geom("shank").id,)}
    others = OtherContact(SimpleNamespace(model=model, data=data, torso=1, sole_geoms=sole, period=0.002))
    others.step()
    assert others.reasons() == []
