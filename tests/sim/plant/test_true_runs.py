"""Runs with a true plant that differs: told in the summary, unknown to the controller, and free where it does not."""

import ast
from pathlib import Path
from typing import Any

import pytest

from plantar.sim.plant.settings import Plant
from plantar.sim.run.run_text import run_text
from plantar.sim.run.runner import run_scene
from plantar.sim.run.scene import load_scene

SIM = Path(__file__).resolve().parents[3] / "plantar" / "sim"
TIMING = ("wall_time_s", "real_time_factor", "control_us")


def motion(summary: dict[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in summary.items() if name not in TIMING}


def test_level_0_leaves_the_motion_as_it_is_to_the_last_bit(short_scene, short_run):
    zero = load_scene("flat", ["steps=4", "settle=1.0", "plant=random", "plant.level=0"])
    summary = run_scene(zero, 0)
    nominal = dict(short_run[0])
    for name in ("skipped",):  # the nominal run was recorded
        summary.pop(name), nominal.pop(name)
    assert motion(summary) == motion(nominal)
    assert "plant" not in summary
    assert run_text(short_run[0]).find("true plant") < 0


def test_a_plant_that_differs_is_reported_and_moves_otherwise(short_run):
    settings = ["steps=4", "settle=1.0", "mass_ratio=1.05", "com_offset=[0, 0.002, 0]", "encoder_offset=random"]
    summary = run_scene(load_scene("flat", [*settings, "level=1"]), 0)
    assert set(summary["plant"]) == {"mass_ratio", "com_offset_m", "encoder_offsets_deg"}
    assert summary["impacts_N"] != short_run[0]["impacts_N"]
    text = run_text({**summary, "figures": []})
    assert "true plant, which the controller does not know: com offset 0, 0.002, 0 m; mass ratio 1.05" in text
    assert "encoder offsets up to 0.1" in " ".join(text.split())
    assert max(map(len, text.splitlines()[:4])) <= 120


@pytest.mark.parametrize("robot", ["h1", pytest.param("hrp2kai", marks=pytest.mark.long)])
def test_a_plant_that_is_drawn_whole_is_simulated_and_the_seed_repeats_it(robot):
    scene = load_scene("flat", ["steps=1", "settle=0.1", "plant=everything", "plant.level=3"], robot)
    first, again = run_scene(scene, 4), run_scene(scene, 4)
    assert len(first["plant"]) == len(Plant.items())
    assert motion(first) == motion(again)
    assert first["plant"] != run_scene(scene, 5)["plant"]


def imports_plant(path: Path) -> bool:
    """Whether a file imports the true plant, beyond the settings of its table."""
    nodes = ast.walk(ast.parse(path.read_text(encoding="utf-8")))
    names = [n.module or "" for n in nodes if isinstance(n, ast.ImportFrom)]
    return any(name.startswith("plantar.sim.plant.") and name != "plantar.sim.plant.settings" for name in names)


def test_the_world_its_sensors_and_its_servos_alone_know_the_true_plant():
    knowing = {path.relative_to(SIM).as_posix() for path in SIM.rglob("*.py") if imports_plant(path)}
    outside = {name for name in knowing if not name.startswith("plant/")}
    assert outside == {
        "model/world.py",
        "run/motor_drives.py",
        "run/run_summary.py",  # gives it in the summary, when the run is over
        "run/runner.py",
        "run/servos.py",
        "sensing/proximity.py",
        "sensing/sensors.py",
        "sensing/skin.py",
    }
    settings = (SIM.parent / "robots" / "controller_settings.py").read_text(encoding="utf-8")
    assert "plant" not in settings.replace("plantar", "")
