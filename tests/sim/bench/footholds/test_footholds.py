"""The benchmark of footholds: policies are loaded, run, judged and resumed; what is wrong with one is named."""

import dataclasses
import inspect
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

from plantar import InputError
from plantar.bench.kind import BenchOptions
from plantar.gait.plan.plan_change import MovedStep
from plantar.sim.bench.footholds import measure_footholds as module
from plantar.sim.bench.footholds.foothold_run import TRIALS, FootholdResult, TrialRun, run_trial, scene_of_trial
from plantar.sim.bench.footholds.measure_footholds import FOOTHOLDS
from plantar.sim.bench.footholds.policy import BASELINES, Action, OwnController, load_policy
from plantar.sim.bench.runner import Benched, run_kind

EXAMPLE = Path(__file__).resolve().parents[4] / "examples" / "own_policy.py"
SHORT = TRIALS[0]._replace(tables={"terrain": {"kind": "flat"}, "walk": {"steps": 2, "settle": 0.2}})


class Stiff(NamedTuple):
    """Holds what it is given."""

    action: Action

    def step(self, sensors):
        return self.action


def test_the_own_controller_takes_its_steps_and_a_standing_policy_none():
    own = run_trial(OwnController, SHORT)
    assert own.completed
    assert own.failed == ()
    assert (own.steps, own.planned) == (2, 2)
    assert own.froude > 0.0
    still = run_trial(lambda task: Stiff(Action(task.stance.angles, task.stance.torques)), SHORT)
    assert (still.completed, still.steps, still.fell) == (False, 0, False)
    assert "steps" in still.failed


def test_a_policy_that_falls_is_seen():
    def make(task):
        return Stiff(Action(task.stance.angles - 0.5 * np.array(["ankle_pitch" in name for name in task.joints])))

    fell = run_trial(make, SHORT)
    assert fell.fell
    assert not fell.completed


@pytest.mark.parametrize(
    ("step", "words"),
    [
        (lambda s: (np.zeros(3), None, ()), "expected 12 finite ones"),
        (lambda s: (np.full(12, np.nan), None, ()), "finite"),
        (lambda s: 1 / 0, r"policy raised ZeroDivisionError: .* \(test_footholds\.py, line \d+\)"),
        (lambda s: 3, "returned 3; allowed: Action"),
        (None, "allowed: an object with a method step"),
    ],
)
def test_what_a_policy_does_wrong_is_named(step, words):
    policy = type("Wrong", (), {"step": staticmethod(step)})()
    with pytest.raises(InputError, match=words):
        run_trial(lambda task: policy, SHORT)


class Swaying:
    """A policy of the environments that remembers what it saw."""

    def __init__(self, joints):
        self.rng = np.random.default_rng(3)
        self.joints = joints
        self.seen = []

    def act(self, observation):
        self.seen.append(observation)
        return 0.05 * self.rng.standard_normal(self.joints)


def test_a_policy_of_the_environment_is_judged_as_it_is():
    gymnasium = pytest.importorskip("gymnasium")
    trial = next(t for t in TRIALS if (t.kind, t.value) == ("push", 0.4))
    env = gymnasium.make("plantar.sim.environments:PlantarFootholds-v0", kind="push", value=0.4)
    seen, _ = env.reset(seed=0, options={"seed": 5})
    assert env.observation_space.contains(seen)
    own = Swaying(env.action_space.shape[0])
    over = False
    while not over:
        seen, reward, over, truncated, info = env.step(own.act(seen))
        assert np.isfinite(reward)
        assert not truncated
    judged = []

    def make(task):
        judged.append(Swaying(len(task.joints)))
        return judged[0]

    found = run_trial(make, trial, seed=5)
    assert found.fell
    assert (info["completed"], info["steps"], info["fell"], info["failed"]) == (
        found.completed,
        found.steps,
        found.fell,
        found.failed,
    )
    assert len(own.seen) == len(judged[0].seen)
    for one, other in zip(own.seen, judged[0].seen, strict=True):
        assert one.keys() == other.keys()
        assert all(np.array_equal(one[name], other[name]) for name in one)
    with pytest.raises(InputError, match="act returned"):
        run_trial(lambda task: type("Wrong", (), {"act": staticmethod(lambda seen: [1.0])})(), SHORT)


def test_the_action_zero_and_a_net_force_are_policies_of_every_trial():
    zero = run_trial(BASELINES["zero"], SHORT)
    assert (zero.completed, zero.steps) == (False, 0)
    for name in ("net-force", "ankles"):
        assert run_trial(BASELINES[name], SHORT).steps == 2, name


def test_a_commanded_velocity_is_observed_and_judged():
    trial = next(t for t in TRIALS if t.kind == "velocity")
    short = trial._replace(tables={"terrain": {"kind": "flat"}, "walk": {**trial.tables["walk"], "until": 1.0}})
    seen = []

    class Standing:
        def act(self, observation):
            seen.append(observation["task"])
            return np.zeros(12)

    found = run_trial(lambda task: Standing(), short)
    assert not found.completed
    assert "speed_ratio" in found.failed
    assert np.allclose(np.max(seen, axis=0), [trial.value, 0.0, 0.0])


@pytest.mark.parametrize("robot", ["h1", "hrp2kai"])
def test_a_walk_by_velocity_has_the_time_to_come_to_rest(robot):
    """It was cut off in its last steps, so that no policy could complete a trial."""
    trial = next(t for t in TRIALS if t.kind == "velocity")
    short = trial._replace(tables={"terrain": {"kind": "flat"}, "walk": {**trial.tables["walk"], "until": 3.0}})
    found = run_trial(BASELINES["plantar"], short, robot)
    assert "rest" not in found.failed
    assert "stop" not in found.failed


def test_files_that_are_no_policy_are_refused(tmp_path):
    assert callable(load_policy(EXAMPLE))
    with pytest.raises(InputError, match="no Python file"):
        load_policy(tmp_path / "missing.py")
    for text, words in (("1 / 0", "ZeroDivisionError"), ("x = 1", "no function make_policy")):
        (tmp_path / "my.py").write_text(text)
        with pytest.raises(InputError, match=words):
            load_policy(tmp_path / "my.py")


@pytest.mark.parametrize("robot", ["h1", "hrp2kai"])
def test_every_trial_is_a_scene_of_every_robot(robot):
    for trial in TRIALS:
        scene = scene_of_trial(trial, robot)
        assert scene.walk.commanded if trial.kind == "velocity" else scene.walk.steps == 8
        assert scene.terrain.kind == trial.tables["terrain"]["kind"]


def measured(folder: Path, policy: Path | None, seeds: int, *kinds: str) -> Benched:
    return run_kind(FOOTHOLDS, BenchOptions(policy=policy, seeds=seeds, scene=kinds), folder, lambda *_: None)


def test_a_table_grows_and_continues(tmp_path, monkeypatch):
    ran = []

    def fake(make, trial, robot, seed):
        ran.append((trial.kind, seed))
        return FootholdResult(seed > 0, 8 * (seed > 0), 8, seed == 0, 3.0, 0.01, 12.0)

    monkeypatch.setattr(module, "run_trial", fake)
    measured(tmp_path, None, 1, "push")
    done = measured(tmp_path, EXAMPLE, 4, "push")
    assert len(ran) == 4 * len(BASELINES) + 16
    assert len(measured(tmp_path, EXAMPLE, 4, "push").result["rows"]) == 4 * len(BASELINES) + 4
    assert len(ran) == 4 * len(BASELINES) + 16
    own = done.result["rows"][-1]
    assert own["policy"].startswith("own_policy-")
    assert (own["completed"], own["fell"], own["runs"]) == (0.75, 0.25, 4)
    assert own["low"] < 0.75 < own["high"]
    assert "push 0.4 sqrt(g l)" in done.text
    assert done.text in (tmp_path / "footholds.md").read_text()


def test_a_policy_that_was_changed_is_another_one(tmp_path, monkeypatch):
    policy = tmp_path / "my.py"
    monkeypatch.setattr(module, "run_trial", lambda *_: FootholdResult(True, 8, 8, False, 3.0, 0.01, 12.0))
    for text in ("make_policy = print", "make_policy = len", "make_policy = print"):
        policy.write_text(text)
        done = measured(tmp_path, policy, 1, "flat")
    assert len({row["policy"] for row in done.result["rows"]}) == 2
    assert [row["runs"] for row in done.result["rows"]] == [1, 1]


@pytest.mark.parametrize(("seeds", "kinds"), [(0, ()), (1, ("lava",))])
def test_wrong_questions_are_refused(seeds, kinds, tmp_path):
    with pytest.raises(InputError, match="allowed: 1 or more of flat, beam, stones, slopes, steps, push, velocity"):
        measured(tmp_path, None, seeds, *kinds)


def simulation():
    """The simulation that runs this policy: what a policy that looks for it finds."""
    frame = inspect.currentframe()
    while not isinstance(frame.f_locals.get("under_way"), TrialRun):
        frame = frame.f_back
    return frame.f_locals["under_way"].run


class Cheat(OwnController):
    """The own controller, and something besides at every tick."""

    def __init__(self, task, cheat):
        super().__init__(task)
        self._cheat = cheat

    def step(self, sensors):
        action = super().step(sensors)
        return self._cheat(sensors.time, action) or action


def lift(time, action):
    simulation().world.data.xfrc_applied[simulation().world.torso, 2] = 400.0


def hold(time, action):
    simulation().world.data.qfrc_applied[simulation().world.joint_qvel[0]] = 1.0


def lie(time, action):
    steps = simulation().steps
    return action._replace(moved=[MovedStep(k, 0.6 * step.x, step.y, step.yaw, "x") for k, step in enumerate(steps)])


STOPPED = {}


def stop_early(time, action):
    return STOPPED.setdefault("action", action) if time > 2.5 else None


def slide(time, action):
    model = simulation().world.model
    model.geom_friction[:, 0], model.geom_priority[:] = 1e-3, 1
    model.opt.gravity[0] = 0.3


def kneel(time, action):
    knees = np.array([2.0 * ("knee" in n) - 1.4 * ("hip_pitch" in n) for n in KNEES])
    return Action(action.angles + min(1.0, max(0.0, time - 1.0)) * knees)


def weigh_less(time, action):
    simulation().world.model.opt.gravity[2] = -8.0


def lean(time, action):
    """On a partner that nobody sees: a spring that goes along with the base."""
    world = simulation().world
    model = world.model
    joint = model.body_jntadr[model.body_rootid[world.torso]]
    model.jnt_stiffness[joint] = 2000.0
    model.qpos_spring[:7] = world.data.qpos[:7]
    model.qpos_spring[2] += 0.02


KNEES = [
    f"{side}_{joint}"
    for side in ("left", "right")
    for joint in ("hip_yaw", "hip_roll", "hip_pitch", "knee", "ankle_pitch", "ankle_roll")
]


@pytest.mark.sample(1, each="reason")
@pytest.mark.parametrize(
    ("cheat", "reason"),
    [
        (lift, "outside_force"),
        (hold, "outside_force"),
        (lean, "outside_force"),
        (stop_early, "steps"),
        (slide, "steps"),
        (kneel, "fall"),
        (weigh_less, "stance_force"),
        (lambda time, action: Action(action.angles * 0.6, action.torques), "steps"),
    ],
)
def test_a_policy_that_cheats_is_refused_with_the_reason(cheat, reason):
    found = run_trial(lambda task: Cheat(task, cheat), SHORT)
    assert not found.completed
    assert reason in found.failed


@pytest.mark.long
def test_places_that_a_policy_names_without_a_reason_of_the_ground_are_none_of_its_steps():
    """It walks shorter steps than asked for, and reports each as moved."""

    def short(task):
        return Cheat(replace_length(task), lie)

    found = run_trial(short, SHORT._replace(tables={"terrain": {"kind": "flat"}, "walk": {"steps": 4, "length": 0.2}}))
    assert "steps" in found.failed


def replace_length(task):
    return dataclasses.replace(task, walk={**task.walk, "length": 0.12})


def test_a_policy_that_steps_over_every_other_stone_is_refused():
    """Two steps in one: its feet are elsewhere, and the stones between carry nothing."""
    trial = next(t for t in TRIALS if (t.kind, t.value) == ("stones", 0.8))

    def over(task):
        return OwnController(dataclasses.replace(task, walk={**task.walk, "steps": 3, "length": "0.5 leg"}))

    found = run_trial(over, trial)
    assert not found.completed
    assert {"steps", "stood_on"} <= set(found.failed)


def test_standing_beside_the_stones_does_not_count():
    trial = next(t for t in TRIALS if (t.kind, t.value) == ("stones", 0.8))
    still = run_trial(lambda task: Stiff(Action(task.stance.angles, task.stance.torques)), trial)
    assert {"steps", "stood_on"} <= set(still.failed)
