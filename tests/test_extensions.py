"""Parts of a user's own package, found by entry points from outside the checkout: one new file each."""

import json
import math
import os
import re
import socket
import subprocess
import sys
import threading
import tomllib
from itertools import count
from pathlib import Path

import numpy as np
import pytest

from plantar import hex_layout, write_layout
from plantar.formats import read_recording

ROOT = Path(__file__).resolve().parent.parent

PARTS = ("ditch", "high_swing", "further", "calm_law", "weigh", "hold", "datagrams")
"""Files of the tutorial, in its order."""

PAGES = ROOT / "docs" / "tutorials"


def blocks(page: str, language: str) -> list[str]:
    """Blocks of a language that a tutorial shows."""
    text = (PAGES / page).read_text(encoding="utf-8")
    return re.findall(rf"^```{language}\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


@pytest.fixture
def plugin(tmp_path):
    """A folder on the path with the package of the tutorials, as pip would install it."""
    package, info = tmp_path / "mine", tmp_path / "mine-1.0.dist-info"
    package.mkdir()
    info.mkdir()
    files = dict(zip(PARTS, blocks("part.md", "python"), strict=True))
    make, files["mysole"], *_ = blocks("format.md", "python")
    for name, text in ({"__init__": ""} | files).items():
        (package / f"{name}.py").write_text(text)
    (tmp_path / "make.py").write_text(make)
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: mine\nVersion: 1.0\n")
    (project,) = blocks("part.md", 'toml title="pyproject.toml"')
    groups = tomllib.loads(project)["project"]["entry-points"] | {"plantar.formats": {"mysole": "mine.mysole:FORMAT"}}
    write_entries(tmp_path, groups)
    return tmp_path


def write_entries(folder: Path, groups: dict[str, dict[str, str]]) -> None:
    lines = [
        f"[{group}]\n" + "".join(f"{name} = {value}\n" for name, value in parts.items())
        for group, parts in groups.items()
    ]
    (folder / "mine-1.0.dist-info" / "entry_points.txt").write_text("".join(lines))


def plantar(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    """The command line with a folder on the path."""
    path = os.pathsep.join([str(folder), str(ROOT)])
    command = [sys.executable, "-m", "plantar", *words]
    return subprocess.run(command, cwd=folder, env=os.environ | {"PYTHONPATH": path}, capture_output=True, text=True)


def python(folder: Path, code: str) -> str:
    """What Python code prints with a folder on the path."""
    path = os.pathsep.join([str(folder), str(ROOT)])
    env = os.environ | {"PYTHONPATH": path}
    done = subprocess.run([sys.executable, "-c", code], cwd=folder, env=env, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_a_format_and_a_command_of_a_users_package(plugin):
    python(plugin, "import make")
    done = plantar(plugin, "weigh", "walk.mysole", "--json")
    assert json.loads(done.stdout)["weight_N"] == pytest.approx(4 * 200e3 * 0.06 * 0.08 / math.pi, rel=0.01), (
        done.stderr
    )
    assert "weigh" in plantar(plugin, "--help").stdout
    assert "mysole" in plantar(plugin, "list", "formats").stdout


def test_a_ground_of_a_users_package(plugin):
    pytest.importorskip("mujoco")
    done = plantar(plugin, "list", "settings", "terrain.ditch", "--json")
    assert done.returncode == 0, done.stderr
    assert "terrain.ditch.depth" in {row["name"] for row in json.loads(done.stdout)["settings"]}
    code = (
        "import plantar; from plantar.sim.run.runner import Simulation; "
        "run = Simulation(plantar.load_scene('flat', ['terrain.kind=ditch', 'terrain.depth=0.2', 'steps=0'])); "
        "print(run.world.model.geom('ground').pos[2], run.world.model.ngeom)"
    )
    assert python(plugin, code).startswith("-0.2")


def test_a_swing_of_a_users_package(plugin):
    pytest.importorskip("mujoco")
    code = (
        "import plantar, numpy as np; from plantar.gait.feet.swing_kind import SwingStart; "
        "walker = plantar.load_controller('h1', {'control': {'swing_shape': 'high'}, 'high_swing': {'more': 0.02}}); "
        "kind = walker.controller.settings.swing; "
        "swing = kind.begin(SwingStart(np.zeros(3), 0.0, np.array([0.2, 0, 0]), 0.0, 0.05, 0.8, 0.005, 0.1)); "
        "print(type(kind).__name__, round(max(swing.at(0.01 * k)[0][2] for k in range(80)), 3))"
    )
    assert python(plugin, code).split() == ["HighSwing", "0.07"]
    refused = plantar(plugin, "sim", "flat", "--set", "high_swing.more=0.03")
    assert refused.returncode == 2
    assert "allowed: with control.swing_shape = 'high'" in refused.stderr
    assert "high_swing.more" in plantar(plugin, "list", "settings", "high_swing").stdout


def test_a_proposer_and_a_balance_law_of_a_users_package(plugin):
    pytest.importorskip("mujoco")
    code = (
        "import json, plantar; from plantar.sim.run.runner import Simulation; "
        "settings = ['steps=4', 'settle=0.5', 'balance.law=calm', %s]; "
        "run = Simulation(plantar.load_scene('flat', settings)); found = run.run(); "
        "places = [run.controller.plan.view.foothold(k).x for k in range(4)]; "
        "print(json.dumps([type(run.controller.balance).__name__, found['steps_taken'], places]))"
    )
    on, off = "'further.on=true', 'further.distance=0.03'", "'further.on=false'"
    (law, taken, moved), (_, _, plain) = (json.loads(python(plugin, code % more)) for more in (on, off))
    assert (law, taken) == ("_Calm", 4)
    assert np.subtract(moved, plain) == pytest.approx([0.0, 0.0, 0.03, 0.03], abs=1e-9)
    refused = plantar(plugin, "sim", "flat", "--set", "further.distance=0.03")
    assert refused.returncode == 2
    assert "allowed: with further.on = true" in refused.stderr
    unknown = plantar(plugin, "sim", "flat", "--set", "balance.law=hope")
    assert "wrench_distribution, calm" in unknown.stderr


def test_an_experiment_of_a_users_package(plugin):
    pytest.importorskip("mujoco")
    (plugin / "h.toml").write_text('description = "pushed"\nexperiment = "hold"\nmachine = "planar-arm"\n')
    held = plantar(plugin, "sim", "h.toml", "--json")
    assert held.returncode == 0, held.stderr + held.stdout
    assert 0.0 < json.loads(held.stdout)["moved_m"] < 0.05
    pushed = plantar(plugin, "sim", "h.toml", "--set", "force=50")
    assert pushed.returncode == 1
    assert "the tip moved by" in pushed.stdout


def test_a_live_source_of_a_users_package(plugin):
    sole = hex_layout([[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]])
    write_layout(sole, plugin / "layout.json")
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    over = threading.Event()

    def send() -> None:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as device:
            for k in count():
                packet = np.array([0.01 * k, *np.full(len(sole), 2.0)]).tobytes()
                for each in (b"",) if over.wait(0.01) else (b"?", packet, packet):  # a stranger's, and one twice
                    device.sendto(each, ("127.0.0.1", port))
                if over.is_set():
                    return

    sender = threading.Thread(target=send)
    sender.start()
    options = ("--layout", "layout.json", "--seconds", "0.2", "-o", "run.mcap", "--json")
    done = plantar(plugin, "live", f"datagrams:{port}", *options)
    over.set()
    sender.join()
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["feet"]["left"]["frames"] > 2
    assert read_recording(plugin / "run.mcap").feet["left"].vertical_force[1] == pytest.approx(2.0 * len(sole))
    assert "datagrams" in plantar(plugin, "list", "sources").stdout
    refused = plantar(plugin, "live", "datagrams")
    assert (refused.returncode, "allowed: datagrams:PORT" in refused.stderr) == (2, True)


@pytest.mark.sample(2)
@pytest.mark.parametrize(
    ("group", "name", "value", "words"),
    [
        ("plantar.terrain", "ditch", "mine.weigh:weigh", ("mine.weigh:weigh", "Terrain")),
        ("plantar.terrain", "flat", "mine.ditch:Ditch", ("flat = mine.ditch:Ditch", "taken name")),
        ("plantar.formats", "csv", "mine.mysole:FORMAT", ("csv = mine.mysole:FORMAT", "taken name")),
        ("plantar.swings", "low", "mine.gone:Low", ("mine.gone:Low", "No module named")),
        ("plantar.live", "replay", "mine.datagrams:SOURCE", ("replay = mine.datagrams:SOURCE", "taken name")),
    ],
)
def test_a_part_that_cannot_be_used_is_named(plugin, group, name, value, words):
    write_entries(plugin, {group: {name: value}})
    listed = {"plantar.formats": ["formats"], "plantar.live": ["sources"]}.get(group, ["settings", "terrain"])
    done = plantar(plugin, "list", *listed)
    assert done.returncode == 2
    assert all(word in done.stderr for word in words)
    assert len(done.stderr.strip().splitlines()) == 1


def test_commands_go_on_without_one_that_cannot_be_loaded(plugin):
    write_entries(plugin, {"plantar.commands": {"gone": "mine.gone:COMMAND"}})
    done = plantar(plugin, "--version")
    assert done.returncode == 0
    assert "mine.gone:COMMAND" in done.stderr


def test_the_parts_of_the_tutorial_lack_nothing(plugin):
    (code,) = blocks("part.md", "py")
    python(plugin, code)
