"""The commands sim, sweep and demo as a user calls them: exit codes, one line for bad input, nothing left behind."""

import json
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from plantar import cli, read
from plantar.commands.analyze import analyze
from plantar.layouts.contact_levels import contact_levels

SHORT = ["--set", "steps=2", "--set", "settle=0.2"]


def plantar(*arguments: str | Path, cwd: Path) -> subprocess.CompletedProcess[str]:
    command = [str(Path(sys.executable).parent / "plantar"), *map(str, arguments)]
    return subprocess.run(command, cwd=cwd, capture_output=True, text=True, timeout=600)


def test_sim_prints_one_json_object_and_writes_what_was_asked_into_folders_that_it_makes(tmp_path):
    hard = ["--set", "pfc=false"]  # a foot that gives way lands with 20 N, which its taxels' noise hides for a while
    run = plantar("sim", "flat", *SHORT, *hard, "--json", "--record", "a/b/run.mcap", "--plot", "c/d", cwd=tmp_path)
    assert run.returncode == 0, run.stderr
    summary = json.loads(run.stdout)
    assert summary["completed"]
    assert summary["steps_taken"] == 2
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a", "c"]
    assert [p.name for p in (tmp_path / "a" / "b").iterdir()] == ["run.mcap"]
    assert (tmp_path / "a" / "b" / "run.mcap").stat().st_size > 0
    drawn = ["balance.png", "feet.png", "footholds.png", "plane.png"]
    assert sorted(p.name for p in (tmp_path / "c" / "d").iterdir()) == drawn
    back = plantar("analyze", "a/b/run.mcap", "-o", "analysis", "--json", cwd=tmp_path)
    assert back.returncode == 0, back.stderr
    feet = json.loads(back.stdout)["feet"]
    landings = sorted([*feet["left"]["landings_s"], *feet["right"]["landings_s"]])
    recorded = read(tmp_path / "a" / "b" / "run.mcap")
    seen = [seen_landing(recorded, time) for time in summary["landings_s"]]
    assert landings == pytest.approx(seen, abs=0.010)


def seen_landing(recorded, time: float) -> float:
    """When a sole is first loaded beyond its noise for 20 ms, from a true landing on: a soft one is hidden at first."""
    begins = []
    for foot in recorded.feet.values():
        level = contact_levels(foot.layout.noise["force"], len(foot.layout)).sole
        after = (recorded.time > time - 0.005) & (recorded.time < time + 0.3)
        loaded = foot.vertical_force[after] > level
        if loaded[0]:
            continue  # the sole that stands
        lasts = round(0.020 / float(np.median(np.diff(recorded.time))))
        first = next(k for k in range(len(loaded)) if loaded[k : k + lasts].all())
        begins.append(float(recorded.time[after][first]))
    (begin,) = begins
    return begin


def test_a_fall_is_exit_code_1(tmp_path):
    settings = ["impulse=90", "push.step=0", "direction=right", "feedback=false", "steps=2"]
    run = plantar("sim", "push", *[x for s in settings for x in ("--set", s)], "--json", cwd=tmp_path)
    assert run.returncode == 1
    assert json.loads(run.stdout)["fell"]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["sim", "nowhere"], ("nowhere", "flat")),
        (["sim", "missing.toml"], ("missing.toml", "does not exist")),
        (["sim", "flat", "--robot", "r2d2"], ("r2d2", "h1")),
        (["sim", "flat", "--set", "steps=many"], ("steps", "many")),
        (["sim", "flat", "--set", "stance_width=9"], ("stance_width", "0.6")),
        (["sim", "flat", "--set", "length=0.9"], ("length", "0.9")),
        (["sim", "flat", "--seed", "-1"], ("seed", "0 or more")),
        (["sim", "flat", "--record", "run.bag"], (".mcap",)),
        (["sim", "flat", "--video", "run.gif"], (".mp4",)),
        (["sim", "flat", *SHORT, "--record", "/proc/none/run.mcap"], ("/proc/none",)),
        (["sim", "flat", *SHORT, "--plot", "/proc/none/plots"], ("/proc/none", "-o")),
        (["sweep", "flat", "--grid", "steps"], ("steps", "key=a,b,c")),
        (["sweep", "flat", "--grid", "steps=1,x"], ("steps", "x")),
        (["demo", "-o", "/proc/none/demo"], ("/proc/none",)),
        (["view", "none.mcap"], ("none.mcap", "cannot be read")),
        (["view", "none.mcap", "-o", "view.mp4"], ("view.mp4", ".html")),
    ],
)
def test_bad_input_is_one_line_exit_2_and_nothing_left(tmp_path, monkeypatch, capfd, arguments, words):
    """In this process, since starting one of its own for each takes a second; `test_command_line.py` starts some."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "argv", ["plantar", *arguments])
    with pytest.raises(SystemExit) as ended:
        cli.main()
    stdout, stderr = capfd.readouterr()
    assert ended.value.code == 2, stdout + stderr
    assert stdout == ""
    assert stderr.startswith("plantar: ")
    assert stderr.count("\n") == 1
    assert "Traceback" not in stderr
    assert all(word in stderr for word in words), stderr
    assert list(tmp_path.iterdir()) == []


def test_a_run_that_does_not_begin_leaves_no_folder(tmp_path):
    run = plantar("sim", "flat", "--robot", "r2d2", "--record", "a/run.mcap", "--plot", "b", cwd=tmp_path)
    assert run.returncode == 2
    assert list(tmp_path.iterdir()) == []


@pytest.mark.long
def test_demo_makes_all_three_and_names_them(tmp_path):
    run = plantar("demo", "-o", "out", "--json", cwd=tmp_path)
    assert run.returncode == 0, run.stderr
    made = json.loads(run.stdout)
    assert made["completed"]
    files = {str(Path(f).relative_to("out")) for f in made["files"]}
    assert {"shoe/shoe_left.stl", "walk/run.mcap", "analysis/report.html"} <= files
    assert all((tmp_path / "out" / f).stat().st_size > 0 for f in files)
    assert made["analysis"]["feet"]["left"]["steps"] == 24
    shown = re.findall(r"plantar analyze (\S+\.mcap)", analyze.__doc__ or "")
    assert shown
    assert set(shown) <= set(made["files"])  # what the help of analyze takes is what a demo leaves


@pytest.mark.long
def test_small_demo_needs_neither_simulator_nor_cad(tmp_path):
    absent = "import sys; sys.modules |= dict.fromkeys(['mujoco', 'cadquery', 'cv2'])"
    command = "sys.argv = ['plantar', 'demo', '--small', '-o', 'out', '--json']"
    code = f"{absent}; {command}; from plantar.__main__ import main; main()"
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    made = json.loads(done.stdout)
    for name, least in (("robot", 2), ("insole", 12)):
        feet = made["analysis"][name]["feet"]
        assert all(foot["steps"] >= least for foot in feet.values()), feet
    for page in ("robot/report.html", "robot/view.html", "insole/report.html"):
        assert (tmp_path / "out" / page).stat().st_size > 100_000
