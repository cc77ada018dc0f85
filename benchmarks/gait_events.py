"""Heel strikes and toe offs against truth, set by set: made gaits, and recordings with a maker's or a plate's events.

    python benchmarks/gait_events.py [--recordings FOLDER] [--with MODULE:FUNCTION]

A function of another algorithm takes times (n,) in s, vertical force (n,) in N and the kind ("insole" or "plate"), and
returns heel strikes and toe offs in s; `--threshold 20` measures a plain threshold in N. The last columns are errors of
the stance in percent of its length, of double support in points (both feet alike, half a stride apart) and of the
cadence in percent. A set of another's events decides: exit code 1 where its means are beyond 10 and 10 ms, 2 %, 1.5
points or 0.3 %. Made sets show that no shape of a contact is lost; their contacts begin and end at no force at all,
where neither a maker's insole nor a laboratory's plate has its events.
"""

import argparse
import os
import sys
from collections.abc import Callable, Iterator
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.formats import read_recording
from plantar.formats.stated_events import read_events
from plantar.gait.analysis.steps.events import find_contacts, force_levels, threshold_levels

Array = NDArray[np.float64]
Finder = Callable[[Array, Array, str], tuple[Array, Array]]
_SAME = 0.25


class Walk(NamedTuple):
    """A foot's vertical force (n,) in N over time (n,) in s, what measured it, and its true events in s."""

    time: Array
    force: Array
    kind: str
    strikes: Array
    lifts: Array


def humps(share: Array, valley: float, tail: float) -> Array:
    """Force over the stance in body weights: two humps with a valley, and an end that flattens by `tail`."""
    at = np.array([0.0, 0.04, 0.1, 0.2, 0.35, 0.5, 0.65, 0.79, 0.88, 0.94, 0.975, 1.0])
    high = np.array([0.0, 0.35, 0.8, 1.08, 0.95, valley, 0.95, 1.1, 0.75, 0.35 - tail, 0.12 - 0.5 * tail, 0.0])
    curve = np.interp(share, at, high)
    return np.where((share > 0.0) & (share < 1.0), curve, 0.0)


def made(shape: Callable[[Array], Array], stride: float, stance: float, rate: float, kind: str, seed: int) -> Walk:
    """A walk of twelve strides whose timing and height vary as people's do, with 1 % noise."""
    random = np.random.default_rng(seed)
    strikes = 0.5 + np.cumsum(stride * (1.0 + 0.02 * random.standard_normal(12)))
    lasts = stance * (1.0 + 0.02 * random.standard_normal(12))
    time = np.arange(0.0, strikes[-1] + stance + 1.0, 1.0 / rate)
    force = np.zeros_like(time)
    for on, last in zip(strikes, lasts, strict=True):
        force += 700.0 * (1.0 + 0.03 * random.standard_normal()) * shape((time - on) / last)
    return Walk(time, force + random.normal(0.0, 4.0, len(time)), kind, strikes, strikes + lasts)


def pressed_on(shape: Callable[[Array], Array], press: float) -> Callable[[Array], Array]:
    """A shape whose shoe presses on by a share of body weight after the foot has left, dying away."""

    def with_tail(share: Array) -> Array:
        return shape(share) + np.where(share >= 0.99, press * np.exp(-(share - 0.99) / 0.05), 0.0) * (share < 1.5)

    return with_tail


def half_sine(share: Array) -> Array:
    return np.where((share > 0.0) & (share < 1.0), 1.2 * np.sin(np.pi * np.clip(share, 0.0, 1.0)), 0.0)


def sets(recordings: Path | None) -> Iterator[tuple[str, list[Walk]]]:
    for kind in ("insole", "plate"):
        for name, stride, stance in (
            ("fast", 0.95, 0.56),
            ("usual", 1.1, 0.68),
            ("slow", 1.5, 1.02),
            ("very slow", 2.0, 1.44),
        ):
            shapes = {
                "half sines": half_sine,
                "two humps": lambda s: humps(s, 0.75, 0.0),
                "flat end": lambda s: humps(s, 0.85, 0.08),
            }
            for title, shape in shapes.items():
                walks = [made(shape, stride, stance, rate, kind, i) for i, rate in enumerate((50.0, 100.0, 250.0))]
                yield f"made {title}, {name}, {kind}", walks
    for press in (0.03, 0.06):
        shape = pressed_on(lambda s: humps(s, 0.75, 0.0), press)
        yield (
            f"made two humps, shoe presses {100 * press:.0f} %, insole",
            [made(shape, 1.1, 0.68, r, "insole", 5) for r in (50.0, 100.0)],
        )
    yield (
        "made running, insole",
        [made(lambda s: 2.0 * half_sine(s), 0.72, 0.25, r, "insole", 7) for r in (100.0, 250.0)],
    )
    yield (
        "made running, plate",
        [made(lambda s: 2.0 * half_sine(s), 0.72, 0.25, r, "plate", 8) for r in (250.0, 1000.0)],
    )
    folders = [] if recordings is None else [recordings, recordings.with_name("laboratory")]
    for path in (path for folder in folders if folder.is_dir() for path in sorted(folder.iterdir())):
        report = path.with_name(f"{path.stem}_report.xlsx")
        if path.suffix in (".txt", ".c3d", ".csv") and (report.exists() or path.suffix == ".c3d"):
            recording = read_recording(path)
            events = read_events(report) if report.exists() else recording.events
            walks = [
                Walk(
                    recording.time,
                    foot.vertical_force,
                    recording.kind,
                    events[side].heel_strikes,
                    events[side].toe_offs,
                )
                for side, foot in recording.feet.items()
                if side in events
            ]
            if walks:
                yield f"{path.name} (its maker's events)", walks


def ours(time: Array, force: Array, kind: str) -> tuple[Array, Array]:
    levels = force_levels(force, "plate" if kind == "plate" else "insole")
    found = [] if levels is None else find_contacts(time, force, levels)
    strikes = [c.heel_strike for c in found if c.heel_strike is not None]
    return np.array(strikes, dtype=float), np.array([c.toe_off for c in found if c.toe_off is not None], dtype=float)


def crossings(time: Array, force: Array, kind: str, threshold: float) -> tuple[Array, Array]:
    """Events where the force crosses a plain threshold in N, of contacts that reach the usual level."""
    levels = force_levels(force, "plate" if kind == "plate" else "insole")
    found = [] if levels is None else find_contacts(time, force, threshold_levels(levels, threshold))
    strikes = [c.heel_strike for c in found if c.heel_strike is not None]
    return np.array(strikes, dtype=float), np.array([c.toe_off for c in found if c.toe_off is not None], dtype=float)


def matched(found: Array, true: Array) -> tuple[Array, Array]:
    """Found and true times of the true events that were found within 0.25 s."""
    if not len(found):
        return np.zeros(0), np.zeros(0)
    nearest = found[np.abs(found[None] - true[:, None]).argmin(axis=1)]
    near = np.abs(nearest - true) <= _SAME
    return nearest[near], true[near]


LIMITS = (10.0, 10.0, 2.0, 1.5, 0.3)
"""Largest mean errors of a set: strike and toe off in ms, stance in %, double support in points, cadence in %."""


def errors_of(pairs: list[tuple[Array, Array]], walks: list[Walk]) -> tuple[list[Array], tuple[float, ...]]:
    """Differences in s of strikes and of toe offs, and the mean errors that have limits."""
    strikes = [matched(f[0], w.strikes) for f, w in zip(pairs, walks, strict=True)]
    lifts = [matched(f[1], w.lifts) for f, w in zip(pairs, walks, strict=True)]
    on, off = (np.concatenate([found - true for found, true in each]) for each in (strikes, lifts))
    if not len(on) or not len(off):
        return [on, off], (float("nan"),) * len(LIMITS)
    lasts = [w.lifts[w.lifts > strike][:1] - strike for w in walks for strike in w.strikes]
    stance = float(np.mean(np.concatenate(lasts)))
    stride = float(np.mean(np.concatenate([np.diff(w.strikes) for w in walks])))
    longer = float(off.mean() - on.mean())
    spans = [np.ptp(found) / np.ptp(true) for found, true in strikes if len(true) > 1]
    cadence = 100.0 * (1.0 / float(np.mean(spans)) - 1.0)
    means = (1e3 * float(on.mean()), 1e3 * float(off.mean()))
    return [on, off], (*means, 100.0 * longer / stance, 200.0 * longer / stride, cadence)


def table(finder: Finder, recordings: Path | None) -> tuple[list[str], int]:
    """Rows of a table in Markdown, a set each, and the number of sets beyond a limit."""
    out = [
        "| set | events | found | strike: mean, SD, largest ms | toe off: mean, SD, largest ms | stance % | double "
        "support, points | cadence % |",
        "|---|---|---|---|---|---|---|---|",
    ]
    beyond = 0
    for name, walks in sets(recordings):
        both, errors = errors_of([finder(w.time, w.force, w.kind) for w in walks], walks)
        cells = [
            f"{1e3 * d.mean():+.1f}, {1e3 * d.std():.1f}, {1e3 * np.abs(d).max():.0f}" if len(d) else "-" for d in both
        ]
        cells += [f"{v:+.1f}" for v in errors[2:4]] + [f"{errors[4]:+.2f}"]
        count = sum(len(w.strikes) + len(w.lifts) for w in walks)
        beyond += not name.startswith("made") and not all(
            abs(v) <= most for v, most in zip(errors, LIMITS, strict=True)
        )
        out.append(f"| {name} | {count} | {sum(map(len, both))} | {' | '.join(cells)} |")
    return out, beyond


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--recordings", default=os.environ.get("PLANTAR_REAL_DATA"), help="folder of recordings")
    parser.add_argument("--with", dest="other", help="module:function of another algorithm")
    parser.add_argument("--threshold", type=float, help="N of a plain threshold")
    given = parser.parse_args()
    finder: Finder = ours if given.threshold is None else partial(crossings, threshold=given.threshold)
    if given.other:
        module, _, name = given.other.partition(":")
        finder = getattr(import_module(module), name)
    folder = None if given.recordings is None else Path(given.recordings)
    folder = folder / "recordings" if folder is not None and (folder / "recordings").is_dir() else folder
    lines, beyond = table(finder, folder)
    print("\n".join(lines))
    print(f"\n{len(lines) - 2} sets, {beyond} beyond a limit")
    sys.exit(bool(beyond))


if __name__ == "__main__":
    main()
