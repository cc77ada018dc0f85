"""Whole commands end by themselves whatever a file holds; `python -m tests.fuzz.command_mutants` runs thousands."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from .command_mutants import damaged, what_fails
from .taken_away import made


@pytest.mark.parametrize(
    ("code", "err", "seconds", "why"),
    [
        (0, "  note: a\n  note: b\n", 1.0, ""),
        (1, "plantar: check does not hold: a\n", 1.0, ""),
        (2, "plantar: no file\n", 1.0, ""),
        (2, "plantar: no file\nplantar: b\n", 1.0, "no line of its own"),
        (2, "", 1.0, "no line of its own"),
        ("KeyError: 1", "", 1.0, "KeyError"),
        (1, "Traceback (most recent call last)\n", 1.0, "Traceback"),
        (0, "", 11.0, "takes 11 s"),
    ],
)
def test_what_counts_as_a_failure(code, err, seconds, why):
    found = what_fails(code, err, seconds)
    assert why in found
    assert bool(why) == bool(found) or "GB" in found


def test_mutants_are_of_their_seed_and_differ():
    content = made(0).text().encode()
    one, same, other = (damaged(content, np.random.default_rng(seed)) for seed in (1, 1, 2))
    assert one == same
    assert len({content, one, other}) == 3


@pytest.mark.long
@pytest.mark.parametrize("seed", range(4))
def test_mutants_of_all_kinds_end_with_a_line(seed):
    command = [sys.executable, "-m", "tests.fuzz.command_mutants", "--count", "100", "--seed", str(seed)]
    done = subprocess.run(command, cwd=Path(__file__).parents[2], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    *failures, endings = done.stdout.splitlines()
    assert failures == []
    assert sum(json.loads(endings).values()) == 100
