"""The examples of the companion do what they say."""

import re
import subprocess
import sys


def run(name, repository):
    """What an example prints."""
    done = subprocess.run(
        [sys.executable, f"examples/{name}.py"], cwd=repository, capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_an_arm_gives_way_and_keeps_its_tip(repository):
    text = run("skin_arm", repository)
    forces = [float(v) for v in re.findall(r"([\d.]+) N on the skin", text)]
    errors = [float(v) for v in re.findall(r"tip off by ([\d.]+) mm", text)]
    assert max(forces) > 10.0
    assert max(errors) < 3.0
    assert float(re.search(r"gave way by (\d+) mm", text)[1]) > 40.0


def test_a_task_of_ones_own_is_kept(repository):
    with_it, without = map(float, re.findall(r"turns by ([\d.]+) degrees", run("skin_new_task", repository)))
    assert with_it < 0.5
    assert without > 10.0
