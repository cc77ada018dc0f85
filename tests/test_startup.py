"""What a command loads and how long it takes to start: what is not needed is skipped."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
HEAVY = {"cadquery", "OCP", "trimesh", "mujoco", "mink", "matplotlib", "shapely", "scipy", "numpy", "mcap", "pandas"}

LIST_MODULES = """
import sys
from plantar import cli
code = 0
for line in " ".join(sys.argv[1:]).split(" then "):
    sys.argv = ["plantar", *line.split()]
    try:
        cli.main()
    except SystemExit as stop:
        code = code or stop.code or 0
    print("\\nloaded:", code, *sorted({name.partition(".")[0] for name in sys.modules}))
"""


def loaded_by(*arguments: str) -> set[str]:
    """Top-level modules that are loaded when a command of `plantar` has run, or several, with "then" between."""
    done = subprocess.run(
        [sys.executable, "-c", LIST_MODULES, *arguments], capture_output=True, text=True, check=True, cwd=ROOT
    )
    code, *modules = done.stdout.rpartition("loaded:")[2].split()
    assert code == "0", done.stderr
    return set(modules)


def seconds(*command: str) -> float:
    """Processor time of a command that must succeed."""
    start = os.times()
    subprocess.run(command, check=True, capture_output=True, cwd=ROOT)
    end = os.times()
    return end.children_user + end.children_system - start.children_user - start.children_system


def test_help_loads_nothing_heavy():
    assert loaded_by("--help") & HEAVY == set()


def test_the_help_of_every_command_loads_nothing_heavy():
    commands = subprocess.run(
        [sys.executable, "-m", "plantar", "--help"], capture_output=True, text=True, cwd=ROOT
    ).stdout
    names = re.findall(r"^  (\w+)  ", commands.partition("Commands:")[2], re.MULTILINE)
    assert {"shoe", "analyze", "list"} <= set(names)
    assert loaded_by(*" --help then ".join(names).split(), "--help") & HEAVY == set()


@pytest.mark.parametrize("what", ["scenes", "robots"])
def test_lists_load_nothing_heavy(what):
    assert loaded_by("list", what) & HEAVY == set()


def test_the_list_of_formats_loads_neither_simulator_nor_shoes():
    assert loaded_by("list", "formats") & {"cadquery", "OCP", "trimesh", "mujoco", "matplotlib"} == set()


def test_the_public_names_load_numpy_only_when_used():
    code = "import sys, plantar, plantar.errors; before = 'numpy' in sys.modules; plantar.Percept; "
    code += "assert (before, 'numpy' in sys.modules) == (False, True)"
    subprocess.run([sys.executable, "-c", code], check=True, cwd=ROOT)


def test_help_takes_less_than_0_4_s_of_the_processor():
    """The best of five runs, so that a busy machine does not decide; 0.06 s where this was written."""
    console_script = Path(sys.executable).parent / "plantar"
    command = [str(console_script)] if console_script.exists() else [sys.executable, "-m", "plantar"]
    assert os.access(command[0], os.X_OK)
    best = min(seconds(*command, "--help") for _ in range(5))
    bare = min(seconds(sys.executable, "-c", "pass") for _ in range(5))
    assert best < 0.4 or best < 20 * bare, f"plantar --help takes {best:.2f} s, python alone {bare:.3f} s"
