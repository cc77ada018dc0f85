"""Short walks, judged by MuJoCo's truth."""

import json
import subprocess
import sys
from shutil import copytree

import numpy as np
import pytest

from plantar.errors import InputError, SceneError
from plantar.recordings.recording import read_mcap
from plantar.robots import load_robot
from plantar.sim.run.runner import Simulation, run_scene
from plantar.sim.run.scene import load_scene
from plantar.sim.run.scene_kind import run

MOTION = ("landings_s", "impacts_N", "tilt_max_deg", "zmp_margin_min_m", "final", "estimate", "contact_area_ratio")


def test_four_steps_are_walked_upright_and_on_plan(short_run):
    summary, _ = short_run
    assert summary["completed"]
    assert not summary["fell"]
    assert summary["steps_taken"] == summary["steps_planned"] == 4
    assert summary["landing_sides"] == ["left", "right", "left", "right"]
    assert summary["tilt_max_deg"] < 4.0  # the trunk leans over the stance foot by 0.8 rad for each metre to it
    assert summary["zmp_margin_min_m"] > 0.03
    assert summary["final"]["position_error_m"] < 0.02
    assert summary["final"]["heading_error_deg"] < 1.0
    assert max(summary["estimate"]["com_error_max_m"]) < 0.02
    assert min(summary["contact_area_ratio"]) > 0.99
    assert max(summary["impacts_N"]) < 86 * 9.81


def test_the_summary_holds_what_the_contract_names(short_run):
    names = {
        "scene",
        "robot",
        "seed",
        "completed",
        "reasons",
        "emergency_stop",
        "fell",
        "steps_planned",
        "steps_taken",
        "sim_time_s",
        "wall_time_s",
        "real_time_factor",
        "tilt_max_deg",
        "zmp_margin_min_m",
        "impacts_N",
        "contact_area_ratio",
        "replans",
        "out_of_reach_since_s",
        "control_us",
        "skipped",
    }
    assert names <= set(short_run[0])
    assert set(short_run[0]["control_us"]) == {"p50", "p99"}


def test_recording_leaves_the_motion_the_same_to_the_last_bit(tmp_path):
    plain, recorded = (Simulation(load_scene("flat", ["steps=1", "settle=0.3", "end=0.2"]), 0) for _ in range(2))
    without, record = plain.run(), recorded.run(record=tmp_path / "run.mcap")
    assert np.array_equal(plain.world.data.qpos, recorded.world.data.qpos)
    for name in MOTION:
        assert record[name] == without[name]


def test_the_door_takes_paths_as_texts(tmp_path):
    scene = load_scene("flat", ["steps=1", "settle=0.3", "end=0.2"])
    summary = run(scene, record=str(tmp_path / "run.mcap"), plot=str(tmp_path / "plots"))
    assert (tmp_path / "run.mcap").exists()
    assert all((tmp_path / "plots" / name.rpartition("/")[2]).exists() for name in summary["figures"])


@pytest.mark.parametrize(("kind", "name", "ending"), [("record", "run.txt", ".mcap"), ("video", "run.gif", ".mp4")])
def test_a_file_of_another_kind_is_refused_before_the_run(kind, name, ending):
    with pytest.raises(InputError, match=f"{kind} {name} needs a name that ends in {ending}"):
        run("flat", **{kind: name})


def test_another_seed_is_another_walk(short_run, short_scene):
    assert run_scene(short_scene, 1)["impacts_N"] != short_run[0]["impacts_N"]


def test_the_recording_tells_the_walk(short_run):
    summary, path = short_run
    run = read_mcap(path)
    assert not run.warnings
    assert set(run.layouts) == {"left", "right"}
    skin = run.topics["/skin/left"]
    assert np.diff(skin.time) == pytest.approx(np.full(len(skin) - 1, 0.004))
    assert skin.fields["force"].shape[1] == len(run.layouts["left"])
    body = run.topics["/truth/body"]
    assert np.diff(body.time) == pytest.approx(np.full(len(body) - 1, 0.005))
    least = float(np.nanmin(body.fields["zmp_margin"]))  # of the ticks; the summary's is that of all physics steps
    assert summary["zmp_margin_min_m"] - 1e-5 <= least <= summary["zmp_margin_min_m"] + 0.01
    estimate = run.topics["/estimate"].fields["com"]
    assert np.abs(estimate - body.fields["com"]).max(axis=0) == pytest.approx(
        summary["estimate"]["com_error_max_m"], abs=1e-4
    )
    # The taxels' sum against the true ground force, where the noise of 42 taxels is all that may differ.
    force = skin.fields["force"].sum(axis=1)
    truth = np.interp(skin.time, run.topics["/truth/left"].time, run.topics["/truth/left"].fields["normal_force"][:, 0])
    assert np.median(np.abs(force - truth)) < 3 * 1.4715 * np.sqrt(42)
    # After the walk the feet do not press against each other by their edges: each carries half.
    last = [run.topics[f"/truth/{side}"].fields["normal_force"][-1, 0] for side in ("left", "right")]
    assert last[0] / sum(last) == pytest.approx(0.5, abs=0.05)


def test_a_fall_is_seen_and_ends_the_run():
    summary = run_scene(
        load_scene("push", ["steps=4", "impulse=90", "push.step=1", "direction=right", "feedback=false"]), 0
    )
    assert summary["fell"]
    assert not summary["completed"]
    assert summary["sim_time_s"] < 9.0


@pytest.mark.sample(1)
@pytest.mark.parametrize("step", [1, 2])
def test_feedback_survives_a_push_that_an_open_loop_does_not(step):
    """32 N s from the front; 25 N s were within what stiff servos, a lean and the next step survive by themselves."""
    settings = ["steps=4", "settle=1.0", "impulse=32", "direction=backward", f"push.step={step}"]
    with_feedback = run_scene(load_scene("push", settings), 0)
    assert with_feedback["completed"], with_feedback["reasons"]
    open_loop = Simulation(load_scene("push", [*settings, "feedback=false"]), 0)
    open_loop.controller.shell = None  # it would stop a robot that loses its balance, before it falls
    without = open_loop.run()
    assert not without["completed"]
    assert {r["criterion"] for r in without["reasons"]} & {"fall", "collision"}


def test_standing_is_a_walk_of_no_steps():
    summary = run_scene(load_scene("flat", ["steps=0", "settle=0.5"]), 0)
    assert summary["completed"]
    assert summary["steps_planned"] == 0
    assert summary["final"]["position_error_m"] < 0.005


@pytest.mark.sample(2)
@pytest.mark.parametrize(
    ("settings", "position"),
    [
        (["length=-0.15"], 0.05),
        (["length=0.0", "sideways=0.08"], 0.05),
        (["first=right", "length=0.1"], 0.05),
        (["terrain.height=-0.7"], 0.05),
    ],
)
def test_other_gaits_walk_too(settings, position):
    scene = load_scene("flat", ["steps=4", "settle=1.0", *settings])
    summary = run_scene(scene, 0)
    assert summary["completed"], summary
    assert summary["final"]["position_error_m"] < position


@pytest.mark.long
@pytest.mark.parametrize("robot", ["h1", "hrp2kai"])
@pytest.mark.parametrize("seed", range(10))
def test_twenty_steps(seed, robot):
    summary = run_scene(load_scene("flat", robot=robot), seed)
    assert summary["completed"]
    assert summary["steps_taken"] == 20
    assert summary["tilt_max_deg"] < 3.0


@pytest.mark.long
@pytest.mark.parametrize("robot", ["h1", "hrp2kai"])
@pytest.mark.parametrize("seed", range(20))
def test_pushes_are_survived(seed, robot):
    assert run_scene(load_scene("push", robot=robot), seed)["completed"]


def test_hrp2kai_walks_by_its_own_law_and_at_its_own_pace():
    summary = run_scene(load_scene("flat", ["steps=2", "settle=0.5"], "hrp2kai"), 0)
    assert summary["completed"]
    assert summary["zmp_margin_min_m"] > 0.03
    states = summary["wrench_distribution"]
    assert states["tracked"] > 0.95 * sum(states.values())
    assert summary["landings_s"][1] - summary["landings_s"][0] == pytest.approx(1.9, abs=0.15)
    quicker = run_scene(load_scene("flat", ["steps=2", "settle=0.5", "t_ss=1.0", "t_ds=0.4"], "hrp2kai"), 0)
    assert quicker["completed"]
    assert quicker["landings_s"][1] - quicker["landings_s"][0] == pytest.approx(1.4, abs=0.15)


def test_steps_beyond_the_legs_reach_are_pointed_out(short_run):
    assert short_run[0]["out_of_reach_since_s"] is None
    wide = ["steps=2", "length=0.33", "sideways=0.1", "settle=0.5", "crouch=0"]
    late = run_scene(load_scene("flat", wide))["out_of_reach_since_s"]
    assert 2.2 < late < 4.0  # in the first step, whose foot leads by 0.33 m forward and 0.1 m to the side
    assert run_scene(load_scene("flat", [*wide, "crouch=0.05"]))["out_of_reach_since_s"] is None


@pytest.mark.parametrize(("floor", "words"), [(-2.0, "lower"), (0.5, "higher")])
def test_ground_that_is_not_under_the_feet_is_an_error(floor, words):
    with pytest.raises(SceneError, match=rf"does not keep standing.* {words} .*height of 0 m") as caught:
        run_scene(load_scene("flat", ["kind=course", f"floor={floor}", "steps=0"]))
    assert "\n" not in str(caught.value)


def test_the_controllers_settings_do_not_depend_on_the_ground():
    ground = {
        "flat": ["kind=flat"],
        "uneven": ["kind=uneven"],
        "stones": ["kind=stones"],
        "beam": ["kind=beam"],
        "pebbles": ["kind=pebbles"],
    }
    made = [Simulation(load_scene("flat", ["steps=2", *terrain], "hrp2kai")).settings for terrain in ground.values()]
    robot = load_robot("hrp2kai")
    height = robot.com_height - robot.largest_crouch
    assert all(settings.com_height == pytest.approx(height) for settings in made)
    assert all(settings.standing_legs == made[0].standing_legs for settings in made)


def test_a_sole_with_a_waist_walks_on_the_hull_of_its_outline(tmp_path, repository):
    folder = copytree(repository / "plantar" / "robots" / "h1", tmp_path / "waisted")
    for side in ("left", "right"):
        layout = json.loads((folder / f"layout_{side}.json").read_text())
        ring = np.array(layout["outline"])
        ahead = np.roll(ring, -1, 0) - ring
        k = np.hypot(*ahead.T).argmax()  # the longest edge, 3 mm inwards at its middle
        inwards = np.array([-ahead[k, 1], ahead[k, 0]]) / np.hypot(*ahead[k])
        layout["outline"] = np.insert(ring, k + 1, ring[k] + 0.5 * ahead[k] + 0.003 * inwards, 0).tolist()
        (folder / f"layout_{side}.json").write_text(json.dumps(layout))
    run = Simulation(load_scene("flat", ["steps=2", "settle=0.2"], str(folder / "robot.toml")))
    assert run.run()["reasons"] == []
    assert run.controller.raised == (0, "")


def test_a_controller_that_raises_has_not_completed():
    run = Simulation(load_scene("flat", ["steps=0", "settle=0.2"]))
    shell = run.controller.shell
    healthy, ticks = shell._tick, iter(range(10**6))
    shell._tick = lambda sensors: healthy(sensors) if next(ticks) % 7 else healthy(None)
    (reason,) = run.run()["reasons"]
    assert reason["criterion"] == "controller_error"
    assert reason["value"] == run.controller.raised[0] > 10
    assert "the last: AttributeError: 'NoneType'" in reason["text"]


def test_a_run_looks_for_garbage_among_its_own_objects_only():
    """A full collection among all that is imported takes 50 ms and more: ten control periods."""
    code = (
        "import gc\n"
        "from plantar.sim.run.runner import Simulation\n"
        "from plantar.sim.run.scene import load_scene\n"
        "class Looked(Simulation):\n"
        "    end = 0.05\n"
        "    def control(self):\n"
        "        seen.append((gc.get_freeze_count(), len(gc.get_objects())))\n"
        "        return super().control()\n"
        "seen = []\n"
        "Looked(load_scene('flat'), 0).run()\n"
        "frozen, own = seen[-1]\n"
        "assert frozen > 20 * own, seen[-1]\n"
        "assert gc.get_freeze_count() == 0\n"
        "gc.freeze()\n"
        "Looked(load_scene('flat'), 0).run()\n"
        "assert gc.get_freeze_count() > 0  # what the caller froze stays so\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize(
    ("scene", "settings"), [("stones", ["steps=2"]), ("balance", ["walk.settle=6", "push.count=1"])]
)
def test_steps_in_one_kernel_are_those_made_one_by_one(scene, settings):
    class ByOne(Simulation):
        def reset(self):
            super().reset()
            self._together = None

    class Kept(Simulation):
        made = 0

        def step_physics(self):
            self.made += 1
            super().step_physics()

    ends = []
    for kind in (Simulation, ByOne, Kept):
        run = kind(load_scene(scene, settings), 3)
        summary = run.run()
        for timed in ("wall_time_s", "real_time_factor", "control_us"):
            del summary[timed]
        ends.append((summary, run.world.data.qpos.tolist(), run.judge.margin_min))
    assert run.made == round(run.world.data.time / run.world.period)
    assert ends[0] == ends[1] == ends[2]
    if run.pusher.shoves:
        assert len(run.pusher.applied) == len(run.pusher.shoves)
