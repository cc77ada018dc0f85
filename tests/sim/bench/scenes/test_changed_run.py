"""Scenes as settings have them, on walks of one step."""

from __future__ import annotations

import hashlib
from pathlib import Path

import numpy as np
import pytest

from plantar.sim.bench.scenes.changed_run import SAMPLE, ChangedRun, TracedRun
from plantar.sim.bench.scenes.scene_runs import SceneCase, SceneRuns
from plantar.sim.bench.scenes.scene_setting import OWN, REFERENCE, SETTINGS, SceneSetting, setting_named
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene

SHORT = ("steps=1", "walk.begin=1.0", "walk.start=0.2", "walk.end=0.2", "walk.settle=0")
STANDING = ("steps=0", "walk.settle=0")


def test_every_setting_has_a_reference_and_a_name_of_its_own() -> None:
    names = [s.name for s in SETTINGS]
    assert len(set(names)) == len(names)
    for setting in SETTINGS:
        against = setting_named(setting.against)
        assert against.quick or not setting.quick
        assert against.machine == setting.machine or setting in (OWN, REFERENCE)


SOON = {"scene's own", "contact points: 1 a taxel", "taxel area: four times", "physics step: 0.5 ms"}


@pytest.mark.parametrize(
    "setting",
    [pytest.param(s, id=s.name, marks=[] if s.name in SOON else [pytest.mark.long]) for s in SETTINGS],
)
def test_every_setting_gives_a_world_with_its_contacts(setting: SceneSetting) -> None:
    run = ChangedRun("flat", "h1", setting, 1, STANDING)
    model = run.world.model
    for side in ("left", "right"):
        soles = list(run.world.sole_geoms[side])
        assert len(soles) == max(1, setting.points * len(run.robot.layouts[side]))
        assert (model.geom_contype[soles] != 0).all()
        assert (model.geom_friction[soles, 0] == 0.8).all()
        wanted = max(5e-3, 2.0 * run.world.period) if setting.contact_time is None else setting.contact_time
        assert model.geom_solref[soles, 0] == pytest.approx(wanted)
        lowest = model.geom_pos[soles, 2] - np.where(
            setting.points, model.geom_size[soles, 0], model.geom_size[soles, 2]
        )
        box = model.geom(f"{side}_sole_box").id
        assert lowest == pytest.approx(float(model.geom_pos[box, 2] - model.geom_size[box, 2]))
        own, cells = Simulation(load_scene("flat", STANDING, "h1")).robot.layouts[side], run.robot.layouts[side]
        assert cells.cell_area == pytest.approx(setting.cell_ratio * own.cell_area)
    assert setting.iterations is None or model.opt.iterations == setting.iterations
    assert model.opt.timestep == pytest.approx(run.scene.control.physics_period)
    assert round(SAMPLE / run.world.period) * run.world.period == pytest.approx(SAMPLE)


def test_keeping_a_motion_does_not_change_it() -> None:
    motions = []
    for kind in (Simulation, TracedRun):
        if kind is Simulation:
            run = Simulation(load_scene("flat", SHORT, "h1"), 3)
        else:
            run = TracedRun("flat", "h1", OWN, 3, SHORT)
        run.run()
        motions.append(hashlib.sha256(run.world.data.qpos.tobytes()).hexdigest())
    assert motions[0] == motions[1]


def test_a_standing_robot_is_carried_below_its_centre_of_mass() -> None:
    for name in ("scene's own", "contact points: 1 a taxel"):
        run = TracedRun("flat", "h1", setting_named(name), 1, STANDING, noisy=False)
        run.run()
        trace = run.trace()
        assert trace.force[-20:].sum(axis=1) == pytest.approx(trace.weight, rel=0.01)
        assert trace.zmp[-20:] == pytest.approx(trace.com[-20:, :2], abs=2e-3)
        assert run.keeping_s > 0.0


@pytest.mark.long
def test_runs_are_appended_once(tmp_path: Path) -> None:
    settings = [OWN, REFERENCE, setting_named("solver iterations: 5")]
    case = SceneCase("flat", "h1", STANDING)
    told: list[str] = []
    for _ in range(2):
        SceneRuns(tmp_path).run([case], settings, [1], 1, lambda _, text: told.append(text))
    rows = SceneRuns(tmp_path).rows
    assert len(rows) == 7 == len(told) / 2  # three without noise, one for the noise itself, three with it
    own = next(r for r in rows if (r["setting"], r["kind"]) == (OWN.name, "traced"))
    assert 0.0 < float(own["com_mm"]) < 1.0
    assert all(float(r["cpu_s"]) > 0.0 for r in rows)
    assert next(r["com_mm"] for r in rows if r["setting"] == REFERENCE.name) == "0.0000"
