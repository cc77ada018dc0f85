"""The true body in MuJoCo, measured: masses, centres of mass, stiffness, friction, sinking."""

import mujoco
import numpy as np
import pytest

from plantar.sim.model.contact_truth import foot_contacts
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene

ROBOTS = ("h1", "hrp2kai")


def standing(*settings: str, robot: str = "h1") -> Simulation:
    """A robot that stands, half a second after it was put on its feet."""
    return Simulation(load_scene("flat", ["steps=0", *settings], robot), 0)


def upper_body_com(simulation: Simulation) -> np.ndarray:
    """Centre of mass (3,) of what is fixed to the torso, in the torso's frame, in the model's own pose."""
    world = simulation.world
    data = mujoco.MjData(world.model)
    mujoco.mj_kinematics(world.model, data)
    upper = world.model.body_weldid == world.model.body_weldid[world.torso]
    mass = world.model.body_mass[upper]
    com = mass @ data.xipos[upper] / mass.sum()
    return data.xmat[world.torso].reshape(3, 3).T @ (com - data.xpos[world.torso])


@pytest.mark.parametrize("robot", ROBOTS)
def test_the_upper_body_s_centre_of_mass_moves_by_what_was_asked(robot):
    nominal, true = standing(robot=robot), standing("com_offset=[0.01, -0.02, 0.03]", robot=robot)
    assert upper_body_com(true) - upper_body_com(nominal) == pytest.approx([0.01, -0.02, 0.03], abs=1e-12)
    assert true.world.model.body_subtreemass[0] == nominal.world.model.body_subtreemass[0]


def test_the_controller_s_own_model_stays_the_nominal_one():
    nominal = standing()
    true = standing("plant=random", "level=3")
    assert np.array_equal(true.legs.model.body_ipos, nominal.legs.model.body_ipos)
    assert np.array_equal(true.legs.model.body_mass, nominal.legs.model.body_mass)
    assert true.body == nominal.body == true.world.body
    assert np.array_equal(true.world.stiffness, nominal.world.stiffness)
    assert repr(true.settings) == repr(nominal.settings)  # they hold arrays


@pytest.mark.parametrize("robot", ROBOTS)
def test_the_ground_carries_the_true_mass(robot):
    nominal, true = standing(robot=robot), standing("mass_ratio=1.1", robot=robot)
    assert true.world.model.body_subtreemass[0] == pytest.approx(1.1 * nominal.world.model.body_subtreemass[0])
    for _ in range(500):
        mujoco.mj_step(true.world.model, true.world.data)
    felt = sum(float(true.world.data.sensordata[true.world.touch[side]]) for side in ("left", "right"))
    assert felt == pytest.approx(1.1 * nominal.body.weight, rel=2e-3)


def test_inertias_go_with_the_mass():
    nominal, true = standing().world, standing("mass_ratio=0.9").world
    speeds = np.random.default_rng(0).normal(size=nominal.model.nv)
    energies = []
    for world in (nominal, true):
        world.model.dof_armature[:] = 0.0  # of the motors, which stay what they are
        world.data.qpos[:], world.data.qvel[:] = nominal.data.qpos, speeds
        mujoco.mj_forward(world.model, world.data)
        mujoco.mj_energyVel(world.model, world.data)
        energies.append(float(world.data.energy[1]))
    assert energies[1] == pytest.approx(0.9 * energies[0], rel=1e-9)


def test_a_servo_s_torque_over_its_deflection_is_its_stiffness():
    world = standing("stiffness_ratio=0.6").world
    world.data.qvel[:] = 0.0
    world.data.ctrl[world.servos] = world.data.qpos[world.joint_qpos] + 0.001
    mujoco.mj_forward(world.model, world.data)
    assert world.data.actuator_force[world.servos] / 0.001 == pytest.approx(0.6 * world.stiffness)


def slid(ratio: float) -> float:
    """How far in m a standing robot slides in 0.3 s on a ground of friction 0.8 times a ratio that slopes by 0.11."""
    world = standing(f"friction_ratio={ratio}").world
    world.model.opt.gravity[:2] = (0.11 * world.model.opt.gravity[2], 0.0)
    site = world.sole_sites["left"]
    before = float(world.data.site_xpos[site, 0])
    for _ in range(300):
        mujoco.mj_step(world.model, world.data)
    return abs(float(world.data.site_xpos[site, 0]) - before)


def test_feet_slide_down_a_slope_that_is_steeper_than_the_true_friction():
    assert slid(1.0) < 1e-3
    # The robot slides as a body on a slope: half of (0.11 - 0.08) g t^2, less what its servos yield meanwhile.
    assert slid(0.1) == pytest.approx(0.5 * 0.03 * 9.81 * 0.3**2, rel=0.35)


def sunk(softness: float) -> float:
    """Mean depth in m of the contacts under a standing robot's left sole."""
    world = standing(f"softness={softness}").world
    return -float(np.mean(foot_contacts(world.model, world.data, frozenset(world.sole_geoms["left"])).distances))


def test_soft_ground_is_sunk_into():
    hard, soft, softer = sunk(0.0), sunk(0.005), sunk(0.01)
    # At rest a contact of MuJoCo is a spring of stiffness 1 / time constant^2 for each kg, as long as it is shallow;
    # the scene's own has 5 ms.
    assert soft / hard == pytest.approx((0.005**2 + 0.005**2) / 0.005**2, rel=0.05)
    assert softer / hard == pytest.approx((0.01**2 + 0.005**2) / 0.005**2, rel=0.05)


def test_a_load_adds_its_mass_at_its_place_and_its_inertia() -> None:
    nominal = standing().world.model
    true = standing("load=0.05", "load_place=[0.2, 0.05, -0.1]").world.model
    torso, place = standing().world.torso, np.array([0.2, 0.05, -0.1])
    mass, load = nominal.body_mass[torso], 0.05 * nominal.body_subtreemass[0]
    assert true.body_subtreemass[0] == pytest.approx(1.05 * nominal.body_subtreemass[0])

    def moments(model: mujoco.MjModel, about: np.ndarray) -> np.ndarray:
        """Inertia (3, 3) of the torso about a point of its frame."""
        turn = np.empty(9)
        mujoco.mju_quat2Mat(turn, model.body_iquat[torso])
        axes, away = turn.reshape(3, 3), model.body_ipos[torso] - about
        own = axes @ np.diag(model.body_inertia[torso]) @ axes.T
        return np.asarray(own + model.body_mass[torso] * (away @ away * np.eye(3) - np.outer(away, away)))

    origin = nominal.body_ipos[torso]
    assert true.body_ipos[torso] - origin == pytest.approx(load / (mass + load) * place, abs=1e-12)
    gained = moments(true, origin) - moments(nominal, origin)
    assert gained == pytest.approx(load * (place @ place * np.eye(3) - np.outer(place, place)), abs=1e-9)
