"""Scenes of the companion, run for the tests."""

from typing import Any

import pytest

from plantar.sim.companion.runner import Companion
from plantar.sim.run.scene_kind import open_scene


@pytest.fixture(scope="session")
def run_scene():
    def run(name: str, *settings: str, seed: int = 0, seconds: float | None = None) -> tuple[dict[str, Any], Companion]:
        companion = Companion(open_scene(name, settings), seed)
        if seconds is not None:
            companion.experiment.duration = seconds
        return companion.run(), companion

    return run
