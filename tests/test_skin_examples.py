"""The examples of skins do what they say, and so does the page of skins in one's own simulation."""

import re
import subprocess
import sys

import pytest

pytestmark = pytest.mark.sample(2, of="file")


def run(name, repository):
    """What an example prints."""
    done = subprocess.run(
        [sys.executable, f"examples/{name}.py"], cwd=repository, capture_output=True, text=True, timeout=600
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


def test_an_arm_of_any_model_is_guided_by_touches(repository):
    text = run("skin_any_arm", repository)
    assert float(re.search(r"(\d+) N at most", text)[1]) > 5.0
    moved = [float(v) for v in re.search(r"moved by \[(.*)\] mm", text)[1].split()]
    assert sum(v * v for v in moved) > 20.0**2


def test_a_task_of_ones_own_is_kept(repository):
    with_it, without = map(float, re.findall(r"turns by ([\d.]+) degrees", run("skin_new_task", repository)))
    assert with_it < 0.5
    assert without > 10.0


def test_the_page_of_skins_runs_as_it_is_printed(repository, tmp_path):
    """But what needs MuJoCo Warp, mjlab or a window."""
    page = (repository / "docs" / "skin.md").read_text("utf-8")
    blocks = re.findall(r"^```python\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
    code = "".join(block for block in blocks if not re.search("warp|mjlab|viewer", block))
    code += "print(forces.shape, wrenches.shape)"
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, timeout=600)
    assert done.stderr == ""
    weight, shapes = done.stdout.splitlines()
    assert abs(float(weight) - 0.24 * 0.1 * 0.04 * 1000.0 * 9.81) < 0.01  # MuJoCo's density, and its gravity
    assert shapes == "(8, 100, 39, 3) (8, 100, 6)"
