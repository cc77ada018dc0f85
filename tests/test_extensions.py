"""Parts of a user's own package, found by entry points from outside the checkout: one new file each."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent

TERRAIN = """
from plantar.settings.schema import number
from plantar.sim.terrain import Ground, Solid, Terrain

class Ditch(Terrain):
    '''A ditch across the way.

    Attributes:
        depth: Depth in m.
    '''

    depth: float = number(0.1, "m", 0.01, 1)

    def _laid_out(self, feet, rng):
        return Ground((), self.height, self.friction, {"ditch_m": self.depth})
"""

COMMAND = """
import json
from plantar.console.command import Command

def hello(name: str = "you") -> None:
    '''Greet.'''
    print(json.dumps({"hello": name}))

COMMAND = Command(hello, "Greet.")
"""

SWING = """
from plantar.gait.feet.swing_flight import PolynomialSwing
from plantar.gait.feet.swing_kind import Swing, SwingKind, SwingStart
from plantar.settings.schema import number

class HighSwing(SwingKind, table="high_swing", needs={"control.swing_shape": ("high",)}):
    '''Lifts the foot higher than asked.

    Attributes:
        more: Height in m on top.
    '''

    more: float = number(0.01, "m", 0, 0.1)

    def begin(self, start: SwingStart) -> Swing:
        return PolynomialSwing().begin(start.changed(height=start.height + self.more))
"""


@pytest.fixture
def plugin(tmp_path):
    """A folder on the path with a package of a user's own, as pip would install it."""
    package, info = tmp_path / "mine", tmp_path / "mine-1.0.dist-info"
    package.mkdir()
    info.mkdir()
    (package / "__init__.py").write_text("")
    (package / "ditch.py").write_text(TERRAIN)
    (package / "hello.py").write_text(COMMAND)
    (package / "high_swing.py").write_text(SWING)
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: mine\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(
        "[plantar.terrain]\nditch = mine.ditch:Ditch\n[plantar.commands]\nhello = mine.hello:COMMAND\n"
        "[plantar.swings]\nhigh = mine.high_swing:HighSwing\n"
    )
    return tmp_path


def plantar(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    """The command line with a folder on the path."""
    path = os.pathsep.join([str(folder), str(ROOT)])
    command = [sys.executable, "-m", "plantar", *words]
    return subprocess.run(command, cwd=folder, env=os.environ | {"PYTHONPATH": path}, capture_output=True, text=True)


def test_a_command_of_a_users_package_runs(plugin):
    assert json.loads(plantar(plugin, "hello", "--name", "Ada").stdout) == {"hello": "Ada"}
    assert "hello" in plantar(plugin, "--help").stdout


def test_a_kind_of_ground_of_a_users_package_has_settings(plugin):
    pytest.importorskip("mujoco")
    done = plantar(plugin, "list", "settings", "terrain.ditch", "--json")
    assert done.returncode == 0, done.stderr
    assert "terrain.ditch.depth" in {row["name"] for row in json.loads(done.stdout)["settings"]}


def test_a_scene_stands_on_a_users_ground(plugin):
    pytest.importorskip("mujoco")
    code = (
        "import plantar; from plantar.sim.run.runner import Simulation; "
        "run = Simulation(plantar.load_scene('flat', ['terrain.kind=ditch', 'terrain.depth=0.2', 'steps=0'])); "
        "print(run.ground.facts if hasattr(run.ground, 'facts') else type(run.scene.terrain).__name__)"
    )
    path = os.pathsep.join([str(plugin), str(ROOT)])
    done = subprocess.run(
        [sys.executable, "-c", code], env=os.environ | {"PYTHONPATH": path}, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    assert "ditch" in done.stdout.lower()


def test_a_robot_swings_its_foot_as_a_users_package_does(plugin):
    pytest.importorskip("mujoco")
    code = (
        "import plantar, numpy as np; from plantar.gait.feet.swing_kind import SwingStart; "
        "walker = plantar.load_controller('h1', {'control': {'swing_shape': 'high'}, 'high_swing': {'more': 0.02}}); "
        "kind = walker.controller.settings.swing; "
        "swing = kind.begin(SwingStart(np.zeros(3), 0.0, np.array([0.2, 0, 0]), 0.0, 0.05, 0.8, 0.005, 0.1)); "
        "print(type(kind).__name__, round(max(swing.at(0.01 * k)[0][2] for k in range(80)), 3))"
    )
    path = os.pathsep.join([str(plugin), str(ROOT)])
    done = subprocess.run(
        [sys.executable, "-c", code], env=os.environ | {"PYTHONPATH": path}, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == ["HighSwing", "0.07"]
    refused = plantar(plugin, "sim", "flat", "--set", "high_swing.more=0.03")
    assert refused.returncode == 2
    assert "allowed: with control.swing_shape = 'high'" in refused.stderr
    assert "high_swing.more" in plantar(plugin, "list", "settings", "high_swing").stdout


def test_a_part_of_another_kind_is_named(plugin):
    (plugin / "mine-1.0.dist-info" / "entry_points.txt").write_text("[plantar.terrain]\nditch = mine.hello:hello\n")
    done = plantar(plugin, "list", "settings", "terrain")
    assert done.returncode == 2
    assert "mine.hello:hello" in done.stderr
    assert "Terrain" in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1
