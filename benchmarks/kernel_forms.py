"""Ways to run a kernel of plain Python: interpreted, compiled ahead of time by Cython, at run time by numba.

Prints the table of kernel_forms.md for `plantar/kernels/geometry/convex.py`'s area and closest point of a polygon of 20
vertices. numba is measured where it is installed; Plantar does not need it.

    python benchmarks/kernel_forms.py
"""

import importlib.util
import statistics
import subprocess
import sys
import time
import timeit
from pathlib import Path

import numpy as np

from plantar import kernels
from plantar.kernels.geometry import convex

ANGLE = np.arange(20) * (2.0 * np.pi / 20)
POLYGON = np.column_stack([np.cos(ANGLE), np.sin(ANGLE)])


def microseconds(call) -> float:
    """Median time of a call in us, of 9 runs of about 20 ms."""
    timer = timeit.Timer(call)
    number, taken = timer.autorange()
    number = max(1, int(number * 0.02 / taken))
    return statistics.median(timer.repeat(9, number)) / number * 1e6


def import_milliseconds(statement: str, after: str) -> float:
    """Median time in ms of an import in a fresh interpreter that has imported its dependencies."""
    code = f"{after}\nimport time\nstart = time.perf_counter()\n{statement}\nprint(time.perf_counter() - start)"
    runs = [subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True) for _ in range(5)]
    return 1e3 * statistics.median(float(run.stdout) for run in runs)


def megabytes(*names: str) -> float:
    """Size on disk in MB of packages or files."""
    total = 0
    for name in names:
        path = Path(name)
        if not path.is_absolute():
            path = Path(importlib.util.find_spec(name).origin).parent
        total += sum(p.stat().st_size for p in (path.rglob("*") if path.is_dir() else [path]) if p.is_file())
    return total / 1e6


def rows():
    source = kernels.python_form("convex")
    after = "import numpy"
    python = "import os; os.environ['PLANTAR_KERNELS'] = 'python'; import numpy; import plantar.kernels"
    first = time.perf_counter()
    source.area(POLYGON)
    first = time.perf_counter() - first
    yield (
        "interpreted",
        microseconds(lambda: source.area(POLYGON)),
        microseconds(lambda: source.closest_point(POLYGON, 3.0, 1.0)),
        import_milliseconds("from plantar.kernels.geometry import convex", python),
        1e3 * first,
        megabytes(source.__file__),
    )
    if kernels.compiled:
        first = time.perf_counter()
        convex.area(POLYGON)
        first = time.perf_counter() - first
        yield (
            "Cython, ahead of time",
            microseconds(lambda: convex.area(POLYGON)),
            microseconds(lambda: convex.closest_point(POLYGON, 3.0, 1.0)),
            import_milliseconds("from plantar.kernels.geometry import convex", f"{after}; import plantar.kernels"),
            1e3 * first,
            megabytes(convex.__file__),
        )
    if importlib.util.find_spec("numba"):
        import numba

        area = numba.njit(source.area)
        names = {"area": area, "math": source.math, "np": np}
        constants = {k: getattr(source, k) for k in ("_LARGEST", "_INFINITE", "_NONE")}
        code = Path(source.__file__).read_text(encoding="utf-8")
        first = time.perf_counter()
        area(POLYGON)
        for name in ("_nearest", "_pair", "closest_point"):
            start = code.index(f"def {name}(")
            exec(code[start : code.index("\n\n\n", start)], scope := {**names, **constants})
            names[name] = numba.njit(scope[name])
        names["closest_point"](POLYGON, 3.0, 1.0)
        first = time.perf_counter() - first
        yield (
            "numba, at run time",
            microseconds(lambda: area(POLYGON)),
            microseconds(lambda: names["closest_point"](POLYGON, 3.0, 1.0)),
            import_milliseconds("import numba", after),
            1e3 * first,
            megabytes("numba", "llvmlite"),
        )


def main() -> None:
    print("| form | area [us] | closest point [us] | import after numpy [ms] | first call [ms] | installed [MB] |")
    print("|---|---|---|---|---|---|")
    for name, *values in rows():
        print(f"| {name} | " + " | ".join(f"{v:.2f}" if v < 10 else f"{v:.0f}" for v in values) + " |")


if __name__ == "__main__":
    main()
