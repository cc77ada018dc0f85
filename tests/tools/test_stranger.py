"""The stranger's test tells what is broken from what only lacks a library or a file."""

import importlib.util
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def stranger():
    spec = importlib.util.spec_from_file_location("stranger", ROOT / "tools" / "stranger.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


MISSING = "from plantar.errors import DependencyError as D; raise D('mujoco', 'sim')"


@pytest.mark.parametrize(
    ("code", "extras", "ended"),
    [
        ("print(1)", "", "done"),
        (
            "import sys; sys.exit('plantar: mujoco is not installed; install it with: pip install \\'mujoco\\'')",
            "",
            "done",
        ),
        (MISSING, "", "dependency"),
        (MISSING, "sim", "broken"),
        ("raise ModuleNotFoundError(\"No module named 'mujoco'\")", "", "library"),
        ("raise ModuleNotFoundError(\"No module named 'mujoco'\")", "sim", "broken"),
        ("raise ModuleNotFoundError(\"No module named 'scipy.special'\")", "", "broken"),
        ("import plantar.no_such_room", "sim,gym", "broken"),
        ("open('walk.asc')", "", "file"),
        ("undefined", "", "broken"),
    ],
)
def test_how_a_block_ends(code, extras, ended, stranger, tmp_path):
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True)
    assert stranger.outcome(done, stranger.absent_libraries(extras)) == ended


def test_a_block_that_goes_on_from_the_one_before_it_is_tried_with_it_and_a_broken_one_is_found(stranger, tmp_path):
    tried = stranger.Stranger(Path(sys.executable), "")
    tried._try_block(stranger.Block("page:2", "python", "print(x)\n"), ("", "x = 1\n"), tmp_path)
    assert tried.counts == {"done": 1}
    tried._try_block(stranger.Block("page:3", "python", "print(y)\n"), ("", "x = 1\n"), tmp_path)
    assert tried.counts == {"done": 1, "broken": 1}
    assert tried.broken[0].startswith("page:3")


def test_a_block_does_without_those_before_it_that_lack_a_library(stranger, tmp_path, monkeypatch):
    page = tmp_path / "page.md"
    blocks = ("x = 1", "raise ModuleNotFoundError(\"No module named 'torch'\")", "print(x)")
    page.write_text("".join(f"```python\n{block}\n```\n" for block in blocks))
    monkeypatch.setattr(stranger, "ROOT", tmp_path)
    monkeypatch.setattr(stranger, "PAGES", (page,))
    tried = stranger.Stranger(Path(sys.executable), "")
    tried.try_pages("")
    assert tried.counts == {"done": 2, "library": 1}


def test_what_does_not_end_in_time_is_at_work_and_leaves_no_process(stranger, tmp_path):
    tried = stranger.Stranger(Path(sys.executable), "", limit=1.0)
    tried._try_block(stranger.Block("page:2", "sh", "sleep 60 | sleep 60\n"), (), tmp_path)
    assert tried.counts == {"at work": 1}
    assert tried.broken == []


def test_a_loop_is_one_command(stranger):
    text = "cd out\n\nplantar list \\\n  scenes  # all\nfor side in left right; do\n  cat $side\ndone\necho done\n"
    found = stranger.lines_of(stranger.Block("page:2", "sh", text))
    assert found == ["plantar list    scenes", "for side in left right; do\n  cat $side\ndone", "echo done"]


def test_time_is_that_of_a_processor_or_of_waiting(stranger, tmp_path, monkeypatch):
    """A process that is stopped, as by a busy machine, is neither at work nor waiting for something."""
    monkeypatch.setattr(stranger, "_session_time", lambda session: (0.1, True))
    tried = stranger.Stranger(Path(sys.executable), "", limit=1.0)
    tried._try_block(stranger.Block("page:2", "sh", "sleep 2.5\n"), (), tmp_path)  # by the clock over after 1 s
    assert tried.counts == {"done": 1}


@pytest.mark.skipif(not Path("/proc").is_dir(), reason="processor time of other processes is read from /proc")
def test_processor_time_of_a_session_is_that_of_all_its_processes(stranger):
    code = "import time\nwhile time.process_time() < 0.3: pass\nprint(flush=True)\ninput()"
    shell = subprocess.Popen(
        ["sh", "-c", f"'{sys.executable}' -c '{code}'; true"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        start_new_session=True,
    )
    try:
        shell.stdout.readline()
        used, _ready = stranger._session_time(shell.pid)
        assert 0.25 < used < 3.0  # counted in ticks of 10 ms, of user and kernel apart
    finally:
        shell.communicate(b"\n")


def test_every_page_has_blocks_or_none_that_are_missed(stranger):
    found = [block for page in stranger.PAGES for block in stranger.blocks_of(page)]
    assert {block.language for block in found} == {"python", "sh"}
    assert any(block.place.startswith("docs/learning.md") for block in found)


def test_every_door_of_the_library_is_tried(stranger):
    import plantar

    called = {door.partition("(")[0].split(".")[1] for door in stranger.DOORS}
    functions = {"read", "analyse", "sole", "view", "load_robot", "load_controller", "load_scene", "run"}
    assert functions | {"mujoco", "shoes"} == called
    assert all(callable(getattr(plantar, name)) for name in functions)


def test_a_broken_door_is_found(stranger, tmp_path, monkeypatch):
    monkeypatch.setattr(stranger, "DOORS", ("plantar.read(insole)", "plantar.reed(insole)"))
    tried = stranger.Stranger(Path(sys.executable), "")
    tried.try_doors("")
    assert tried.counts == {"done": 1, "broken": 1}
    assert tried.broken[0].startswith("plantar.reed")
