"""Simulator tests share one compiled H1 world and one short run."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from plantar.robots import Robot, load_robot
from plantar.sim.model.world import World, build_world
from plantar.sim.run.runner import run_scene
from plantar.sim.run.scene import Scene, load_scene
from plantar.sim.terrain import Ground


@pytest.fixture(scope="session")
def h1() -> Robot:
    return load_robot("h1")


@pytest.fixture
def world(h1: Robot) -> World:
    return build_world(h1, Ground((), 0.0, 0.8))


@pytest.fixture(scope="session")
def short_scene() -> Scene:
    """Four forward steps: about 2 s of wall time."""
    return load_scene("flat", ["steps=4", "settle=1.0"])


@pytest.fixture(scope="session")
def short_run(short_scene: Scene, tmp_path_factory: pytest.TempPathFactory) -> tuple[dict[str, Any], Path]:
    """Summary and recording of the short scene, seed 0."""
    path = tmp_path_factory.mktemp("run") / "run.mcap"
    return run_scene(short_scene, 0, record=path), path
