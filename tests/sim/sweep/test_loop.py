"""Sweeps of very short runs: resuming, clusters and refusals. Kills are in test_kills.py."""

import csv
import os
import signal
import threading
from pathlib import Path

import pytest

from plantar.errors import InputError
from plantar.plotting import save_figure
from plantar.sim.sweep import Sweep, run_sweep
from plantar.sim.sweep.figures import bars_of
from plantar.sim.sweep.loop import SweepStopped, stop_noted

TIMINGS = ("real_time_factor", "control_p99_us")  # the only columns of a run that differ from one to the next
STANDING = ("steps=0", "settle=0.0", "end=0.2", "start=0.2")


def standing(seeds: int = 2) -> Sweep:
    return Sweep("flat", (("friction", ("0.7", "0.9")),), seeds, None, STANDING)


def rows(folder: Path) -> list[dict[str, str]]:
    with (folder / "results.csv").open(newline="") as file:
        return list(csv.DictReader(file))


def test_every_point_and_seed_is_run_once_and_a_stopped_sweep_goes_on(tmp_path):
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


def test_another_sweep_in_the_same_folder_is_refused(tmp_path):
    run_sweep(standing(1), tmp_path)
    with pytest.raises(InputError, match="another sweep"):
        run_sweep(Sweep("push", (), 1, None, STANDING), tmp_path)


def test_runs_that_could_not_be_say_why(tmp_path):
    result = run_sweep(Sweep("push", (), 1, None, ("steps=2", "push.step=7")), tmp_path)
    (point,) = result["points"]
    assert (point["runs"], point["completed"]) == (1, 0)
    assert "2 steps" in point["errors"][0]


def test_a_cluster_gives_the_same_rows_to_the_last_bit(tmp_path):
    """Two runs at a time in one process, as Dask does it, and one at a time in a process of its own."""
    distributed = pytest.importorskip("distributed")
    sweep = Sweep("flat", (("friction", ("0.2", "0.9")),), 2, None, ("steps=1", "settle=0.0", "noise=3"))
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=2, processes=False, dashboard_address=":0"
    ) as cluster:
        run_sweep(sweep, tmp_path / "cluster", scheduler=cluster.scheduler_address)
    run_sweep(sweep, tmp_path / "local")
    there, here = (
        sorted(({k: v for k, v in r.items() if k not in TIMINGS} for r in rows(tmp_path / name)), key=str)
        for name in ("cluster", "local")
    )
    assert there == here
    assert len({tuple(v for k, v in r.items() if k not in ("seed", "friction")) for r in here}) == 4


def test_more_points_than_there_is_room_for_words_are_drawn(tmp_path):
    points = [{"settings": {"impulse": str(i)}, "runs": 4, "completed": i % 5} for i in range(500)]
    path = save_figure(bars_of(points, "push"), tmp_path / "completed.png")
    assert int.from_bytes(path.read_bytes()[16:20], "big") < 6000


def test_no_scheduler_is_one_line(tmp_path):
    pytest.importorskip("distributed")
    with pytest.raises(InputError, match="no Dask scheduler"):
        run_sweep(standing(1), tmp_path, scheduler="tcp://127.0.0.1:9")


@pytest.fixture(autouse=True)
def interruptible():
    """Both signals with a handler, also where the tests run in a shell's background."""
    before = {n: signal.signal(n, signal.default_int_handler) for n in (signal.SIGINT, signal.SIGTERM)}
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


@pytest.mark.sample(1)
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_a_sweep_after_a_whole_row(number, tmp_path):
    def stop(fraction: float, text: str) -> None:
        os.kill(os.getpid(), number)
        os.kill(os.getpid(), signal.SIGINT)  # the first one counts

    with pytest.raises(SweepStopped, match=r"kept 1 of 4 rows in .*results.csv; the same command goes on") as caught:
        run_sweep(standing(2), tmp_path, progress=stop)
    assert caught.value.number == number
    assert len(rows(tmp_path)) == 1
    assert run_sweep(standing(2), tmp_path)["runs"] == 3
    with pytest.raises(KeyboardInterrupt):
        os.kill(os.getpid(), signal.SIGINT)


def test_what_is_ignored_stays_ignored():
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    with stop_noted() as note:
        os.kill(os.getpid(), signal.SIGINT)
    assert note.number == 0


def test_another_thread_handles_no_signals():
    seen = []

    def sweep() -> None:
        with stop_noted() as note:
            seen.append(note.number)

    thread = threading.Thread(target=sweep)
    thread.start()
    thread.join()
    assert seen == [0]
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
