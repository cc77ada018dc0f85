"""The example of a plant that is not the model does what it says."""

import re
import subprocess
import sys

import pytest


@pytest.mark.long
def test_levels_grow_and_the_controller_keeps_its_own_mass(repository):
    done = subprocess.run(
        [sys.executable, "examples/other_plant.py"], cwd=repository, capture_output=True, text=True, timeout=600
    )
    assert done.returncode == 0, done.stderr
    text = done.stdout
    assert "level 0: completed" in text
    gyro = [length_of(row) for row in re.findall(r"gyro_bias_rad_s: \[(.*)\]", text)]
    assert len(gyro) == 2  # nothing is told of level 0
    assert gyro[0] < gyro[1] < 0.005
    known, carried = map(float, re.search(r"takes it for ([\d.]+) kg, the ground carries ([\d.]+) kg", text).groups())
    assert abs(carried / known - 1.05) < 1e-3
    half, every = map(int, re.search(r"within (\d+) mm, all within (\d+) mm", text).groups())
    assert 14 <= half <= 18  # a ball of 20 mm has half of its volume within 0.5^(1/3) of its radius
    assert half < every <= 20


def length_of(row):
    """Length of a list of numbers in a text."""
    return sum(float(v) ** 2 for v in row.split(",")) ** 0.5
