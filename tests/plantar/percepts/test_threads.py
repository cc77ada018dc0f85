"""Several threads: those that a batch uses by itself, and those of a user who calls the same sole from each."""

import os
import sys
import threading
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from plantar import InputError, batch, fit_ground_plane, hex_layout
from plantar.kernels import python_form
from plantar.sensing.ground_plane import ground_fit

OUTLINE = [[-0.12, -0.05], [0.12, -0.04], [0.12, 0.04], [-0.12, 0.05]]
SOLE = hex_layout(OUTLINE)
FINE = hex_layout(OUTLINE, cell_area=8e-6)
"""More than 2,000 taxels: numpy lets other threads run while it copies arrays of that size."""


def forces(frames, layout=SOLE, seed=0):
    """Forces (frames, n) in N of contacts of any size, some taxels dead or saturated."""
    rng = np.random.default_rng(seed)
    shape = (frames, len(layout))
    force = np.where(rng.random(shape) < rng.random((frames, 1)), rng.uniform(0.0, 60.0, shape), 0.0)
    return np.where(rng.random(shape) < 0.01, rng.choice([np.nan, np.inf, 900.0], shape), force)


def distances(frames, seed=0):
    """Distances (frames, n) in m of a slope, some of what is not the ground: other numbers of points in each frame."""
    rng = np.random.default_rng(seed)
    shape = (frames, len(SOLE))
    distance = 0.02 + 0.1 * SOLE.positions[:, 0] + rng.normal(size=shape) * 1e-3
    return np.where(rng.random(shape) < 0.3, np.inf, np.where(rng.random(shape) < 0.3, 0.045, distance))


def same(a, b):
    """Whether all arrays of two results agree to the last bit."""
    return all(np.array_equal(x, y, equal_nan=True) for x, y in zip(a, b, strict=True))


BATCHES = {
    "wrenches": lambda force, threads: [batch.wrenches(SOLE, force, threads=threads)],
    "loads": lambda force, threads: list(vars(batch.loads(SOLE, force, threads=threads)).values()),
    "areas": lambda force, threads: list(vars(batch.support_polygons(SOLE, force, threads=threads)).values())[:3],
    "polygons": lambda force, threads: list(
        vars(batch.support_polygons(SOLE, force, vertices=True, threads=threads)).values()
    ),
    "planes": lambda force, threads: list(vars(batch.ground_planes(SOLE, force * 1e-3, threads=threads)).values()),
}


@pytest.mark.parametrize("name", BATCHES)
@pytest.mark.parametrize("kind", [np.float64, np.float32])
def test_any_number_of_threads_gives_the_same_bits(name, kind, monkeypatch):
    monkeypatch.setattr(batch, "_LEAST", 16)
    monkeypatch.setattr(batch, "BLOCK", 100)
    force = forces(603).astype(kind)
    alone = BATCHES[name](force, 1)
    for threads in (2, 4, 1000, None):
        assert same(BATCHES[name](force, threads), alone)
    assert same(BATCHES[name](force[:0], 4), BATCHES[name](force[:0], 1))


def test_as_many_threads_work_as_are_asked_for(monkeypatch):
    seen = []

    class Watched(ThreadPoolExecutor):
        def __init__(self, workers):
            seen.append(workers + 1)  # the caller's own is one of them
            super().__init__(workers)

    monkeypatch.setattr(batch, "ThreadPoolExecutor", Watched)
    force = forces(5000)
    batch.wrenches(SOLE, force)
    batch.wrenches(SOLE, force[:500], threads=8)  # not worth a hand-over
    assert seen == []
    batch.wrenches(SOLE, force, threads=3)
    batch.wrenches(SOLE, force, threads=100)
    assert seen == [3, 10]
    if hasattr(os, "sched_getaffinity") and len(os.sched_getaffinity(0)) > 1:
        batch.wrenches(SOLE, force, threads=None)
        assert seen[2:] == [min(len(os.sched_getaffinity(0)), 10)]


@pytest.mark.parametrize("threads", [0, -1, 1.5, True, "2"])
def test_a_number_of_threads_that_is_none(threads):
    with pytest.raises(InputError, match=r"threads is .*; allowed: a whole number, 1 or more"):
        batch.loads(SOLE, forces(2), threads=threads)


def test_a_failure_in_a_thread_is_the_callers(monkeypatch):
    def failing(part):
        if len(part) < 512:  # the last one
            raise MemoryError("no room for the last piece")
        return part

    monkeypatch.setattr(batch, "_doubles", failing)
    with pytest.raises(MemoryError, match="last piece"):
        batch.loads(SOLE, forces(2000), threads=4)


def hammered(call, inputs, threads=4, rounds=4):
    """How often a call of one of several threads gave another result than a call alone."""
    wanted = [call(x) for x in inputs]
    gate = threading.Barrier(threads)
    interval = sys.getswitchinterval()

    def wrong():
        gate.wait()
        return sum(not same(call(x), y) for _ in range(rounds) for x, y in zip(inputs, wanted, strict=True))

    try:
        sys.setswitchinterval(1e-6)
        with ThreadPoolExecutor(threads) as pool:
            return sum(f.result() for f in [pool.submit(wrong) for _ in range(threads)])
    finally:
        sys.setswitchinterval(interval)


def test_calls_of_one_sole_from_several_threads_do_not_meet():
    kernel = FINE.kernel
    force = forces(40, FINE)
    masks = (force > 10.0).view(np.uint8)
    assert hammered(lambda f: kernel.tick(f, 1.0, 50.0, 0.01, 0.0, 0.0), force, rounds=10) == 0
    assert hammered(lambda f: [kernel.active(f, 1.0, 50.0), *kernel.faults(f, 50.0)], force) == 0
    assert hammered(lambda mask: kernel.hull(mask), masks) == 0


def test_what_a_call_worked_in_is_used_again():
    module = python_form("sole")
    corners = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    kernel = module.SoleKernel(np.zeros((1, 3)), [[0.0, 0.0, 1.0]], [0.5], corners, [0, 3], [0, 1, 2])
    [scratch] = kernel.free
    kernel.tick(np.ones(1), 0.5, 2.0, 0.1, 0.0, 0.0)
    assert kernel.free == [scratch]
    assert kernel.borrow() is scratch
    kernel.hull(np.ones(1, dtype=np.uint8))
    assert len(kernel.free) == 1
    assert scratch not in kernel.free


def test_batches_of_one_sole_from_several_threads_do_not_meet():
    parts = forces(4000).reshape(8, 500, -1)
    assert hammered(lambda f: BATCHES["loads"](f, 1), parts) == 0
    assert hammered(lambda f: BATCHES["wrenches"](f, 2), parts) == 0
    assert hammered(lambda f: BATCHES["polygons"](f, 1), parts) == 0


def test_ground_planes_from_several_threads_do_not_meet():
    def plane(distance):
        found = fit_ground_plane(SOLE, distance)
        return [np.array([found.height, *found.slope, found.residual]), found.inliers]

    frames = distances(30)
    SOLE.__dict__.pop("_ground_fit", None)  # so that the triples are drawn while others fit
    assert hammered(plane, frames) == 0
    assert hammered(lambda d: [vars(batch.ground_planes(SOLE, d)).values()][0], frames.reshape(3, 10, -1)) == 0
    assert ground_fit(SOLE) is ground_fit(SOLE)
