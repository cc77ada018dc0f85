"""The stress run, shortened: no failure, the same each time, and a planted fault is found."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from plantar.bench.rings import Rings
from plantar.bench.stress.soles import blocks_of, stress_soles
from plantar.bench.stress.stress_run import stress
from plantar.errors import InputError
from plantar.geometry import polygon


@pytest.mark.parametrize("readings", [5_000, pytest.param(20_000, marks=pytest.mark.long)])
def test_a_short_run_sees_no_failure(readings):
    result = stress(readings, seed=1)
    assert {name: t.examples for name, t in result.functions.items() if t.failures} == {}
    assert result.readings == readings
    assert len(result.functions) > 100
    assert result.least == readings  # every function met every reading
    assert all(t.readings > 0 and np.isfinite(t.worst) for t in result.functions.values())


def test_a_planted_fault_is_found(monkeypatch):
    right = polygon.signed_margin
    monkeypatch.setattr(polygon, "signed_margin", lambda ring, point: 1.001 * right(ring, point))
    result = stress(200)
    assert result.functions["signed_margin"].failures > 0
    assert "sole '3 rows of 3'" in result.functions["signed_margin"].examples[0]


def test_a_function_that_raises_is_found(monkeypatch):
    def raising(ring):
        raise ZeroDivisionError("planted")

    monkeypatch.setattr(polygon, "centroid", raising)
    result = stress(100)
    assert "planted" in result.functions["plane_polygons raises"].examples[0]


@pytest.mark.parametrize("readings", [1, 501])
def test_a_rest_of_one_reading_is_no_failure(readings):
    result = stress(readings)
    assert result.failures == 0
    assert readings <= result.least <= readings + 15


def test_the_same_seed_gives_the_same_readings():
    soles = stress_soles()
    one, two, other = ([b.force for b in blocks_of(soles, 900, seed)] for seed in (3, 3, 4))
    assert all(np.array_equal(a, b, equal_nan=True) for a, b in zip(one, two, strict=True))
    assert not all(np.array_equal(a, b, equal_nan=True) for a, b in zip(one, other, strict=True))
    assert sum(map(len, one)) == 900


def test_every_pattern_of_a_lattice_of_three_rows_comes():
    sole = stress_soles()[0]
    seen = {tuple(row) for b in blocks_of([sole], 4_000, 0) for row in b.active.tolist()}
    assert len(seen) == 2**9


def test_rings_find_a_dent_of_one_unit_in_the_last_place():
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    flat = np.insert(square, 1, [0.5, 0.0], axis=0)
    dented = np.insert(square, 1, [0.5, 5e-324], axis=0)
    bulged = np.insert(square, 1, [0.5, -5e-324], axis=0)
    assert Rings([square, flat, dented, bulged, square[::-1]]).not_convex().tolist() == [0.0, 1.0, 1.0, 0.0, 1.0]


def test_no_readings_are_refused():
    with pytest.raises(InputError, match="1 or more"):
        stress(0)


def test_the_command_prints_one_object(tmp_path: Path):
    command = [
        str(Path(sys.executable).parent / "plantar"),
        "bench",
        "kernels",
        "--stress",
        "--readings",
        "100",
        "--json",
    ]
    run = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    assert json.loads(run.stdout)["failures"] == 0
    refused = subprocess.run([*command[:2], "contact", "--stress"], cwd=tmp_path, capture_output=True, text=True)
    assert refused.returncode == 2
    assert "--stress" in refused.stderr
    assert list(tmp_path.iterdir()) == []
