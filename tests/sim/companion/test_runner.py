"""Scenes of the companion: loading, running and judging."""

import numpy as np
import pytest

from plantar.errors import SceneError
from plantar.recordings.recording import read_mcap
from plantar.sim.body_skin.surface import OBSTACLE_GROUP
from plantar.sim.companion import experiment as experiments
from plantar.sim.companion.experiment import Experiment, Verdict, companion_scene, unmet
from plantar.sim.companion.runner import Companion
from plantar.sim.run.run_text import run_text
from plantar.wholebody.stack import TaskStack
from plantar.wholebody.tasks.posture import Posture


class Stand(Experiment):
    """Hold the posture, beside a box that nobody touches."""

    columns = ("error",)

    def __init__(self, machine, settings, control, seed):
        super().__init__(machine, settings, control, seed)
        self.duration = 0.2
        self.error = 0.0

    def add_to(self, spec):
        box = spec.worldbody.add_body(name="box", pos=[3.0, 0.0, 0.5])
        box.add_freejoint()
        box.add_geom(name="box", size=[0.1, 0.1, 0.1], group=OBSTACLE_GROUP, mass=1.0)

    def controller(self, machine, skin):
        stack = TaskStack([[Posture(machine.posture)]])

        class Hold:
            def step(self, robot, reading):
                return stack.step(robot, reading).torque

        return Hold()

    def judge(self, world, sensor, time):
        joints = world.data.qpos[world.positions[-len(self.machine.posture) :]]
        self.error = max(self.error, float(np.abs(joints - self.machine.posture).max()))

    def verdict(self):
        why = unmet((self.error <= 0.01, "posture", self.error, 0.01, "left its posture"))
        return Verdict(why, {"error": self.error})


@pytest.fixture
def scene(monkeypatch, tmp_path):
    monkeypatch.setattr("plantar.sim.companion.experiment.experiment_class", lambda name: Stand)

    def made(*settings, **source):
        table = {"experiment": "stand", "machine": "mobile-arm", **source}
        return companion_scene(table, tmp_path / "stand.toml", settings)

    return made


@pytest.mark.sample(2)
@pytest.mark.parametrize("servo", ["torque", "velocity", "position"])
def test_posture_is_held_with_every_kind_of_drive(scene, servo):
    summary = Companion(scene(f"servo={servo}"), 3).run()
    assert summary["completed"], summary["reasons"]
    assert summary["error"] < 0.01
    assert summary["sim_time_s"] == pytest.approx(0.2)


def test_one_seed_is_one_run(scene):
    first, again, other = (Companion(scene(), seed).run()["error"] for seed in (1, 1, 2))
    assert first == again != other


def test_controller_gets_noise_and_the_judge_does_not(scene):
    companion = Companion(scene("encoder_noise=0.01"), 0)
    qpos, _ = companion.encoders.read()
    apart = qpos - companion.world.data.qpos[companion.world.positions]
    assert 0.001 < np.abs(apart).max() < 0.1


@pytest.mark.parametrize(
    ("rate", "delay", "least", "most"), [(250, 1, 0.004, 0.004), (250, 3, 0.012, 0.012), (200, 0, 0.0, 0.004)]
)
def test_skin_samples_at_its_own_rate_between_control_ticks(scene, rate, delay, least, most):
    companion = Companion(scene(f"skin.rate={rate}", f"skin.delay_periods={delay}", "control.period=0.008"), 0)
    inner, ages = companion.controller, []

    class Watch:
        def step(self, robot, reading):
            ages.append(companion.world.data.time - reading.time)
            return inner.step(robot, reading)

    companion.controller = Watch()
    companion.run()
    assert (min(ages[3:]), max(ages[3:])) == pytest.approx((least, most), abs=1e-9)


def test_settings_reach_every_table(scene):
    made = scene("control.period=0.004", "stiffness=2e7", "machine=planar-arm")
    assert (made.control.period, made.skin.stiffness, made.robot) == (0.004, 2e7, "planar-arm")
    assert made.setting_name("stiffness") == "skin.stiffness"
    assert made.setting_name("machine") == "robot"


@pytest.mark.parametrize(
    ("source", "settings", "words"),
    [
        ({}, ["stifness=1"], "nearest: skin.stiffness"),
        ({"ground": {}}, [], "unknown key 'ground'"),
        ({"machine": ""}, [], "names no machine"),
        ({"experiment": 3}, [], "a name, or a table with kind"),
        ({"control": {"period": 0}}, [], "[control] 'period' is 0"),
    ],
)
def test_bad_scenes_are_refused_in_a_line(scene, source, settings, words):
    with pytest.raises(SceneError) as error:
        scene(*settings, **source)
    assert words in str(error.value)
    assert "\n" not in str(error.value)


def test_unknown_experiment_is_refused_with_the_known_ones():
    with pytest.raises(SceneError, match="unknown experiment 'no-such'"):
        experiments.experiment_class("no-such")


def test_a_run_leaves_its_recording_and_prints_as_walks_do(scene, tmp_path):
    companion = Companion(scene(), 0)
    summary = companion.run_to_files(tmp_path / "a.mcap", None, tmp_path / "plots", None)
    run = read_mcap(tmp_path / "a.mcap")
    assert run.topics["/body_skin"].fields["force"].shape == (100, len(companion.skin.body_skin))
    assert np.ptp(run.topics["/joints"].fields["position"], axis=0).max() < 0.02
    first, *lines = run_text(summary).splitlines()
    assert first == "stand with mobile-arm, seed 0: completed, 0.2 s"
    assert lines[0] == f"  error: {summary['error']:g}"
    assert "x real time; control tick" in lines[1]
