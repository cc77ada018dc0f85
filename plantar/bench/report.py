"""The kernels' comparison as tables, a figure and a list of what was wanted and what was reached."""

from __future__ import annotations

import csv
import io
import platform
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from plantar.atomic import write_text
from plantar.bench.comparison import Result
from plantar.bench.kernels import RANDOM, compare_random_cells, compare_shapes
from plantar.bench.percepts import TAXELS, compare_forms, compare_percepts, compare_recordings
from plantar.bench.soles import SIZES
from plantar.kernels import compiled
from plantar.plotting import COLOURS, new_figure, save_figure

__all__ = ["Target", "compare_kernels", "copy_share", "measure_kernels", "targets", "write_kernel_report"]


@dataclass(frozen=True)
class Target:
    """Something wanted of the kernels, and what a run gave.

    Attributes:
        what: What is wanted.
        wanted: The limit.
        figure: What the run gave; the worst of all sizes.
        unit: Unit of both.
        at_least: Whether more is better.
        where: Where the worst was.
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

    def as_dict(self) -> dict[str, Any]:
        """The fields by name, and whether it is met."""
        return asdict(self) | {"met": self.met}


def compare_kernels(
    rounds: int = 9,
    progress: Callable[[float, str], None] | None = None,
    sizes: Sequence[str] = tuple(SIZES),
) -> list[Result]:
    """Run the whole comparison.

    Args:
        rounds: Rounds to take the medians over.
        progress: Called with the fraction done and a text.
        sizes: Which of `plantar.bench.soles.SIZES` to measure.

    Returns:
        The results, one a route, kernel and size.
    """
    parts: list[Iterator[tuple[str, list[Result]]]] = [compare_shapes(size, rounds) for size in sizes]
    parts += [
        compare_random_cells(rounds),
        compare_percepts(rounds),
        compare_recordings(rounds=max(3, rounds // 2)),
        compare_forms(rounds),
    ]
    results: list[Result] = []
    total = 13 * len(sizes) + len(RANDOM) + 7
    done = 0
    for part in parts:
        for name, found in part:
            results += found
            done += 1
            if progress is not None:
                progress(min(1.0, done / total), f"{name}, {found[0].size}")
    return results


def measure_kernels(folder: Path, progress: Callable[[float, str], None], rounds: int = 9) -> dict[str, Any]:
    """Run the whole comparison and write its report.

    Args:
        folder: Where to write; must exist.
        progress: Called with the fraction done and a text.
        rounds: Rounds to take the medians over.

    Returns:
        Results and targets as plain JSON values, and the names of the files.
    """
    results = compare_kernels(rounds, progress)
    return {
        "results": [r.as_dict() for r in results],
        "targets": [t.as_dict() for t in targets(results)],
        "files": write_kernel_report(folder, results),
    }


OURS = "plantar"
"""Name of our route, where there is one."""


def _of(results: Sequence[Result], kernel: str, route: str = "plantar") -> list[Result]:
    return [r for r in results if r.kernel == kernel and r.route.startswith(route)]


def _fastest(results: Sequence[Result], kernel: str, wanted: float, route: str) -> Iterator[Target]:
    """A target of how many times faster a route of ours is than the fastest library, at the size where it is least.

    A rival that gives another answer, computes in float32, or is handed what we make on the way, is none.
    """
    told: list[tuple[float, str, str]] = []
    for mine in (r for r in results if r.kernel == kernel and r.route == route):
        rivals = [r for r in results if (r.kernel, r.size) == (kernel, mine.size) and _is_rival(r)]
        if rivals:
            best = min(rivals, key=lambda r: r.median_us)
            told.append((best.median_us / mine.median_us, best.route, mine.size))
    if told:
        ratio, rival, size = min(told)
        what = kernel if route in (OURS, "plantar, from active taxels") else f"{kernel} ({route})"
        yield Target(f"{what} against {rival}", wanted, ratio, "times", True, size)


def _is_rival(result: Result) -> bool:
    apart = result.ours or result.approximate
    return not apart and not any(word in result.route for word in (" ready", "float32", "plain Python"))


def targets(results: Sequence[Result]) -> list[Target]:
    """What is wanted of the kernels next to what a run gave.

    Args:
        results: Results of `compare_kernels`.

    Returns:
        The targets whose kernels were measured.
    """
    out: list[Target] = []
    for kernel, wanted, route in (
        ("hull + area", 30.0, "plantar, from active taxels"),
        ("hull + area", 30.0, "plantar, through a Percept"),
        ("concave outline", 20.0, OURS),
        ("rectangle inside, axis-aligned", 500.0, OURS),
        ("closest point", 10.0, OURS),
        ("inner offset", 10.0, OURS),
        ("walking tick", 20.0, OURS),
        ("walking tick", 20.0, "plantar, percepts"),
        ("hull + area of a recording", 100.0, OURS),
    ):
        out += _fastest(results, kernel, wanted, route)
    rival = "largestinteriorrectangle's method, 1 mm"
    found = [r for r in results if (r.kernel, r.route) == ("rectangle in the outline", rival)]
    if found:
        least = min(found, key=lambda r: r.ratio)
        out.append(Target(f"{least.kernel} against {rival}", 100.0, least.ratio, "times", True, least.size))
    for r in _of(results, "walking tick"):
        out.append(Target("walking tick, both feet", 40.0, r.median_us, "us", False, r.size))
    for r in _of(results, "percept", "plantar, every member"):
        out.append(Target("every member of both feet", 1000.0, r.median_us, "us", False, r.size))
    share = copy_share(results)
    if share is not None:
        out.append(
            Target("wrench of a recording, of the copy bandwidth", 40.0, 100.0 * share, "%", True, "100000 x 102")
        )
    for r in _of(results, "wrench of a recording", "plantar, with area and CoP"):
        text = "wrench, area and CoP of a recording against its wrench alone"
        out.append(Target(text, 2.5, r.ratio, "times", False, r.size))
    ours = [r for r in results if r.ours and r.error is not None]
    for text, bound, kept in (
        (
            "relative error of the exact kernels",
            1e-12,
            [r for r in ours if "any angle" not in r.kernel or "box" in r.kernel],
        ),
        ("relative error at any angle", 1e-6, [r for r in ours if "any angle" in r.kernel and "box" not in r.kernel]),
    ):
        if kept:
            worst = max(kept, key=lambda r: r.error or 0.0)
            out.append(Target(text, bound, worst.error or 0.0, "", False, f"{worst.kernel}, {worst.size}"))
    return out


def copy_share(results: Sequence[Result]) -> float | None:
    """Bytes a second that the wrench of a recording moves, over those of a copy; None where it was not measured.

    A copy reads and writes every byte; the wrench reads every byte and writes 6 numbers a frame.
    """
    ours = _of(results, "wrench of a recording")
    copy = _of(results, "wrench of a recording", "copy of the forces")
    if not ours or not copy:
        return None
    return (1.0 + 6.0 / TAXELS) / 2.0 * copy[0].median_us / ours[0].median_us


def write_kernel_report(folder: Path, results: Sequence[Result]) -> list[str]:
    """Write kernels.md, kernels.csv and the figure kernels.png.

    Args:
        folder: Where to; exists.
        results: Results of `compare_kernels`.

    Returns:
        Names of the files.
    """
    write_text(folder / "kernels.csv", _csv(results))
    write_text(folder / "kernels.md", _markdown(results))
    _figure(folder / "kernels.png", results)
    return ["kernels.md", "kernels.csv", "kernels.png"]


def _csv(results: Sequence[Result]) -> str:
    text = io.StringIO()
    writer = csv.DictWriter(text, list(results[0].as_dict()), lineterminator="\n")
    writer.writeheader()
    writer.writerows(r.as_dict() for r in results)
    return text.getvalue()


def _number(value: float) -> str:
    return f"{value:.3g}" if value < 1000.0 else f"{value:.0f}"


def _markdown(results: Sequence[Result]) -> str:
    lines = [
        "# Perception kernels: run time against error",
        "",
        f"Written by `plantar bench kernels -o DIR`; one run of {time.strftime('%Y-%m-%d')} on {platform.machine()}, "
        f"Python {platform.python_version()}, numpy {np.__version__}, kernels "
        f"{'compiled' if compiled else 'interpreted'}. Times depend on the machine: trust the ratios.",
        "",
        "Each time is the median of a call over several rounds in which all routes take turns, with the interquartile",
        "range beside it. The error is the largest over the cases, relative, against an independent reference in exact",
        "integers or fractions, or a nested search where the result is not rational (`plantar/bench/references.py`).",
        "Cases: 51 hexagons of 691 mm^2 with 5, 20 or all active, and 1,000 small ones with holes (dense). Rivals get",
        "what suits them: cells, points or polygons as arrays ready in memory, unless the name says otherwise. The",
        "rectangle in the outline is compared with the best one known, of ours once shapely finds it inside and of a",
        "search over pairs of abscissae; of cells at random with the one that a search without end finds, and what is",
        "proven of all others has a row of its own; its error is the gap. The share of the copy bandwidth counts bytes",
        "read and written, of both.",
        "",
        "## Wanted and reached",
        "",
        "| what | wanted | reached, at the worst size | at | met |",
        "|---|---:|---:|---|---|",
    ]
    for t in targets(results):
        sign = ">=" if t.at_least else "<="
        unit = f" {t.unit}" if t.unit else ""
        lines.append(
            f"| {t.what} | {sign} {_number(t.wanted)}{unit} | {_number(t.figure)}{unit} | {t.where} "
            f"| {'yes' if t.met else '**no**'} |"
        )
    lines += ["", *RIVALS, "", *TRIED, "", "![run time against error](kernels.png)", ""]
    for kernel in dict.fromkeys(r.kernel for r in results):
        lines += [
            f"## {kernel[0].upper()}{kernel[1:]}",
            "",
            "| size | route | median us | spread | ratio | relative error |",
            "|---|---|---:|---:|---:|---:|",
        ]
        for r in results:
            if r.kernel == kernel:
                error = "-" if r.error is None else f"{r.error:.1e}"
                note = " (approximate)" if r.approximate else ""
                lines.append(
                    f"| {r.size} | {r.route}{note} | {_number(r.median_us)} | {100 * r.spread:.0f} % | "
                    f"{_number(r.ratio)} | {error} |"
                )
        lines.append("")
    return "\n".join(lines)


RIVALS: tuple[str, ...] = (
    "What the rivals of these targets are:",
    "",
    "- Of the libraries that give the same answer from the same input the fastest counts, at the size where it comes",
    "  nearest. Rows with points or polygons ready leave out what ours does, cv2 computes in float32, and plain Python",
    "  loops are no library; they are in the tables below. A third of the patterns are taxels at random.",
    "- hull + area: both sides start from the mask of active taxels and end with the area. The rival gathers the",
    "  corners of the active cells, each once, with a table made beforehand and `np.unique`, then calls Qhull, or",
    "  makes a GEOS multipoint and calls its hull. The rows with points ready leave the gathering out. Through a",
    "  Percept ours starts from the forces: reading, percept, active taxels, `support_area`.",
    "- outline: shapely makes the polygons of the active cells and unites them; the row with polygons ready leaves the",
    "  making out. Ours starts from the mask. Both end with the area.",
    "- axis-aligned rectangle: SLSQP with finite differences, four corners in every half plane, from a tenth of the",
    "  size about the mean vertex, ftol 1e-12; or with exact gradients and one corner in each, which is faster.",
    "  Polygons are ready.",
    "- circle: GEOS's maximum_inscribed_circle with its default tolerance, a thousandth of the size, the polygon made",
    "  on the way; a row to 1e-6 is beside it. It is approximate, and so is the raster of the rectangle.",
    "- rectangle in the outline: the run-length method of largestinteriorrectangle on a 1 mm raster, in numpy instead",
    "  of numba; making the raster counts, since ours needs none.",
    "- closest point: shapely makes polygon and point. Inner offset: it makes the polygon, then `buffer` with mitres.",
    "- walking tick: active, CoP, wrench, hull, area, centroid, offset polygon and clamped point of two feet from",
    "  their forces. Ours is `walking_tick`; the row of percepts reads the same from `Percept`. The rival's hull,",
    "  offset, centroid and clamp are GEOS's, its sums numpy's, matrices and a table of corners ready; with Qhull's",
    "  hull it is slower.",
    "- recording: a loop in Python over the frames, each as hull + area from active taxels.",
)
"""How the report says what was compared with what."""

TRIED: tuple[str, ...] = (
    "## What was tried where it is hard",
    "",
    "- Arrays by their memory: asked for its buffer, an array costs a kernel 125 ns before anything is computed, its",
    "  memory 5 ns, and numpy's C function makes a new one in a third of the time. Before, hull + area stood at 27",
    "  times, the walking tick at 15, the outline at 15, closest point and inner offset at 9; results are the same.",
    "- Hull + area through a `Percept` stood at 12 times: the hull took a fifth of it, the rest were objects made by",
    "  Python. Since then kernels construct readings and percepts, which run no Python where arrays come as they",
    "  should, and lazy members are compiled: about half of the time. 30 times would leave 0.6 us beside the hull's",
    "  walk; two objects and the copy of the forces take 0.35, the polygon's array 0.1, the member's function and its",
    "  place in the percept 0.2. Walks by pointers instead of buffers gave 2 %, an area without the array 10 % and a",
    "  second walk for who wants the polygon, too: not worth their lines. No references to the sole's arrays: 3 %.",
    "  `batch.support_polygons` has all of that once for all frames.",
    "- The tick of percepts stood at 17 times: mask, CoP, wrench and centroid are now made by the percept's kernel,",
    "  a float is taken as the distance without a call, and a small polygon's area needs no buffer. 19.4 to 22.",
    "- The walking tick and the inner offset keep the arrays that they work in, and the tick's kernel gives all",
    "  that the tick gives: 1.3 and 1.45 times faster in alternating runs, results the same to the last bit.",
    "- The walking tick and the rectangle along the axes were told as 26 and 809 times before, beside Qhull's hull and",
    "  SLSQP with finite differences: not the fastest rivals.",
    "- Every member: the rectangle at any angle in the outline is two fifths of it. Scans with golden sections took 4",
    "  ms a foot; intervals thrown away by a bound of first order 0.3 ms, but with one summit assumed in the last",
    "  0.012 rad. Now nothing is assumed: a bound of second order, pair by pair of trapezoids, which took the",
    "  evaluations from 70 a foot to 45. That of the convex polygon went from 300 evaluations to some 45 by steps",
    "  along the angles with such a bound. Testing whole intervals instead of asking each pair how far it is clear,",
    "  and branching at the kinks with what binds on one side alone, were no faster: where edges lie flush the area",
    "  has a kink that both read as a bend.",
    "  Members kept without a lock took the last 25 us of a percept of both feet under the target.",
    "- Rectangle at any angle in the outline of 1,000 small cells: it was reported 9.5e-4 short, but the reference",
    "  was, a scan in half degrees. The reference now refines the scan, and a test throws away all angles by the",
    "  bound of first order alone. Some outlines keep their largest area over many angles, which took that bound a",
    "  million evaluations.",
    "- Wrench of a recording: the share depends on what the copy reaches in the same minute, 14 to 30 GB/s on one",
    "  machine. Four sums a component, each in a loop of its own, took 8.5 ms to 7.4; one loop for all, masking in",
    "  the same loop and several streams of frames at a time did not help. A matrix product of BLAS takes 8.4 ms.",
    "- Outline, 5 active: the walk takes 0.4 us, the rest is Python's price. An object that the kernel makes without",
    "  a call of its constructor, one check instead of three and copies through bound methods took a quarter of that",
    "  away.",
)
"""What the report says of the ways that were tried."""

_PANELS = (
    "hull + area",
    "concave outline",
    "closest point",
    "inner offset",
    "rectangle inside, axis-aligned",
    "rectangle inside, any angle",
    "rectangle in the outline",
    "parallelogram inside",
    "circle inside",
)
_MARKERS = {"5": "o", "20": "s", "51": "^", "dense": "D"}
_RIVALS = ("#4c78a8", "#f2a541", "#59a14f", "#b279a2", "#9d755d", "#2f4b7c", "#76b7b2", "#e377c2", "#8c8c8c")
_FLOOR = 1e-17
"""Where an error of 0 is drawn."""


def _figure(path: Path, results: Sequence[Result]) -> None:
    """Run time against error, a panel a kernel; ours in colour, approximations hollow."""
    figure, axes = new_figure(13.0, 12.0, 3, 3, squeeze=False)
    for axis, kernel in zip(axes.reshape(-1), _PANELS, strict=True):
        found = [r for r in results if r.kernel == kernel and r.error is not None]
        rivals = list(dict.fromkeys(r.route for r in found if not r.ours))
        paint = {name: _RIVALS[i % len(_RIVALS)] for i, name in enumerate(rivals)}
        named: set[str] = set()
        for r in found:
            colour = COLOURS["cop"] if r.ours else paint[r.route]
            name = "plantar" if r.ours else r.route
            axis.plot(
                r.median_us,
                max(r.error or 0.0, _FLOOR),
                marker=_MARKERS.get(r.size, "o"),
                color=colour,
                markerfacecolor="none" if r.approximate else colour,
                linestyle="none",
                markersize=7,
                label=None if name in named else name,
            )
            named.add(name)
        axis.set(xscale="log", yscale="log", ylim=(3e-18, 1e12), title=kernel)
        axis.set_xlabel("median time of a call [us]")
        axis.set_ylabel("relative error [-]")
        axis.xaxis.set_minor_formatter("")
        axis.set_yticks([1e-16, 1e-12, 1e-8, 1e-4, 1.0])
        axis.grid(True, which="major", color="#e5e5e5", linewidth=0.6)
        if found:
            axis.legend(fontsize=7, loc="upper left", framealpha=0.85)
    for size, marker in _MARKERS.items():
        label = f"{size} active" if size != "dense" else "1,000 cells"
        axes[0, 0].plot([], [], marker=marker, linestyle="none", color="#444444", label=label)
    axes[0, 0].plot([], [], marker="o", linestyle="none", color="#444444", markerfacecolor="none", label="approximate")
    figure.legend(handles=axes[0, 0].get_lines()[-len(_MARKERS) - 1 :], loc="outside lower center", ncols=5)
    figure.suptitle("Perception kernels: run time against error (lower left is better; 0 is drawn at 1e-17)")
    save_figure(figure, path)
