"""Contact parameters of a scene reach the model, scaled to the robot; none of a scene is the usual."""

import mujoco
import pytest

from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene

MUJOCO = (
    *("sole_contact.settling=0.02", "sole_contact.least_impedance=0.9", "sole_contact.largest_impedance=0.95"),
    *(
        "sole_contact.rigid_depth=0.001",
        "sole_contact.listed_gap=0",
        "sole_contact.cone=pyramidal",
        "sole_contact.impratio=1",
    ),
)
"""Settings of a scene whose contact has MuJoCo's defaults."""


def soles_and_ground(*settings: str, robot: str = "h1") -> tuple[Simulation, list[mujoco.MjModel]]:
    simulation = Simulation(load_scene("obstacle", list(settings), robot))
    model = simulation.world.model
    return simulation, [model.geom(name) for name in ("left_sole_box", "ground", "ground_0_corners")]


@pytest.mark.parametrize("robot", ["h1", "hrp2kai"])
def test_the_usual_contact_is_a_hard_sole(robot):
    simulation, geoms = soles_and_ground(robot=robot)
    leg = simulation.body.leg
    for geom in geoms:
        assert geom.solref == pytest.approx([0.005, simulation.robot.contact_damping])
        assert geom.solimp == pytest.approx([0.95, 0.99, leg / 600.0, 0.5, 2.0])
        assert geom.gap == pytest.approx(leg / 600.0)
    assert simulation.world.model.opt.cone == mujoco.mjtCone.mjCONE_ELLIPTIC
    assert simulation.world.model.opt.impratio == 10.0


def test_a_scene_may_have_mujocos_defaults():
    simulation, geoms = soles_and_ground(*MUJOCO)
    plain = mujoco.MjModel.from_xml_string("<mujoco><worldbody><geom size='1'/></worldbody></mujoco>")
    for geom in geoms:
        assert geom.solref == pytest.approx(plain.geom_solref[0])
        assert geom.solimp == pytest.approx(plain.geom_solimp[0])
        assert geom.gap == plain.geom_gap[0]
    assert simulation.world.model.opt.cone == plain.opt.cone
    assert simulation.world.model.opt.impratio == plain.opt.impratio


def test_a_contact_takes_two_physics_steps_at_least():
    _, geoms = soles_and_ground("sole_contact.settling=0.0005", "physics_period=0.001")
    assert all(geom.solref[0] == pytest.approx(0.002) for geom in geoms)
