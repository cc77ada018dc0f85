"""A folder has one owner at a time, and none after that has ended in whatever way."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from plantar.errors import InputError
from plantar.sim.sweep.lock import locked

HOLD = "import sys; from pathlib import Path; from plantar.sim.sweep.lock import locked\n"
HOLD += "with locked(Path(sys.argv[1])): print('held', flush=True); sys.stdin.read()"
TAKE_TURNS = """
import sys, time; from pathlib import Path; from plantar.errors import InputError
from plantar.sim.sweep.lock import locked
folder = Path(sys.argv[1])
done = 0
while done < 50:
    try:
        with locked(folder):
            with open(folder / "inside", "x"): pass  # fails where another is inside
            time.sleep(0.0002)
            (folder / "inside").unlink()
        done += 1
    except InputError:
        pass
"""


def test_a_second_owner_is_refused_and_the_first_named(tmp_path: Path, repository: Path) -> None:
    holder = subprocess.Popen(
        [sys.executable, "-c", HOLD, tmp_path], stdin=subprocess.PIPE, stdout=subprocess.PIPE, cwd=repository
    )
    assert holder.stdin is not None
    assert holder.stdout is not None
    with holder.stdin, holder.stdout:
        assert holder.stdout.readline() == b"held\n"
        with (
            pytest.raises(InputError, match=f"another sweep .process {holder.pid} .*choose another folder"),
            locked(tmp_path),
        ):
            pass
        holder.kill()
        holder.wait()
    with locked(tmp_path):  # the dead one's file is still there, its lock is not
        pass
    assert list(tmp_path.iterdir()) == []


def test_owners_that_come_and_go_are_never_two(tmp_path: Path, repository: Path) -> None:
    """The file is deleted by each owner while the others open it: none may lock a deleted one beside a new one."""
    command = [sys.executable, "-c", TAKE_TURNS, tmp_path]
    owners = [subprocess.Popen(command, stderr=subprocess.PIPE, cwd=repository) for _ in range(3)]
    for owner in owners:
        _, errors = owner.communicate(timeout=120.0)
        assert (owner.returncode, errors) == (0, b"")
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_takes_no_lock_is_one_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def no_locks(*_: object) -> None:
        raise OSError(95, os.strerror(95))

    monkeypatch.setattr("fcntl.flock", no_locks)
    with pytest.raises(InputError, match=r"cannot be locked .*not supported.*choose"), locked(tmp_path):
        pass
