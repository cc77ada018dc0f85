"""Two threads against one on a recording, through the batch functions: prints the table of threads.md.

    python benchmarks/threads.py

Times of one call by one thread and by two, in turn, 31 rounds, and the median of the ratios of neighbouring calls.
Checksums, which need no memory and no interpreter, show what two cores of this machine give at most. Results are the
same to the last bit (tests/plantar/percepts/test_threads.py).
"""

import hashlib
import statistics
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from plantar import batch, hex_layout

FRAMES, ROUNDS = 200_000, 31
SOLE = hex_layout([[-0.1, -0.05], [0.13, -0.05], [0.13, 0.05], [-0.1, 0.05]])


def recording() -> np.ndarray:
    """Forces (frames, taxels) in N of a load that rolls from heel to toe and back, with the noise of taxels."""
    rng = np.random.default_rng(1000)
    x = SOLE.positions[:, 0]
    middle = np.interp(np.sin(np.linspace(0.0, 300.0, FRAMES)), (-1.0, 1.0), (x.min(), x.max()))
    pressed = np.maximum(0.0, 20.0 * (1.0 - ((x[None] - middle[:, None]) / 0.06) ** 2))
    return np.maximum(0.0, pressed + rng.normal(0.0, 0.1, pressed.shape))


def checksums(threads: int) -> None:
    """The same 24 checksums of 4 MB by one thread or shared by several."""
    data = bytes(4_000_000)

    def work(count: int) -> None:
        for _ in range(count):
            hashlib.sha256(data)

    with ThreadPoolExecutor(threads) as pool:
        list(pool.map(work, [24 // threads] * threads))


def calls(force: np.ndarray) -> dict[str, Callable[[int], object]]:
    distance = 1e-3 * force
    return {
        "checksums (SHA-256)": checksums,
        "`wrenches`": lambda threads: batch.wrenches(SOLE, force, threads=threads),
        "`loads`": lambda threads: batch.loads(SOLE, force, threads=threads),
        "`support_polygons`": lambda threads: batch.support_polygons(SOLE, force, threads=threads),
        "`support_polygons`, vertices": lambda threads: batch.support_polygons(
            SOLE, force, vertices=True, threads=threads
        ),
        "`ground_planes`": lambda threads: batch.ground_planes(SOLE, distance, threads=threads),
    }


def seconds(call: Callable[[int], object], threads: int) -> float:
    start = time.perf_counter()
    call(threads)
    return time.perf_counter() - start


def main() -> None:
    force = recording()
    print(f"{FRAMES} frames of {len(SOLE)} taxels\n")
    print("| | one thread [ms] | two [ms] | one / two, median (quartiles) |")
    print("|---|---|---|---|")
    for name, call in calls(force).items():
        seconds(call, 2)
        pairs = [(seconds(call, 1), seconds(call, 2)) for _ in range(ROUNDS)]
        one, two = (1e3 * statistics.median(p[i] for p in pairs) for i in (0, 1))
        low, middle, high = np.percentile([a / b for a, b in pairs], (25, 50, 75)).tolist()
        print(f"| {name} | {one:.1f} | {two:.1f} | **{middle:.2f}** ({low:.2f} to {high:.2f}) |", flush=True)


if __name__ == "__main__":
    main()
