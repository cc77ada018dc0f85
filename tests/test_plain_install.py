"""What `pip install plantar` promises without an extra works with the libraries that it declares, and no other."""

import os
import re
import subprocess
import sys
import tomllib
from importlib.metadata import PackageNotFoundError, packages_distributions, requires
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
BLOCKED = """
import sys

class Missing:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in {names!r}:
            raise ModuleNotFoundError(f"No module named {{name!r}}", name=name)

sys.meta_path.insert(0, Missing())
"""


def plain(text: str) -> str:
    """A distribution's name as the index compares it, of a requirement."""
    return re.sub(r"[-_.]+", "-", re.split(r"[^\w.-]", text.strip(), maxsplit=1)[0]).lower()


def declared() -> set[str]:
    """The distributions that an install without extras brings, with those that they bring in turn."""
    left = [plain(d) for d in tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["dependencies"]]
    found: set[str] = set()
    while left:
        name = left.pop()
        if name in found:
            continue
        found.add(name)
        try:
            more = requires(name) or []
        except PackageNotFoundError:  # of another platform or Python
            continue
        left += [plain(r) for r in more if "extra ==" not in r]
    return found


@pytest.fixture(scope="module")
def environment(tmp_path_factory):
    """An environment in which the libraries of the extras cannot be imported, as if they were not installed."""
    allowed = declared() | {"plantar"}
    others = {module for module, of in packages_distributions().items() if not {plain(d) for d in of} & allowed}
    assert {"mujoco", "cadquery", "trimesh", "rosbags"} <= others
    folder = tmp_path_factory.mktemp("plain")
    (folder / "sitecustomize.py").write_text(BLOCKED.format(names=others))
    return os.environ | {"PYTHONPATH": os.pathsep.join([str(folder), str(ROOT)])}


def run(environment: dict[str, str], cwd: Path, *words: str | Path) -> str:
    done = subprocess.run(
        [sys.executable, *map(str, words)], cwd=cwd, env=environment, capture_output=True, text=True, timeout=600
    )
    assert done.returncode == 0, f"{words}: exit {done.returncode}\n{done.stdout}\n{done.stderr}"
    return done.stdout


ANALYSES = {
    "report.html": ["study/a.asc", "--export", "npz", "--export", "csv"],
    "compared/report.html": ["--compare", "study/a.asc", "study/b.asc", "-o", "out/compared"],
    "study.html": ["study"],
}
"""Pages, and what makes them of two recordings."""


@pytest.mark.parametrize("page", ["report.html", *(pytest.param(p, marks=pytest.mark.long) for p in [*ANALYSES][1:])])
def test_recordings_are_analysed_compared_and_studied(page, environment, tmp_path):
    (tmp_path / "study").mkdir()
    for name in ("a.asc", "b.asc"):
        run(environment, tmp_path, ROOT / "examples" / "insole_walk.py", f"study/{name}")
    run(environment, tmp_path, "-m", "plantar", "analyze", "-o", "out", *ANALYSES[page])
    assert (tmp_path / "out" / page).is_file()


@pytest.mark.long
def test_a_sensor_is_recorded_and_viewed(environment, tmp_path):
    run(environment, tmp_path, ROOT / "examples" / "record_own_sensor.py", "run.mcap")
    run(environment, tmp_path, "-m", "plantar", "analyze", "run.mcap", "-o", "walk")
    run(environment, tmp_path, "-m", "plantar", "view", "run.mcap", "-o", "view.html")
    assert (tmp_path / "view.html").stat().st_size > 100_000


@pytest.mark.sample(2)
@pytest.mark.parametrize(
    "name",
    ["sole_hexagons", "percept_one_foot", "percept_stream", "percept_faults", "record_formats", "record_own_metric"],
)
def test_an_example_of_perception_or_of_recordings_runs(name, environment, tmp_path):
    assert run(environment, tmp_path, ROOT / "examples" / f"{name}.py").strip()


DOORS = (
    "plantar.read('walk.asc')",
    "plantar.analyse('walk.asc')",
    "plantar.view(['run.mcap'], 'view.html')",
    "plantar.load_robot('h1')",
    "plantar.load_controller('h1')",
    "plantar.load_scene('flat')",
    "plantar.run('flat')",
    "plantar.mujoco.Skin(body='foot')",
    "plantar.shoes.read_parameters('none.toml')",
    "plantar.shoes.foot_from_dimensions('box', length=0.25, width=0.1)",
    "plantar.shoes.build_shoe(plantar.shoes.foot_from_dimensions('box', length=0.25, width=0.1))",
)
"""What each door is asked for, without the libraries of any extra."""


def test_a_door_gives_a_value_or_the_command_that_installs_what_is_missing(environment, walk):
    code = f"""
import plantar, plantar.shoes
from plantar import PlantarError
for door in {DOORS!r}:
    try:
        eval(door)
        print("a value")
    except plantar.DependencyError as error:
        print(error)
    except PlantarError as error:
        assert "none.toml" in str(error)
        print("no file")
"""
    said = run(environment, walk, "-c", code).splitlines()
    assert len(said) == len(DOORS)
    wrong = [line for line in said if "not installed" in line and "pip install '" not in line]
    assert wrong == []
    assert "a value" in said
    assert any("is not installed" in line for line in said)


COMMANDS = (
    "demo",
    "shoe --robot h1",
    "shoe --dimensions 250x100",
    "sim flat",
    "sweep flat",
    "robot model.xml",
    "robot check robot.toml",
    *(f"bench {what}" for what in ("kernels", "scenes", "skip", "stress", "footholds", "all")),
    *(f"list {what}" for what in ("", "robots", "scenes", "papers", "papers K", "formats", "sources", "settings")),
    "view run.mcap",
    "analyze walk.asc --json",
    "analyze walk.asc --export c3d",
    "live replay:run.mcap --seconds 0.1",
    "--help",
)


@pytest.mark.sample(4)
@pytest.mark.parametrize("command", COMMANDS)
def test_a_command_is_done_or_ends_in_the_line_that_installs_what_is_missing(command, environment, walk):
    done = subprocess.run(
        [sys.executable, "-m", "plantar", *command.split()],
        cwd=walk,
        env=environment,
        capture_output=True,
        text=True,
        timeout=600,
    )
    if done.returncode == 0:
        return
    assert done.returncode == 2, done.stderr
    assert done.stderr.count("\n") == 1
    assert re.search("is not installed; install it with: .*pip install '", done.stderr)


@pytest.fixture(scope="module")
def walk(environment, tmp_path_factory):
    """A folder with a recording of insoles, one of a sensor, and a model."""
    folder = tmp_path_factory.mktemp("walk")
    run(environment, folder, ROOT / "examples" / "insole_walk.py", "walk.asc")
    run(environment, folder, ROOT / "examples" / "record_own_sensor.py", "run.mcap")
    (folder / "model.xml").write_text("<mujoco/>")
    return folder
