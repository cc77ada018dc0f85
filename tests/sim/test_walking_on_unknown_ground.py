"""Soft landing and step feasibility, judged by true contacts: one seed each, all of them in the long tests."""

from dataclasses import replace

import numpy as np
import pytest

from plantar.sim.run.runner import Simulation, run_scene
from plantar.sim.run.scene import load_scene
from tests.sim.rates import check_rate, drawn_seeds

WEIGHT = 86.0 * 9.81


def test_proximity_softens_the_landing_on_ground_that_is_not_where_it_is_expected():
    on = run_scene(load_scene("uneven", ["steps=6", "settle=0.5"]), 1)
    off = run_scene(load_scene("uneven", ["steps=6", "settle=0.5", "pfc=false"]), 1)
    assert on["completed"]
    assert on["steps_taken"] == 6
    assert np.mean(on["impacts_N"]) < 0.1 * WEIGHT
    assert np.mean(off["impacts_N"]) > 0.3 * WEIGHT
    assert on["landings_s"][-1] == pytest.approx(off["landings_s"][-1], abs=0.4)


@pytest.mark.long
def test_computing_everything_leaves_the_motion_with_proximity_the_same():
    runs = []
    for skip in ("auto", "none"):
        simulation = Simulation(
            load_scene("uneven", ["steps=1", "start=0.4", "settle=0.2", "end=0.2", f"skip={skip}"]), 3
        )
        runs.append((simulation.run(), simulation.world.data.qpos.copy()))
    (plain, first), (everything, second) = runs
    assert np.array_equal(first, second)
    for name in ("impacts_N", "tilt_max_deg", "zmp_margin_min_m", "contact_area_ratio", "sim_time_s"):
        assert plain[name] == everything[name]
    for name in ("proximity_rays", "percept_members"):
        assert everything["skipped"][name] == 0 < plain["skipped"][name]


@pytest.mark.sample(1)
@pytest.mark.parametrize("slope", ["pitch=10", "roll=-10"])
def test_the_sole_lies_on_a_slope_when_it_touches_it(slope):
    summary = run_scene(load_scene("tilt", ["pitch=0", slope, "settle=0.5"]), 0)
    assert summary["completed"]
    assert summary["sole_angles_deg"][4] < 2.0


def test_a_slab_is_stepped_on_softly():
    summary = run_scene(load_scene("obstacle", ["settle=0.5"]), 0)
    assert summary["completed"]
    assert max(summary["impacts_N"]) < 0.5 * WEIGHT


@pytest.mark.parametrize(("at", "touches"), [("sight", 0), ("probe", 1)])
def test_a_block_that_is_seen_to_be_small_is_not_touched(at, touches):
    (seed,) = drawn_seeds(test_a_block_that_is_seen_to_be_small_is_not_touched, 1)
    summary = run_scene(load_scene("feasibility-2", ["settle=0.3", f"feasibility.at={at}"]), seed)
    assert summary["completed"]
    assert [(c["step"], c["feasible"]) for c in summary["feasibility"]] == [(4, False)]
    assert len(summary["landings_s"]) == 8 + touches


@pytest.mark.sample(1, each="feasible")
@pytest.mark.parametrize(
    ("scene", "robot", "feasible"),
    [("feasibility-1", "h1", True), ("feasibility-2", "h1", False), ("feasibility-3", "hrp2kai", False)],
)
def test_footholds_are_judged_before_weight_is_put_on_them(scene, robot, feasible):
    summary = run_scene(load_scene(scene, ["settle=0.5"], robot), 0)
    assert summary["completed"]
    assert summary["steps_taken"] == 8
    assert [(c["step"], c["feasible"]) for c in summary["feasibility"]] == [(4, feasible)]
    assert (summary["feasibility"][0]["shift_m"] is None) == feasible
    assert not summary["emergency_stop"]


def test_a_long_way_back_is_followed_by_a_step_past_what_was_refused():
    simulation = Simulation(load_scene("feasibility-4", ["settle=0.5"], "hrp2kai"), 0)
    summary = simulation.run()
    assert summary["completed"]
    (check,) = summary["feasibility"]
    assert check["shift_m"][0] < -0.2
    block = simulation.ground.solids
    plan = simulation.controller.plan.view
    heel = plan.foothold(6).x + simulation.robot.layouts["left"].outline[:, 0].min()
    assert heel > max(solid.position[0] + solid.size[0] for solid in block) + 0.02


@pytest.mark.long
def test_heading_does_not_drift_in_a_long_walk():
    simulation = Simulation(load_scene("uneven"), 1)
    assert simulation.run()["completed"]
    world = simulation.world
    for side, y in (("left", 0.085), ("right", -0.085)):
        assert abs(world.data.site_xpos[world.sole_sites[side]][1] - y) < 0.03


def test_where_there_is_no_way_the_robot_stops():
    simulation = Simulation(load_scene("feasibility-3", ["settle=0.5"]), 0)
    guard = simulation.controller.footing.guard
    guard.rules = replace(guard.rules, attempts=0)
    summary = simulation.run()
    assert summary["emergency_stop"]
    assert not summary["fell"]
    assert not summary["completed"]
    assert summary["final"]["tilt_deg"] < 2.0
    assert simulation.controller.schedule.steps == 5


def test_a_robot_that_does_not_see_the_ground_judges_no_footholds_and_takes_no_shapes():
    blind = Simulation(load_scene("feasibility-1", ["pfc=false"])).settings
    assert (blind.compliance, blind.feasibility, blind.conformity) == (None, None, None)
    sees = Simulation(load_scene("feasibility-1")).settings
    assert None not in (sees.compliance, sees.feasibility, sees.conformity)


@pytest.mark.long
def test_feet_that_take_the_shape_of_bumps_walk_further():
    """Of seeds 0 to 7, 2 fall, and 7 with feet that do not."""

    def upright(*settings: str) -> float:
        """Time in s until they fell or ended, in all."""
        # Of conforming feet alone: bumps that are judged, or taken for partial footholds, make the walk no longer.
        alone = ("footholds=off", "control.feasibility=off", "control.step_adjustment=false", "approach_height=0")
        scene = load_scene("pebbles", ["steps=8", "slope_range=0", *alone, *settings])
        return sum(float(Simulation(scene, seed).run()["sim_time_s"]) for seed in range(8))

    assert upright() > upright("conform=false") + 10.0


@pytest.mark.long
@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("scene", ["obstacle", "tilt", *(f"feasibility-{k}" for k in range(1, 5))])
def test_every_seed_walks_on(scene, seed):
    assert run_scene(load_scene(scene), seed)["completed"]


@pytest.mark.long
def test_a_foot_comes_down_softly_beside_the_slab_that_the_other_one_stands_on():
    seeds = drawn_seeds(test_a_foot_comes_down_softly_beside_the_slab_that_the_other_one_stands_on, 5)
    scene = load_scene("obstacle", ["plant=random"], "hrp2kai")
    check_rate([run_scene(scene, seed)["completed"] for seed in seeds], least=0.9)


def test_a_sole_foresees_the_ground_that_it_comes_to_and_not_that_which_it_leaves():
    """On stones each foothold is another part of the sole: what was seen has to lie where it then carries."""
    seeds = drawn_seeds(test_a_sole_foresees_the_ground_that_it_comes_to_and_not_that_which_it_leaves, 2)
    off = []
    for seed in seeds:
        simulation = Simulation(load_scene("stones", ["steps=8", "settle=0.5"]), seed)
        simulation.run()
        changes = [applied.change for applied in simulation.controller.plan.record]
        seen = {c.step: c.vrp for c in changes if c.reason == "foothold seen"}
        found = {c.step: c.vrp for c in reversed(changes) if c.reason == "foothold found"}  # the first of each
        off += [np.hypot(*np.subtract(seen[step], found[step])) for step in seen.keys() & found.keys()]
    check_rate([distance < 0.1 * simulation.body.sole for distance in off], least=0.9)
