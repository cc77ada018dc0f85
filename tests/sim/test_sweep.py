"""Sweeps of very short runs: resuming, clusters and refusals."""

from __future__ import annotations

import csv
import subprocess
import sys
import time
from pathlib import Path

import pytest

from plantar.errors import InputError, RobotError, SceneError
from sim.sweep import Sweep, run_one, run_sweep

STANDING = ("steps=0", "settle=0.0", "end=0.2", "start=0.2")


def standing(seeds: int = 2) -> Sweep:
    return Sweep("flat", (("friction", ("0.7", "0.9")),), seeds, None, STANDING)


def rows(folder: Path) -> list[dict[str, str]]:
    with (folder / "results.csv").open(newline="") as file:
        return list(csv.DictReader(file))


def test_every_point_and_seed_is_run_once_and_a_stopped_sweep_goes_on(tmp_path: Path) -> None:
    first = run_sweep(standing(1), tmp_path, workers=2)
    assert (first["runs"], first["resumed"]) == (2, 0)
    text = (tmp_path / "results.csv").read_text()
    (tmp_path / "results.csv").write_text(text + "0.7,1,Tr")  # killed while it wrote
    second = run_sweep(standing(2), tmp_path, workers=1)
    assert (second["runs"], second["resumed"]) == (2, 2)
    found = {(r["friction"], r["seed"]) for r in rows(tmp_path)}
    assert found == {(f, s) for f in ("0.7", "0.9") for s in ("0", "1")}
    assert [p["completed"] for p in second["points"]] == [2, 2]
    assert (tmp_path / "completed.png").stat().st_size > 1000


def test_another_sweep_in_the_same_folder_is_refused(tmp_path: Path) -> None:
    run_sweep(standing(1), tmp_path)
    with pytest.raises(InputError, match="another sweep"):
        run_sweep(Sweep("push", (), 1, None, STANDING), tmp_path)


def test_a_row_says_what_the_run_said() -> None:
    row = run_one("flat", None, STANDING, 0)
    assert row["completed"] is True
    assert row["error"] == ""
    bad = run_one("push", None, ["steps=2", "push.step=7"], 0)
    assert bad["completed"] is False
    assert "2 steps" in bad["error"]


def test_a_robot_that_is_none_is_refused_before_the_first_run(tmp_path: Path) -> None:
    with pytest.raises(RobotError, match="unknown robot 'nobody'"):
        Sweep("flat", (), 1, "nobody", STANDING)
    with pytest.raises(RobotError, match="unknown robot 'nobody'"):
        Sweep.from_texts("flat", ["robot=h1,nobody"], 1, None, STANDING)


def test_runs_that_could_not_be_say_why(tmp_path: Path) -> None:
    result = run_sweep(Sweep("push", (), 1, None, ("steps=2", "push.step=7")), tmp_path)
    (point,) = result["points"]
    assert (point["runs"], point["completed"]) == (1, 0)
    assert "2 steps" in point["errors"][0]


@pytest.mark.parametrize(
    ("grid", "seeds", "error"),
    [
        (["impulse"], 1, InputError),
        (["impulse=20,30,20"], 1, InputError),
        (["impulse="], 1, InputError),
        (["nothing=1,2"], 1, SceneError),
        (["impulse=1,x"], 1, SceneError),
        (["impulse=1", "impulse=2"], 1, InputError),
        (["impulse=1"], 0, InputError),
    ],
)
def test_bad_grids_are_refused_before_the_first_run(grid: list[str], seeds: int, error: type[Exception]) -> None:
    with pytest.raises(error):
        Sweep.from_texts("push", grid, seeds)


def test_a_cluster_runs_the_same_rows(tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, processes=False, dashboard_address=None
    ) as cluster:
        result = run_sweep(standing(1), tmp_path, scheduler=cluster.scheduler_address)
    assert [p["completed"] for p in result["points"]] == [1, 1]


def test_a_killed_sweep_takes_its_workers_along(tmp_path: Path) -> None:
    psutil = pytest.importorskip("psutil")
    command = [sys.executable, "-c", "from cli import main; main()", "sweep", "flat", "--seeds", "50", "--workers", "1"]
    sweep = subprocess.Popen([*command, "-o", str(tmp_path)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    results = tmp_path / "results.csv"
    deadline = time.monotonic() + 120.0
    while time.monotonic() < deadline and not (results.exists() and len(rows(tmp_path)) >= 1):
        time.sleep(0.2)
    workers = psutil.Process(sweep.pid).children(recursive=True)
    assert workers
    sweep.kill()
    sweep.wait()
    _, alive = psutil.wait_procs(workers, timeout=20.0)
    assert not alive
    assert run_sweep(Sweep("flat", (), 1), tmp_path)["resumed"] >= 1


def test_no_scheduler_is_one_line(tmp_path: Path) -> None:
    pytest.importorskip("distributed")
    with pytest.raises(InputError, match="no Dask scheduler"):
        run_sweep(standing(1), tmp_path, scheduler="tcp://127.0.0.1:9")
