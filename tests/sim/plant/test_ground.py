"""The true ground: friction and softness by piece, foam under the soles, and colours that mislead proximity."""

import math

import mujoco
import numpy as np
import pytest

from plantar.common.settings.body_scale import REFERENCE_BODY
from plantar.sim.model.contact_truth import foot_contacts
from plantar.sim.model.world import World
from plantar.sim.plant.ground import FOAM_MODULUS, PATCH, foam_time
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene


def world_of(scene: str, *settings: str, seed: int = 0) -> World:
    return Simulation(load_scene(scene, ["steps=4", *settings]), seed).world


def contact_friction(world: World) -> dict[str, float]:
    """Friction of each contact that MuJoCo finds under the soles, by the ground's geom."""
    mujoco.mj_forward(world.model, world.data)
    soles = {geom for geoms in world.sole_geoms.values() for geom in geoms}
    found = {}
    for contact in world.data.contact[: world.data.ncon]:
        pair = {int(contact.geom1), int(contact.geom2)}
        if pair & soles:
            found[world.model.geom((pair - soles).pop()).name] = float(contact.friction[0])
    return found


def test_pieces_of_ground_differ_in_the_stated_range_and_count_under_the_sole():
    plain, patchy = world_of("uneven"), world_of("uneven", "patchiness=0.5", "friction_ratio=0.8", "softness=0.02")
    named = [i for i in range(patchy.model.ngeom) if patchy.model.geom(i).name.startswith("ground")]
    ground = [i for i in named if patchy.model.geom_contype[i]]  # what soles touch
    ratio = patchy.model.geom_friction[ground, 0] / plain.model.geom_friction[ground, 0]
    assert len(np.unique(ratio)) == len(ground) > 4
    assert 0.4 <= ratio.min() < ratio.max() <= 0.8
    times = patchy.model.geom_solref[ground, 0]
    assert math.hypot(0.005, 0.01) <= times.min() < times.max() <= math.hypot(0.005, 0.02)
    stood_on = contact_friction(patchy)
    assert stood_on
    sole = patchy.model.geom("left_sole_box").friction[0]  # MuJoCo's own rule would take the larger one
    assert sole == pytest.approx(0.64)
    for name, friction in stood_on.items():
        assert friction == pytest.approx(patchy.model.geom(name).friction[0])
        assert friction < sole


def test_ground_of_one_kind_is_left_to_mujoco_s_own_rule():
    world = world_of("uneven", "friction_ratio=0.5")
    assert not world.model.geom_priority.any()
    assert set(contact_friction(world).values()) == {0.4}


def sunk(world: World) -> float:
    """Mean depth in m of the contacts under the left sole."""
    mujoco.mj_forward(world.model, world.data)
    return -float(np.mean(foot_contacts(world.model, world.data, frozenset(world.sole_geoms["left"])).distances))


def test_foam_is_a_spring_of_its_modulus_over_its_thickness():
    # Under a weight a layer is compressed by pressure / modulus of its thickness, and m / k is that over gravity.
    body, thickness = REFERENCE_BODY, 0.01
    pressed = thickness * body.weight / (body.sole * body.sole_width) / FOAM_MODULUS
    assert foam_time(thickness, body) ** 2 * 9.81 == pytest.approx(pressed, rel=1e-3)
    hard, soft = world_of("flat"), world_of("flat", "rubber=0.003")
    assert soft.model.geom("ground").solref[0] == pytest.approx(math.hypot(0.005, foam_time(0.003, hard.body)))
    assert sunk(soft) / sunk(hard) == pytest.approx(1.0 + (foam_time(0.003, hard.body) / 0.005) ** 2, rel=0.05)


def edge_taxels(rubber: float) -> int:
    """How many taxels feel a foot that stands on its toe edge alone."""
    skin = Simulation(load_scene("flat", ["steps=0", f"rubber={rubber}"]), 0).sensors.skins["left"].skin
    return int(np.count_nonzero(skin.pressure.spread([(0.1, -0.05), (0.1, 0.05)], 100.0, (0.1, 0.0))))


def test_foam_spreads_what_presses_on_an_edge():
    assert edge_taxels(0.03) > edge_taxels(0.0)


def test_dark_ground_seems_farther_away_by_the_inverse_square_law():
    settings = ["steps=4", "pfc=true", "proximity_noise=0", "proximity_range=0.3"]
    nominal, true = (Simulation(load_scene("flat", [*settings, f"reflectance={r}"]), 0) for r in (0, 0.5))
    distances = []
    for simulation in (nominal, true):
        data = simulation.world.data
        data.qpos[2] += 0.08
        mujoco.mj_forward(simulation.world.model, data)
        distances.append(simulation.sensors.proximity["left"].proximity.distances(data))
    ratio = distances[1] / distances[0]
    assert np.isfinite(ratio).all()
    assert 1.0 / math.sqrt(1.5) <= ratio.min() < 0.95
    assert 1.05 < ratio.max() <= 1.0 / math.sqrt(0.5)
    # Taxels that look at one patch are misled alike.
    layout, site = true.robot.layouts["left"], true.world.sole_sites["left"]
    rotation = true.world.data.site_xmat[site].reshape(3, 3)
    seen = layout.positions @ rotation.T + true.world.data.site_xpos[site]
    tiles = np.floor(seen[:, :2] / PATCH)
    for tile in np.unique(tiles, axis=0):
        assert np.ptp(ratio[(tiles == tile).all(axis=1)]) < 1e-9


def test_ground_out_of_range_stays_out_of_range():
    simulation = Simulation(load_scene("flat", ["steps=4", "pfc=true", "reflectance=0.5"]), 0)
    simulation.world.data.qpos[2] += 1.0
    mujoco.mj_forward(simulation.world.model, simulation.world.data)
    assert np.isinf(simulation.sensors.proximity["left"].proximity.distances(simulation.world.data)).all()
