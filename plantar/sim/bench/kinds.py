"""The kinds of `plantar bench`, loaded when needed."""

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, NamedTuple

from plantar.common.atomic import output_folder, write_text
from plantar.common.console.command import file_lines
from plantar.common.console.progress import Progress, part_of, progress_bar
from plantar.common.optional_library import need_libraries
from plantar.errors import InputError
from plantar.kernels import need_compiled
from plantar.sim.libraries import LIBRARIES


@dataclass(frozen=True)
class BenchOptions:
    """Options; `measure` refuses those that a kind does not take.

    Attributes:
        scenarios: Number of scenarios of whole loop.
        first: Number of the first one.
        scene: Walks to run; all where empty.
        robot: Robots for them; all where empty.
        quick: Run the most informative cases, once.
        policy: Python file, or None for built-in controller.
        seeds: Runs of each trial.
    """

    scenarios: int = 10_000
    first: int = 0
    scene: tuple[str, ...] = ()
    robot: tuple[str, ...] = ()
    quick: bool = False
    policy: Path | None = None
    seeds: int = 100


class Measured(NamedTuple):
    """Plain JSON values, written files under "files", and failures, a line each."""

    result: dict[str, Any]
    text: str
    failures: tuple[str, ...] = ()


def measure(what: str, options: BenchOptions, output: Path) -> Measured:
    """Returns what came of a kind `what`, or "all", with `options`; files go to `output`."""
    allowed = (*_PARTS, *_TABLES, "all")
    if what not in allowed:
        wrong = f"cannot measure '{what}'" if what else "give what to measure: plantar bench kernels"
        raise InputError(f"{wrong}; allowed: {', '.join(allowed)}")
    _check(what, options)
    of_kind = {"kernels": ("scipy", "cv2"), "all": (*LIBRARIES, "cv2")}
    need_libraries("sim", *of_kind.get(what, LIBRARIES))
    if what not in ("kernels", "contact"):
        need_compiled("walking")
    with progress_bar() as progress:
        if what in _TABLES:
            measured = _TABLES[what](output, options, progress)
            names = [str(output / name) for name in measured.result["files"]]
            measured.result["files"] = names
            return measured._replace(text=measured.text + file_lines(names))
        return _measure_parts(what, options, output, progress)


def _check(what: str, options: BenchOptions) -> None:
    for option in fields(options):
        takers = _TAKEN_BY[option.name]
        if getattr(options, option.name) != option.default and what not in takers:
            raise InputError(f"--{option.name} is for {' and '.join(takers)}, not '{what}': plantar bench {takers[0]}")


_TAKEN_BY: Mapping[str, tuple[str, ...]] = {
    "scenarios": ("stress",),
    "first": ("stress",),
    "scene": ("scenes", "footholds"),
    "robot": ("scenes", "footholds"),
    "policy": ("footholds",),
    "seeds": ("footholds",),
    "quick": ("all", "scenes"),
}


def _scenes(output: Path, options: BenchOptions, progress: Progress) -> Measured:
    from plantar.sim.bench.scenes.scenes_report import measure_scenes, scenes_text

    result = measure_scenes(output, progress, options.scene, options.robot, options.quick)
    return Measured(result, scenes_text(result))


def _stress(output: Path, options: BenchOptions, progress: Progress) -> Measured:
    from plantar.sim.bench.stress.stress_run import measure_stress, stress_loop_text

    result = measure_stress(output, options.scenarios, options.first, progress)
    failures = [f"{len(result['failures'])} of {options.scenarios} scenarios failed"] if result["failures"] else []
    return Measured(result, stress_loop_text(result), tuple(failures))


def _footholds(output: Path, options: BenchOptions, progress: Progress) -> Measured:
    from plantar.sim.bench.footholds.measure_footholds import footholds_text, measure_footholds

    result = measure_footholds(output, options.policy, options.robot, options.seeds, options.scene, progress)
    return Measured(result, footholds_text(result))


# Kinds whose tables grow in the folder itself and are gone on with
_TABLES: Mapping[str, Callable[[Path, BenchOptions, Progress], Measured]] = {
    "scenes": _scenes,
    "stress": _stress,
    "footholds": _footholds,
}


def _kernels(folder: Path, options: BenchOptions, progress: Progress) -> Measured:
    from plantar.bench.report import kernel_text, measure_kernels

    result = measure_kernels(folder, progress, rounds=3 if options.quick else 9)
    return Measured(result, kernel_text(result))


def _skip(folder: Path, options: BenchOptions, progress: Progress) -> Measured:
    from plantar.sim.bench.skipping import SCENES, measure_skipping, skip_text

    few, rounds = (SCENES[:1], 1) if options.quick else (SCENES, 3)
    result = measure_skipping(folder, progress, few, rounds)
    same = "a run that skips what its scene does not need moves otherwise than one that does not"
    return Measured(result, skip_text(result), () if result["same_motion"] else (same,))


# Kinds that write all their files at their end, in the order of `all`
_PARTS: Mapping[str, Callable[[Path, BenchOptions, Progress], Measured]] = {
    "kernels": _kernels,
    "skip": _skip,
}


def _measure_parts(what: str, options: BenchOptions, output: Path, progress: Progress) -> Measured:
    names = tuple(_PARTS) if what == "all" else (what,)
    result: dict[str, Any] = {}
    texts: list[str] = []
    failures: list[str] = []
    with output_folder(output) as folder:
        for i, name in enumerate(names):
            measured = _PARTS[name](folder, options, part_of(progress, i / len(names), 1 / len(names)))
            result[name] = measured.result
            texts.append(measured.text)
            failures += measured.failures
        files = [str(output / name) for part in result.values() for name in part.pop("files")]
        result["files"] = [*files, str(output / "bench.json")]
        write_text(folder / "bench.json", json.dumps(result, indent=1) + "\n")
    return Measured(result, "\n".join(texts) + file_lines(result["files"]), tuple(failures))
