"""No damage of a file traces back, takes 10 s or a gigabyte: some mutants at every run, ten minutes in all tests."""

import subprocess
import sys
from pathlib import Path

import pytest

from .mutants import CASES, Failure, Target, read_all, tried
from .targets import TARGETS

pytestmark = pytest.mark.apart

_KEPT = sorted(CASES.glob("*-*")) if CASES.exists() else []


def _fuzz(name: str, seconds: float, most: int, folder: Path) -> int:
    *failures, (_, count) = read_all(name, seconds, most, folder)
    assert [(why, content[:80]) for content, why in failures] == []
    return int(count)


@pytest.mark.sample(6)
@pytest.mark.parametrize("name", TARGETS)
def test_some_mutants_are_read_or_refused(name, tmp_path):
    count = _fuzz(name, seconds=2.0, most=60, folder=tmp_path)
    assert count or not TARGETS[name].seeds(tmp_path)


@pytest.mark.long
@pytest.mark.parametrize("name", TARGETS)
def test_ten_minutes_of_mutants_are_read_or_refused_within_a_gigabyte(name, tmp_path):
    code = (
        "import resource, sys; from pathlib import Path; from tests.fuzz.mutants import read_all\n"
        f"found = list(read_all({name!r}, {600.0 / len(TARGETS):.1f}, 10**9, Path(sys.argv[1]), 7))\n"
        "for content, why in found[:-1]: print(why)\n"
        "memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6\n"
        "sys.exit(f'{memory:.2f} GB' if memory > 1.0 else 0)"
    )
    root = Path(__file__).parents[2]
    done = subprocess.run([sys.executable, "-c", code, str(tmp_path)], cwd=root, capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


@pytest.mark.parametrize("case", _KEPT, ids=lambda case: case.name)
def test_a_file_that_failed_once_is_read_or_refused(case, tmp_path):
    target = TARGETS[case.name.partition("-")[0]]
    tried(target, tmp_path / f"case{target.suffix}", case.read_bytes())


def test_the_loop_finds_what_traces_back(tmp_path):
    def read(path: Path) -> object:
        return {b"a": 1}[path.read_bytes()[:1]]

    broken = Target(read, lambda folder: [b"abc"], "")
    tried(broken, tmp_path / "a", b"abc")
    with pytest.raises(Failure, match="KeyError"):
        tried(broken, tmp_path / "a", b"xbc")
