"""Sweeps that are stopped or killed, or whose workers or scheduler are: no row lost, none twice, one line, then on."""

import csv
import json
import os
import random
import signal
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import pytest

psutil = pytest.importorskip("psutil")

SEEDS = 4
FRICTIONS = ("0.7", "0.9")
TOTAL = SEEDS * len(FRICTIONS)
SCENE = ("flat", *(f"--set={s}" for s in ("steps=0", "settle=0.2", "end=0.2", "start=0.2")))
SWEEP = (*SCENE, f"--grid=friction={','.join(FRICTIONS)}", f"--seeds={SEEDS}")
TIMINGS = ("real_time_factor", "control_p99_us")  # the only columns of a run that differ from one to the next
WAIT = 240.0
STARTED: list[subprocess.Popen[str]] = []


def ready_for_signals() -> None:
    """Take Ctrl-C as in a terminal, also where the tests run in a shell's background."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def start(*arguments: str | Path) -> subprocess.Popen[str]:
    """A sweep in a group of processes of its own, as a terminal starts it."""
    command = [str(Path(sys.executable).parent / "plantar"), "sweep", *map(str, arguments)]
    pipes: dict[str, Any] = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    sweep = subprocess.Popen(command, start_new_session=True, preexec_fn=ready_for_signals, **pipes)
    STARTED.append(sweep)
    return sweep


@pytest.fixture(autouse=True)
def nothing_left_running():
    """End the sweeps that a test which failed has left."""
    yield
    for sweep in STARTED:
        if sweep.poll() is None:
            stop_all(sweep, signal.SIGKILL)
            finish(sweep)
    STARTED.clear()


def finish(sweep: subprocess.Popen[str]) -> tuple[int, str]:
    """Exit code and messages."""
    _, errors = sweep.communicate(timeout=WAIT)
    return sweep.returncode, errors


def rows(folder: Path) -> list[dict[str, str]]:
    """The whole rows of a table that may be just written."""
    path = folder / "results.csv"
    text = path.read_text() if path.exists() else ""
    return list(csv.DictReader(text[: text.rfind("\n") + 1].splitlines()))


def content(folder: Path) -> dict[tuple[str, str], dict[str, str]]:
    """What each run came to, without its timing; each point and seed must be there exactly once."""
    found = rows(folder)
    assert Counter((r["friction"], r["seed"]) for r in found) == Counter(
        (f, str(s)) for f in FRICTIONS for s in range(SEEDS)
    )
    return {(r["friction"], r["seed"]): {k: v for k, v in r.items() if k not in TIMINGS} for r in found}


def kept(folder: Path, total: int = TOTAL) -> str:
    """What a sweep says of its rows when it ends before its time."""
    return f"kept {len(rows(folder))} of {total} rows in {folder / 'results.csv'}; the same command goes on from there"


def until(condition: Callable[[], Any], what: str) -> Any:
    deadline = time.monotonic() + WAIT
    while not (found := condition()):
        assert time.monotonic() < deadline, what
        time.sleep(0.02)
    return found


def workers_of(process: Any) -> list[Any]:
    """Processes below one that run what it spawned."""
    found = []
    for child in psutil.Process(process.pid).children(recursive=True):
        try:
            if "spawn_main" in " ".join(child.cmdline()):
                found.append(child)
        except psutil.NoSuchProcess:
            continue
    return found


def assert_all_gone(processes: list[Any]) -> None:
    _, alive = psutil.wait_procs(processes, timeout=WAIT)
    assert [p for p in alive if p.is_running() and p.status() != psutil.STATUS_ZOMBIE] == []


def assert_stopped(code: int, errors: str, number: int, folder: Path, total: int = TOTAL) -> None:
    """Ended by a signal, with one line that says what was kept."""
    assert code == 128 + number, errors
    name = "Ctrl-C" if number == signal.SIGINT else "SIGTERM"
    assert errors == f"plantar: stopped by {name}: {kept(folder, total)}\n"


def stop_all(sweep: subprocess.Popen[str], number: int) -> None:
    with suppress(ProcessLookupError):  # it has just ended
        os.killpg(sweep.pid, number)


def stop_parent(sweep: subprocess.Popen[str], number: int) -> None:
    sweep.send_signal(number)


@contextmanager
def cluster(folder: Path, workers: int = 1, nanny: bool = True) -> Iterator[tuple[str, Any, list[Any]]]:
    """Address of a Dask scheduler of its own processes, that scheduler, and its workers."""
    pytest.importorskip("distributed")
    file = folder / "scheduler.json"
    tool = [sys.executable, "-W", "ignore", "-m", "distributed.cli.dask_"]
    quiet: dict[str, Any] = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "start_new_session": True}
    options = ["--host", "127.0.0.1", "--port", "0", "--no-dashboard", "--no-show", "--scheduler-file", str(file)]
    scheduler = subprocess.Popen([*tool[:-1], f"{tool[-1]}scheduler", *options], **quiet)
    members = [scheduler]
    try:
        until(lambda: file.exists() and file.read_text().strip().endswith("}"), "no scheduler")
        address = json.loads(file.read_text())["address"]
        options = [address, "--nthreads", "1", "--nanny" if nanny else "--no-nanny", "--no-dashboard"]
        options += ["--local-directory", str(folder)]
        for _ in range(workers):
            members.append(subprocess.Popen([*tool[:-1], f"{tool[-1]}worker", *options], **quiet))
        yield address, scheduler, members[1:]
    finally:
        for member in members:
            family = [*psutil.Process(member.pid).children(recursive=True)]
            member.kill()
            member.wait()
            for child in family:
                child.kill() if child.is_running() else None


@pytest.mark.long
def test_ctrl_c_keeps_what_is_done_and_the_same_command_goes_on(tmp_path):
    sweep = start(*SWEEP, "--workers=2", "-o", tmp_path)
    until(lambda: len(rows(tmp_path)) >= 2, "no rows")
    workers = workers_of(sweep)
    for _ in range(3):  # an impatient user
        stop_all(sweep, signal.SIGINT)
        time.sleep(0.05)
    assert_stopped(*finish(sweep), signal.SIGINT, tmp_path)
    assert_all_gone(workers)
    before = rows(tmp_path)
    assert 2 <= len(before) < TOTAL
    code, errors = finish(start(*SWEEP, "--workers=2", "-o", tmp_path))
    assert (code, errors) == (0, "")
    content(tmp_path)
    assert rows(tmp_path)[: len(before)] == before


@pytest.mark.long  # what of it is of workers alone is asked in common/workers/test_local_workers.py
def test_a_killed_worker_costs_its_run_and_a_killed_sweep_takes_its_workers_along(tmp_path):
    sweep = start(*SWEEP, "--workers=1", "-o", tmp_path)
    until(lambda: rows(tmp_path), "no rows")
    (first,) = workers_of(sweep)
    first.kill()
    (second,) = until(lambda: [w for w in workers_of(sweep) if w.pid != first.pid], "no new worker")
    count = len(rows(tmp_path))
    until(lambda: len(rows(tmp_path)) > count, "no rows of the new worker")
    sweep.kill()
    finish(sweep)
    assert_all_gone([second])
    code, errors = finish(start(*SWEEP, "--workers=1", "-o", tmp_path))
    assert (code, errors) == (0, "")
    content(tmp_path)


@pytest.mark.long
def test_a_second_sweep_on_a_folder_is_refused_while_the_first_goes_on(tmp_path):
    many = 100 * SEEDS  # more than are done until the second has started, on any machine
    first = start(*SCENE, f"--seeds={many}", "--workers=1", "-o", tmp_path)
    until(lambda: owns(first, tmp_path), "no table")
    code, errors = finish(start(*SWEEP, "--workers=1", "-o", tmp_path))
    assert code == 2
    assert errors.startswith(f"plantar: another process writes to {tmp_path / 'results.csv'}; wait for its end")
    assert errors.count("\n") == 1
    stop_parent(first, signal.SIGTERM)
    assert_stopped(*finish(first), signal.SIGTERM, tmp_path, many)


@pytest.mark.long
def test_a_scheduler_that_dies_is_one_line_and_its_rows_go_on_elsewhere(tmp_path):
    folder = tmp_path / "rows"
    with cluster(tmp_path) as (address, scheduler, _):
        sweep = start(*SWEEP, "--scheduler", address, "-o", folder)
        until(lambda: rows(folder), "no rows")
        scheduler.kill()
        code, errors = finish(sweep)
        assert code == 1
        kept = (
            f"kept {len(rows(folder))} of {TOTAL} rows in {folder / 'results.csv'}; the same command goes on from there"
        )
        assert errors == f"plantar: the Dask scheduler at {address} went away: {kept}\n"
    code, errors = finish(start(*SWEEP, "--workers=1", "-o", folder))
    assert (code, errors) == (0, "")
    content(folder)


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory):
    """What the runs come to, and how many seconds they take from when their table is there."""
    folder = tmp_path_factory.mktemp("undisturbed")
    sweep = start(*SWEEP, "--workers=2", "-o", folder)
    until(lambda: owns(sweep, folder), "no table")
    begin = time.monotonic()
    assert finish(sweep) == (0, "")
    return content(folder), time.monotonic() - begin


def owns(sweep: subprocess.Popen[str], folder: Path) -> bool:
    """Whether a sweep has begun: whether it has the table open."""
    with suppress(psutil.Error):
        return str(folder / "results.csv") in [file.path for file in psutil.Process(sweep.pid).open_files()]
    return False


def at_random(moments: random.Random, sweep: subprocess.Popen[str], folder: Path, duration: float) -> list[Any]:
    """Wait for a moment of a sweep, from its taking the folder to about its end; its workers on this machine then."""
    until(lambda: owns(sweep, folder) or sweep.poll() is not None, "no table")
    time.sleep(moments.uniform(0.0, duration))
    return workers_of(sweep) if sweep.poll() is None else []


def disturb(how: str, sweep: subprocess.Popen[str], workers: list[Any], folder: Path) -> None:
    """Stop a sweep or kill a part of it, and see that it ends as it must."""
    number = signal.SIGINT if "Ctrl-C" in how else signal.SIGTERM
    if "worker" in how:
        for worker in workers[:1]:
            worker.kill()
    elif "-9" in how:
        sweep.kill()
    else:
        (stop_all if "group" in how else stop_parent)(sweep, number)
    code, errors = finish(sweep)
    if "worker" in how or code == 0:  # it may have been done just before
        assert (code, errors) == (0, "")
    elif "-9" in how:
        # Python's own tracker, which lives on, may say that the killed one left semaphores, which it then takes away.
        told = [line for line in errors.splitlines() if "resource_tracker" not in line]
        assert (code, told) == (-signal.SIGKILL, [])
    elif len(rows(folder)) == TOTAL and "kept" not in errors:  # done, and the signal met the interpreter at its end
        assert code in (-number, 128 + number)
        assert errors.count("\n") <= 1
    else:
        assert_stopped(code, errors, number, folder)
    assert_all_gone(workers)


LOCAL = ("Ctrl-C of the group", "Ctrl-C of the parent", "TERM of the group", "TERM of the parent", "-9 of the parent")
LOCAL = (*LOCAL, "-9 of a worker")


@pytest.mark.long
@pytest.mark.parametrize("how", LOCAL)
@pytest.mark.parametrize("attempt", [1, 2])
def test_local_sweeps_killed_at_random_moments(how, attempt, undisturbed, tmp_path):
    wanted, duration = undisturbed
    moments = random.Random(f"{how} {attempt}")
    for _ in range(2):
        sweep = start(*SWEEP, "--workers=2", "-o", tmp_path)
        disturb(how, sweep, at_random(moments, sweep, tmp_path, duration), tmp_path)
    assert finish(start(*SWEEP, "--workers=2", "-o", tmp_path)) == (0, "")
    assert content(tmp_path) == wanted


@pytest.mark.long
@pytest.mark.parametrize("how", ["Ctrl-C of the group", "TERM of the parent", "-9 of the parent"])
def test_cluster_sweeps_killed_at_random_moments(how, undisturbed, tmp_path):
    wanted, duration = undisturbed
    moments = random.Random(f"cluster {how}")
    folder = tmp_path / "rows"
    with cluster(tmp_path) as (address, _, _):
        for _ in range(2):
            sweep = start(*SWEEP, "--scheduler", address, "-o", folder)
            at_random(moments, sweep, folder, duration)
            disturb(how, sweep, [], folder)
        assert finish(start(*SWEEP, "--scheduler", address, "-o", folder)) == (0, "")
    assert content(folder) == wanted


@pytest.mark.long
@pytest.mark.parametrize("killed", ["worker with a nanny", "one of two workers", "scheduler", "scheduler again"])
def test_clusters_of_which_a_part_is_killed_at_a_random_moment(killed, undisturbed, tmp_path):
    """A worker with a nanny comes again; without one the other worker has to do. Without a scheduler rows stay."""
    wanted, duration = undisturbed
    folder, nanny = tmp_path / "rows", "two" not in killed
    with cluster(tmp_path, workers=1 if nanny else 2, nanny=nanny) as (address, scheduler, workers):
        sweep = start(*SWEEP, "--scheduler", address, "-o", folder)
        at_random(random.Random(killed), sweep, folder, duration)
        for part in [scheduler] if "scheduler" in killed else workers_of(workers[0]) if nanny else workers[:1]:
            part.kill()
        code, errors = finish(sweep)
        if "scheduler" in killed and (code or errors):
            assert code == 1
            assert errors == f"plantar: the Dask scheduler at {address} went away: {kept(folder)}\n"
        else:
            assert (code, errors) == (0, "")
    if "scheduler" in killed:
        assert finish(start(*SWEEP, "--workers=2", "-o", folder)) == (0, "")
    assert content(folder) == wanted
