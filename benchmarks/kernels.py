"""Kernels of perception next to libraries and published methods: `python benchmarks/kernels.py [-o DIR] [--quick]`.

Writes kernels.md, kernels.csv and kernels.png. Errors are relative, against exact references (`references.py` in
tests/plantar).
"""

import argparse
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from plantar.bench.comparison import Result
from plantar.bench.tables import Mark, cell, draw_errors, made_on, markdown_table, write_rows
from plantar.common.atomic import write_text
from plantar.kernels import compiled
from plantar.plotting import new_figure, save_figure

sys.path.insert(0, str(Path(__file__).parent.parent / "tests" / "plantar"))
from kernel_percepts import TAXELS, compare_forms, compare_percepts, compare_recordings
from kernel_shapes import compare_shapes
from sample_soles import SIZES


@dataclass(frozen=True)
class Target:
    """A wanted figure of the kernels, and a run's.

    `figure` of the run; the worst of all sizes; `at_least`: whether more is better.
    """

    what: str
    wanted: float
    figure: float
    unit: str
    at_least: bool
    where: str

    @property
    def met(self) -> bool:
        """Whether the run kept the limit."""
        return self.figure >= self.wanted if self.at_least else self.figure <= self.wanted

    @property
    def limit(self) -> str:
        """The limit in words."""
        return f"{'>=' if self.at_least else '<='} {self.wanted:g} {self.unit}".rstrip()


def measure_kernels(folder: Path, progress: Callable[[float, str], None], rounds: int = 9) -> dict[str, Any]:
    """Run the whole comparison and write its report into an existing `folder`, in `rounds` of medians.

    `progress` gets fraction done and text. Returns results and targets as plain JSON values, and file names.
    """
    parts: list[Iterator[tuple[str, list[Result]]]] = [compare_shapes(size, rounds) for size in SIZES]
    parts += [compare_percepts(rounds)]
    parts += [compare_recordings(rounds=max(3, rounds // 2)), compare_forms(rounds)]
    results: list[Result] = []
    total = 12 * len(SIZES) + 7
    done = 0
    for part in parts:
        for name, found in part:
            results += found
            done += 1
            progress(min(1.0, done / total), f"{name}, {found[0].size}")
    return {
        "results": [asdict(r) for r in results],
        "targets": [asdict(t) | {"met": t.met} for t in targets(results)],
        "files": write_kernel_report(folder, results),
    }


# Kernel, how many times faster than the fastest library it should be, and the route of ours
_FASTER: tuple[tuple[str, float, str], ...] = (
    ("hull + area", 50.0, "plantar, from active taxels"),
    ("hull + area", 30.0, "plantar, through a Percept"),
    ("concave outline", 20.0, "plantar"),
    ("rectangle inside, axis-aligned", 500.0, "plantar"),
    ("closest point", 10.0, "plantar"),
    ("inner offset", 10.0, "plantar"),
    ("walking tick", 20.0, "plantar"),
    ("walking tick", 20.0, "plantar, percepts"),
    ("hull + area of a recording", 100.0, "plantar"),
)

_RASTER = "largestinteriorrectangle's method, 1 mm"


def _of(results: Sequence[Result], kernel: str, route: str = "plantar") -> list[Result]:
    return [r for r in results if r.kernel == kernel and r.route == route]


def _faster(results: Sequence[Result], kernel: str, wanted: float, route: str) -> Iterator[Target]:
    """How many times faster our route is than the fastest library, at its worst size.

    Other answers, float32, and routes that use ours are left out.
    """
    found: list[tuple[float, str, str]] = []
    for mine in _of(results, kernel, route):
        rivals = [
            r
            for r in results
            if (r.kernel, r.size) == (kernel, mine.size) and not (r.ours or r.approximate)
            if not any(word in r.route for word in (" ready", "float32"))
        ]
        if rivals:
            best = min(rivals, key=lambda r: r.median_us)
            found.append((best.median_us / mine.median_us, best.route, mine.size))
    if found:
        ratio, rival, size = min(found)
        what = kernel if route in ("plantar", "plantar, from active taxels") else f"{kernel} ({route})"
        yield Target(f"{what} against {rival}", wanted, ratio, "times", True, size)


def targets(results: Sequence[Result]) -> list[Target]:
    """The targets whose kernels are among the results."""
    out = [target for wanted in _FASTER for target in _faster(results, *wanted)]
    for r in sorted(_of(results, "rectangle in the outline", _RASTER), key=lambda r: r.ratio)[:1]:
        out.append(Target(f"{r.kernel} against {_RASTER}", 100.0, r.ratio, "times", True, r.size))
    for kernel, route, what, limit, figure, unit in (
        ("walking tick", "plantar", "walking tick, both feet", 40.0, "median_us", "us"),
        ("percept", "plantar, every member", "every member of both feet", 1000.0, "median_us", "us"),
        (
            *("wrench of a recording", "plantar, with area and CoP"),
            *("wrench, area and CoP of a recording against its wrench alone", 2.5, "ratio", "times"),
        ),
    ):
        out += [Target(what, limit, getattr(r, figure), unit, False, r.size) for r in _of(results, kernel, route)]
    share = copy_share(results)
    if share is not None:
        what = "wrench of a recording, of the copy bandwidth"
        out.append(Target(what, 40.0, 100.0 * share, "%", True, "100000 x 102"))
    ours = [r for r in results if r.ours and r.error is not None]
    searched = [r for r in ours if "any angle" in r.kernel and "box" not in r.kernel]
    for what, limit, kept in (
        ("relative error of the exact kernels", 1e-12, [r for r in ours if r not in searched]),
        ("relative error at any angle", 1e-6, searched),
    ):
        if kept:
            worst = max(kept, key=lambda r: r.error or 0.0)
            out.append(Target(what, limit, worst.error or 0.0, "", False, f"{worst.kernel}, {worst.size}"))
    return out


def copy_share(results: Sequence[Result]) -> float | None:
    """Bytes a second of a recording's wrench over a copy's, or None.

    A copy reads and writes every byte; the wrench reads all and writes 6 numbers a frame.
    """
    ours = _of(results, "wrench of a recording")
    copy = _of(results, "wrench of a recording", "copy of the forces")
    return (1.0 + 6.0 / TAXELS) / 2.0 * copy[0].median_us / ours[0].median_us if ours and copy else None


def kernel_text(result: Mapping[str, Any]) -> str:
    """The kernels' medians, errors and met targets as text."""
    kernel = ""
    lines = []
    for row in result["results"]:
        if row["kernel"] != kernel:
            kernel = row["kernel"]
            lines.append(f"{kernel:58}{'median us':>12}{'spread':>8}{'ratio':>9}{'error':>10}")
        route = f"  {row['size']}: {row['route']}"
        error = "-" if row["error"] is None else f"{row['error']:.1e}"
        lines.append(f"{route:58}{row['median_us']:>12.2f}{row['spread']:>8.0%}{row['ratio']:>9.1f}{error:>10}")
    lines.append("wanted and reached, at the worst size:")
    for met, target in ((t.pop("met"), Target(**t)) for t in map(dict, result["targets"])):
        reached = f"{target.what}: {target.figure:.3g} {target.unit}".rstrip()
        lines.append(f"  {'met    ' if met else 'NOT MET'} {reached} (wanted {target.limit}; {target.where})")
    return "\n".join(lines)


def write_kernel_report(folder: Path, results: Sequence[Result]) -> list[str]:
    """Write kernels.md, kernels.csv and kernels.png of `results` into an existing `folder`; returns names."""
    write_rows(folder / "kernels.csv", [asdict(r) for r in results])
    write_text(folder / "kernels.md", _page(results))
    _draw(folder / "kernels.png", results)
    return ["kernels.md", "kernels.csv", "kernels.png"]


_HEAD = """# Perception kernels: run time against error

![Run time against error](kernels.png)

`python benchmarks/kernels.py` writes this page ({made}, kernels {form}). A time is the median of a call; all routes
of a kernel take turns, so ratios are reliable where times depend on the machine. An error is relative, against exact
integers or fractions (`tests/plantar/references.py`). Sizes: 5, 20 or 51 active hexagons of 691 mm^2, and 1,000 small
ones with holes (dense). A target compares with the fastest library that gives the same answer from the same input.
All routes are in `kernels.csv`.
"""


def _page(results: Sequence[Result]) -> str:
    rows = [
        (t.what, t.limit, f"{cell(t.figure)} {t.unit}", t.where, "yes" if t.met else "**no**") for t in targets(results)
    ]
    head = _HEAD.format(made=made_on(), form="compiled" if compiled else "interpreted")
    return f"{head}\n## Targets\n\n{markdown_table(('kernel', 'wanted', 'reached', 'at', 'met'), rows)}\n"


_PANELS = (
    *("hull + area", "concave outline", "closest point", "inner offset", "rectangle inside, axis-aligned"),
    *("rectangle inside, any angle", "rectangle in the outline", "parallelogram inside", "circle inside"),
)
_MARKERS = {"5": "o", "20": "s", "51": "^", "dense": "D"}


def _draw(path: Path, results: Sequence[Result]) -> None:
    figure, axes = new_figure(13.0, 12.0, 3, 3, squeeze=False)
    for axis, kernel in zip(axes.reshape(-1), _PANELS, strict=True):
        marks = [
            Mark(
                *(r.median_us, r.error, "plantar" if r.ours else r.route),
                *(r.ours, r.approximate, _MARKERS.get(r.size, "o")),
            )
            for r in results
            if r.kernel == kernel and r.error is not None
        ]
        draw_errors(axis, marks, (kernel, "median time of a call [us]", "relative error [-]"), 1e-17)
        axis.set_ylim(3e-18, 1e12)
        axis.set_yticks([1e-16, 1e-12, 1e-8, 1e-4, 1.0])
        if marks:
            axis.legend(fontsize=7, loc="upper left", framealpha=0.85)
    handles = [
        axes[0, 0].plot([], [], marker, color="#444444", label="1,000 cells" if size == "dense" else f"{size} active")[
            0
        ]
        for size, marker in _MARKERS.items()
    ]
    handles += axes[0, 0].plot([], [], "o", color="#444444", markerfacecolor="none", label="approximate")
    figure.legend(handles=handles, loc="outside lower center", ncols=5)
    figure.suptitle("Perception kernels: run time against error (lower left is better; 0 is drawn at 1e-17)")
    save_figure(figure, path)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("-o", "--output", type=Path, default=Path(__file__).parent)
    parser.add_argument("--quick", action="store_true", help="fewer rounds")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    result = measure_kernels(
        options.output, lambda share, text: print(text, file=sys.stderr), rounds=3 if options.quick else 9
    )
    print(kernel_text(result))


if __name__ == "__main__":
    main()
