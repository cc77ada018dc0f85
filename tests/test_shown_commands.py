"""What the documents show is understood: every command with its options, scenes and settings, every block of TOML.

`test_readme.py` and `test_site.py` run what the README and the tutorials show; the long test here runs the other pages.
"""

import math
import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import typer

from plantar import cli
from plantar.errors import PlantarError
from plantar.formats import read_recording
from plantar.robots import load_robot
from plantar.shoes import ShoeParameters
from plantar.shoes.cells.cell import read_cell
from plantar.sim.companion.machine import load_machine
from plantar.sim.run.listing import listed
from plantar.sim.run.scene_kind import open_scene
from plantar.sim.run.setting_list import settings_of_robot

ROOT = Path(__file__).resolve().parent.parent
PAGES = sorted((ROOT / "docs").rglob("*.md"))
DOCUMENTS = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *PAGES, *sorted((ROOT / "benchmarks").glob("*.md"))]

COMMANDS = typer.main.get_command(cli.app).commands


def blocks(text: str, language: str) -> list[str]:
    """Fenced blocks of one language."""
    return re.findall(rf"^```{language}\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


def in_blocks(text: str) -> list[str]:
    """Commands of Plantar in a text's blocks, without `plantar`."""
    lines = "".join(blocks(text, "sh")).replace("\\\n", " ").splitlines()
    return [line.removeprefix("plantar ") for line in lines if line.startswith("plantar ")]


def in_sentences(text: str) -> list[str]:
    """Commands of Plantar with arguments that a text's sentences name, without `plantar`."""
    prose = re.sub(r"^```.*?^```$", "", text, flags=re.MULTILINE | re.DOTALL)
    return [" ".join(told.split()[1:]) for told in re.findall(r"`(plantar \w[^`]* [^`]*)`", prose)]


def understand(command: str) -> None:
    """Raise where a command is not one that begins to run: by its options, its scene, a setting's name or value."""
    name, *words = shlex.split(command, comments=True)
    if name == "COMMAND" or name.startswith("-"):
        return
    found = COMMANDS[name].make_context(name, words).params
    if name == "list":
        assert settings_of_robot(found["name"], None) if found["what"] == "settings" else listed(found["what"])
    if name in ("sim", "sweep") and found["scene"] != "SCENE" and not found["scene"].endswith(".toml"):
        robot = found["robot"] if found["robot"] is None or "/" not in found["robot"] else None
        scene = open_scene(found["scene"], found["settings"] or [], robot)
        for key, _, values in (axis.partition("=") for axis in found.get("grid") or []):
            scene.setting_name(key)
            for value in values.split(","):
                open_scene(found["scene"], [f"{key}={value}"], robot)


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda d: str(d.relative_to(ROOT)))
def test_every_command_is_one_that_would_run(document):
    text = document.read_text(encoding="utf-8")
    for command in (*in_blocks(text), *in_sentences(text)):
        understand(command)


def test_a_command_that_would_not_run_is_found():
    for wrong in ("sim nowhere", "sim flat --sed 3", "sim flat --set stepz=3", "sim flat --set steps=many", "fly"):
        with pytest.raises((Exception, SystemExit)):
            understand(wrong)
    with pytest.raises(Exception, match="stepz"):
        understand("sweep flat --grid stepz=3")
    assert in_blocks("```sh\nplantar sim flat  # yes\nmake\n```\n") == ["sim flat  # yes"]
    assert in_sentences("Try `plantar sim flat\n--seed 3`, or `plantar sim`.\n```sh\nplantar view\n```\n") == [
        "sim flat --seed 3"
    ]


def test_every_setting_that_a_sentence_changes_is_one():
    """`--set key=value` apart from its command: a scene takes it, of some kind of ground or push, or a shoe does."""
    scenes = ("shoe", "flat", "push-step", "beam", "leader-follower", "guide", "balance", "lean")
    for document in DOCUMENTS:
        text = document.read_text(encoding="utf-8")
        for setting in re.findall(r"`--set (\w[\w.]*=[^`\s]+)`", text):
            if setting == "key=value" or setting.endswith("=..."):
                continue
            assert any(_takes(scene, setting) for scene in scenes), f"{document.name}: --set {setting}"


def _takes(scene: str, setting: str) -> bool:
    """Whether a scene has a setting, or a shoe."""
    try:
        ShoeParameters().changed([setting]) if scene == "shoe" else open_scene(scene, [setting])
    except PlantarError:
        return False
    return True


def is_cell(block: str) -> bool:
    """Whether a page shows the body of a sensor cell."""
    return re.search(r"^shape = ", block, re.MULTILINE) is not None


SCENES = [
    pytest.param(block, id=f"{page.stem}-{number}")
    for page in PAGES
    for number, block in enumerate(b for b in blocks(page.read_text("utf-8"), "toml") if "[model]" not in b)
    if not is_cell(block)
]


@pytest.mark.parametrize("block", SCENES)
def test_a_scene_that_is_shown_opens(block, tmp_path):
    """A part of one is put into a scene on level ground."""
    whole = block if re.search(r"^name =", block, re.MULTILINE) else f'robot = "h1"\n[terrain]\nkind = "flat"\n{block}'
    (tmp_path / "shown.toml").write_text(whole)
    open_scene(tmp_path / "shown.toml")


def test_a_cell_that_is_shown_is_read(tmp_path):
    shown = [b for page in PAGES for b in blocks(page.read_text("utf-8"), "toml") if is_cell(b)]
    assert shown
    for block in shown:
        (tmp_path / "my_cell.toml").write_text(block)
        assert read_cell(str(tmp_path / "my_cell.toml")).about


def shown_model(page: str) -> str:
    """The robot or machine that a page shows."""
    [found] = [b for b in blocks((ROOT / "docs" / page).read_text("utf-8"), "toml") if "[model]" in b]
    return found


def test_a_robot_that_is_shown_is_read(tmp_path):
    for layout in (ROOT / "plantar" / "robots" / "h1").glob("layout_*.json"):
        shutil.copy(layout, tmp_path)
    (tmp_path / "jvrc1.xml").write_text("<mujoco/>")
    for text in (shown_model("simulation.md"), re.sub(r"^# (?=\w+ = [^.\[])", "", shown_model("simulation.md"))):
        (tmp_path / "robot.toml").write_text(text)
        assert load_robot(tmp_path / "robot.toml").name == "jvrc1"


ARM = """<mujoco><worldbody><body name="base"><geom size=".1"/><body name="arm"><joint name="shoulder" axis="0 1 0"/>
<geom size=".05"/><body name="forearm"><joint name="elbow" axis="0 1 0"/><geom size=".05"/></body></body></body>
</worldbody></mujoco>"""


def test_a_machine_that_is_shown_is_read(tmp_path):
    (tmp_path / "arm.xml").write_text(ARM)
    (tmp_path / "machine.toml").write_text(shown_model("companion.md"))
    assert load_machine(tmp_path / "machine.toml").description == "my arm"


@pytest.fixture(scope="module")
def desk(tmp_path_factory):
    """A folder with the files that the pages speak of: a foot, its outline, a robot's model, a recording, a study."""
    import trimesh
    from ezdxf.filemanagement import new

    from plantar.robots.kinematics.robot_model import robot_spec

    folder = tmp_path_factory.mktemp("desk")
    box = trimesh.creation.box(extents=(0.22, 0.09, 0.06))
    box.export(folder / "foot.stl")
    spec = robot_spec(load_robot("h1"))
    spec.compile()
    for name in ("robot.xml", "my_robot.xml"):
        (folder / name).write_text(spec.to_xml())
    drawing = new(units=6)  # m
    drawing.modelspace().add_lwpolyline([(-0.1, -0.04), (0.12, -0.04), (0.12, 0.04), (-0.1, 0.04)], close=True)
    drawing.saveas(folder / "sole.dxf")
    points = [(130 + 125 * math.cos(k / 30 * math.pi), 60 + 45 * math.sin(k / 30 * math.pi)) for k in range(60)]
    ring = " ".join(f"{x:.2f},{y:.2f}" for x, y in points)
    size = 'width="260mm" height="120mm" viewBox="0 0 260 120"'
    svg = f'<svg xmlns="http://www.w3.org/2000/svg" {size}><polygon points="{ring}"/></svg>'
    (folder / "my_outline.svg").write_text(svg)
    subprocess.run([sys.executable, ROOT / "examples" / "insole_walk.py", folder / "walk.asc"], check=True)
    write_study(folder)
    return folder


def write_study(folder: Path) -> None:
    """Three people in two kinds of shoes, the second loaded 5 % more: `recordings` and `table.csv` in a folder."""
    walk = read_recording(folder / "walk.asc")
    (folder / "recordings").mkdir()
    rows = ["file,participant,condition"]
    for person in range(3):
        for condition, share in (("soft", 1.0), ("firm", 1.05)):
            left, right = (walk.feet[side].force * share * (1.0 + 0.02 * person) for side in ("left", "right"))
            file = folder / "recordings" / f"{condition}{person}.npz"
            np.savez(file, time=walk.time, unit="N", left=left, right=right)
            rows.append(f"{condition}{person}.npz,P{person},{condition}")
    (folder / "table.csv").write_text("\n".join(rows) + "\n")


def shown(page: str) -> list[object]:
    """The commands in a page's blocks, each with one seed where the page has many."""
    text = (ROOT / "docs" / f"{page}.md").read_text("utf-8")
    told = [(c, c.replace(".urdf", ".xml")) for c in in_blocks(text)]  # the reader's robot is H1 here, an MJCF
    return [pytest.param(re.sub(r"--seeds \d+", "--seeds 1", c), id=t.partition(" #")[0].strip()) for t, c in told]


@pytest.mark.long
@pytest.mark.parametrize(
    "command", [c for p in ("shoes", "robots", "companion", "simulation", "scenes") for c in shown(p)]
)
def test_a_command_of_a_page_runs(command, desk):
    """Exit code 1 is an answer, too: a check found something, or a robot without a part of its control fell."""
    scripts = Path(sys.executable).parent
    env = os.environ | {"PATH": f"{scripts}{os.pathsep}{os.environ.get('PATH', '')}"}
    words = ["plantar", *shlex.split(command, comments=True)]
    done = subprocess.run(words, cwd=desk, env=env, capture_output=True, text=True)
    assert done.returncode in (0, 1), f"exit {done.returncode}\n{done.stdout}\n{done.stderr}"
    assert "Traceback" not in done.stderr
    assert done.stdout.strip()


@pytest.mark.long
@pytest.mark.parametrize("page", ["shoes", "metrics", "perception", "companion"])
def test_code_of_a_page_runs(page, desk, tmp_path, monkeypatch):
    """With the names and files that the page speaks of."""
    from plantar import hex_layout

    layout = hex_layout([[-0.1, -0.05], [0.14, -0.05], [0.14, 0.05], [-0.1, 0.05]])
    count = len(layout)
    names: dict[str, object] = {"layout": layout, "time": 0.0, "force": np.full(count, 9.0), "distance": np.ones(count)}
    shutil.copytree(desk, tmp_path / "desk")
    monkeypatch.chdir(tmp_path / "desk")
    found = blocks((ROOT / "docs" / f"{page}.md").read_text("utf-8"), "python")
    assert found
    for text in found:
        exec(compile(text, page, "exec"), names)
