"""The ids of the environments as docs/learning.md writes them, each in a process that has imported nothing before."""

import re
import subprocess
import sys

import pytest

pytest.importorskip("gymnasium")
pytest.importorskip("mujoco")


def fresh(code: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=600)


def test_the_first_lines_of_the_page_run(repository):
    page = (repository / "docs" / "learning.md").read_text()
    first = re.search(r"```python\n(.+?)```", page, re.DOTALL)
    assert first is not None
    assert "gymnasium.make(" in first[1]
    done = fresh(first[1] + "\nprint(observation['skin_left'].shape, reward)")
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize(
    "code",
    [
        "gymnasium.make_vec('plantar.sim.environments:PlantarStand-v0', 2, vectorization_mode='async').reset()",
        "import plantar.sim.environments; gymnasium.make('PlantarStand-v0').reset()",
    ],
)
def test_an_id_is_found(code):
    done = fresh(f"import gymnasium; {code}")
    assert done.returncode == 0, done.stderr
