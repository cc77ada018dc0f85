"""The look at which room a program is in."""

import time
from pathlib import Path

from plantar.sim.bench.room_times import ROOMS, RoomTimes, room_of

ROOT = Path(__file__).resolve().parents[3] / "plantar"


def test_every_file_that_a_room_names_is_there():
    for parts in ROOMS.values():
        for part in parts:
            assert (ROOT / part).exists(), part


def test_a_file_belongs_to_the_first_room_that_names_it():
    assert room_of("gait/estimate/skin_load.py") == "perception"
    assert room_of("gait/controller.py") == "controller"
    assert room_of("robots/kinematics/leg_model.py") is None  # the estimator asks for it, and the servos do


def test_time_counts_for_the_room_that_takes_it():
    source = "def busy(end):\n    while clock() < end: pass\n"
    spaces = []
    for path in ("gait/estimate/estimator.py", "lazy.py"):
        spaces.append({"clock": time.perf_counter})
        exec(compile(source, str(ROOT / path), "exec"), spaces[-1])
    estimate, shared = (space["busy"] for space in spaces)
    with RoomTimes() as rooms:
        estimate(time.perf_counter() + 0.1)
        shared(time.perf_counter() + 0.1)  # called by no room: counts for nobody
    assert rooms.shares["estimate"] > 0.9
    assert abs(sum(rooms.shares.values()) - 1.0) < 1e-9


def test_steps_that_a_kernel_makes_are_physics():
    spaces = []
    for path in ("sim/run/runner.py", "gait/estimate/estimator.py"):
        spaces.append({"clock": time.perf_counter})
        exec(compile("def advance(end):\n    while clock() < end: pass\n", str(ROOT / path), "exec"), spaces[-1])
    run, estimate = (space["advance"] for space in spaces)
    with RoomTimes() as rooms:
        run(time.perf_counter() + 0.1)
        estimate(time.perf_counter() + 0.1)
    assert rooms.shares["physics"] > 0.1
    assert rooms.shares["estimate"] > 0.1
    assert rooms.shares["loop"] < 0.1


def test_without_samples_there_is_no_share():
    assert RoomTimes().shares == {}
