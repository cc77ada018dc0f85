"""Simulator tests share one compiled H1 world and one short run."""

import pytest

from plantar.robots import load_robot
from plantar.sim.model.world import build_world
from plantar.sim.run.runner import run_scene
from plantar.sim.run.scene import load_scene
from plantar.sim.terrain import Ground


@pytest.fixture(scope="session")
def h1():
    return load_robot("h1")


@pytest.fixture
def world(h1):
    return build_world(h1, Ground((), 0.0, 0.8))


@pytest.fixture(scope="session")
def short_scene():
    """Four forward steps: about 2 s of wall time."""
    return load_scene("flat", ["steps=4", "settle=1.0"])


@pytest.fixture(scope="session")
def short_run(short_scene, tmp_path_factory):
    """Summary and recording of the short scene, seed 0."""
    path = tmp_path_factory.mktemp("run") / "run.mcap"
    return run_scene(short_scene, 0, record=path), path
