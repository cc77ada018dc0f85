"""Scenes as settings have them, on walks of one step."""

import hashlib
from dataclasses import replace

import numpy as np
import pytest

from plantar.sim.bench.scenes.changed_run import PARTED, SAMPLE, ChangedRun, Trace, TracedRun, trace_error
from plantar.sim.bench.scenes.scene_runs import SceneCase, SceneRuns
from plantar.sim.bench.scenes.scene_setting import OWN, REFERENCE, SETTINGS, setting_named
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene

SHORT = ("steps=1", "walk.begin=1.0", "walk.start=0.2", "walk.end=0.2", "walk.settle=0")
STANDING = ("steps=0", "walk.settle=0")


def test_every_setting_has_a_reference_and_a_name_of_its_own():
    names = [s.name for s in SETTINGS]
    assert len(set(names)) == len(names)
    for setting in SETTINGS:
        against = setting_named(setting.against)
        assert against.quick or not setting.quick
        assert against.machine == setting.machine or setting in (OWN, REFERENCE)


SOON = {"scene's own", "taxel area: four times", "physics step: 0.5 ms"}


@pytest.mark.parametrize(
    "setting", [pytest.param(s, id=s.name, marks=[] if s.name in SOON else [pytest.mark.long]) for s in SETTINGS]
)
def test_every_setting_gives_a_world_with_its_contacts(setting):
    run = ChangedRun("flat", "h1", setting, 1, STANDING)
    model = run.world.model
    for side in ("left", "right"):
        soles = list(run.world.sole_geoms[side])
        assert len(soles) == 1
        assert (model.geom_contype[soles] != 0).all()
        assert (model.geom_friction[soles, 0] == 0.8).all()
        wanted = max(5e-3, 2.0 * run.world.period) if setting.contact_time is None else setting.contact_time
        assert model.geom_solref[soles, 0] == pytest.approx(wanted)
        own, cells = Simulation(load_scene("flat", STANDING, "h1")).robot.layouts[side], run.robot.layouts[side]
        assert cells.cell_area == pytest.approx(setting.cell_ratio * own.cell_area)
    assert setting.iterations is None or model.opt.iterations == setting.iterations
    assert model.opt.timestep == pytest.approx(run.scene.control.physics_period)
    assert round(SAMPLE / run.world.period) * run.world.period == pytest.approx(SAMPLE)


def test_keeping_a_motion_does_not_change_it():
    motions = []
    for kind in (Simulation, TracedRun):
        if kind is Simulation:
            run = Simulation(load_scene("flat", SHORT, "h1"), 3)
        else:
            run = TracedRun("flat", "h1", OWN, 3, SHORT)
        run.run()
        motions.append(hashlib.sha256(run.world.data.qpos.tobytes()).hexdigest())
    assert motions[0] == motions[1]


def test_a_standing_robot_is_carried_below_its_centre_of_mass():
    run = TracedRun("flat", "h1", OWN, 1, STANDING, noisy=False)
    run.run()
    trace = run.trace()
    assert trace.force[-20:].sum(axis=1) == pytest.approx(trace.weight, rel=0.01)
    assert trace.zmp[-20:] == pytest.approx(trace.com[-20:, :2], abs=2e-3)
    assert run.keeping_s > 0.0


@pytest.mark.long
def test_every_run_is_measured_next_to_its_reference():
    settings = [OWN, REFERENCE, setting_named("solver iterations: 5")]
    cases = SceneRuns().cases([SceneCase("flat", "h1", STANDING)], settings, [1], 1)
    assert len({case.key for case in cases}) == 7  # three without noise, one for the noise itself, three with it
    rows = {case.key: case.measure()[0] for case in cases}
    own = next(r for key, r in rows.items() if (key[3], key[5]) == (OWN.name, "traced"))
    assert 0.0 < float(own["com_mm"]) < 1.0
    assert all(float(r["cpu_s"]) > 0.0 for r in rows.values())
    assert next(r["com_mm"] for key, r in rows.items() if key[3] == REFERENCE.name) == "0.0000"


RNG = np.random.default_rng(0)
STILL = Trace(
    com=RNG.normal(size=(200, 3)),
    zmp=RNG.normal(size=(200, 2)),
    force=RNG.uniform(0.0, 800.0, (200, 2)),
    landings=(("left", 0.5, 200.0), ("right", 1.5, 400.0)),
    leg=0.6,
    weight=800.0,
)


def test_a_run_is_its_own_reference():
    error = trace_error(STILL, STILL)
    assert error[:4] == (0.0, 0.0, 0.0, 0.0)
    assert error.together_s == pytest.approx(2.0)


@pytest.mark.parametrize("size", [1e-9, 1e-4, 0.9 * PARTED * 0.6])
def test_a_constant_offset_is_the_error(size):
    shifted = replace(
        STILL,
        com=STILL.com + np.array([size, 0.0, 0.0]),
        zmp=STILL.zmp + np.array([0.0, 2.0 * size]),
        force=STILL.force + 8.0,
        landings=(("left", 0.51, 220.0), ("right", 1.5, 360.0)),
    )
    error = trace_error(shifted, STILL)
    assert error.com_m == pytest.approx(size)
    assert error.zmp_m == pytest.approx(2.0 * size)
    assert error.force == pytest.approx(0.01)
    assert error.impact == pytest.approx(0.1)
    assert error.together_s == pytest.approx(2.0)


@pytest.mark.parametrize("at", [1, 60, 199])
def test_what_comes_after_runs_part_does_not_count(at):
    com, force = STILL.com.copy(), STILL.force.copy()
    com[at:, 1] += 1.01 * PARTED * 0.6
    force[at:] += 1e6
    error = trace_error(replace(STILL, com=com, force=force), STILL)
    assert error.together_s == pytest.approx(at * SAMPLE)
    assert error.com_m == error.force == 0.0
    assert np.isnan(error.impact) == (at < 50)


def test_landings_of_another_foot_or_time_are_not_compared():
    other = replace(STILL, landings=(("left", 0.5, 300.0), ("left", 1.5, 0.0)))
    assert trace_error(other, STILL).impact == pytest.approx(0.5)
    late = replace(STILL, landings=(("left", 0.6, 300.0),))
    assert np.isnan(trace_error(late, STILL).impact)


def test_a_shorter_run_is_compared_as_far_as_it_goes_and_nothing_carried_is_no_error():
    zmp = STILL.zmp[:50].copy()
    zmp[10:20] = np.nan
    cut = replace(STILL, com=STILL.com[:50], zmp=zmp, force=STILL.force[:50])
    error = trace_error(cut, STILL)
    assert (error.zmp_m, error.together_s) == (0.0, pytest.approx(0.5))
