"""Cost and error of a setting, and whether the scene's own stays."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import median
from typing import NamedTuple

from plantar.sim.bench.scenes.scene_setting import OWN, SETTINGS, setting_named

NOISE = "sensor noise"
"""Name of the row of how far the scene's own noise moves a walk, which errors are compared with."""

Runs = Sequence[Mapping[str, str]]


@dataclass(frozen=True)
class SceneRow:
    """A scene's setting next to its reference. Medians; NaN if not measured.

    Attributes:
        machine: Whether it is another robot.
        cpu: CPU time in s of a simulated second; `ratio` over the scene's own.
        com_mm: Root mean square error in mm until the runs part; `zmp_mm` likewise.
        force: The same of ground forces, over weight; `impact` over the reference's.
        together: Share of the walk until the runs part.
        walked: Whether the noiseless run was completed; `completed` counts those with noise.
        impact_N: Median over landings and runs.
        margin_mm: Smallest distance of ZMP and edge of support.
    """

    scene: str
    robot: str
    walk: str
    setting: str
    knob: str
    value: str
    against: str
    machine: bool
    cpu: float
    ratio: float
    com_mm: float
    zmp_mm: float
    force: float
    impact: float
    together: float
    walked: bool
    completed: int
    seeds: int
    impact_N: float
    margin_mm: float

    def within(self, other: "SceneRow") -> bool:
        """Whether it walks, with no error above another row's."""
        pairs = ((self.com_mm, other.com_mm), (self.zmp_mm, other.zmp_mm), (self.force, other.force))
        return self.walked and self.completed == self.seeds and self.together == 1.0 and all(a <= b for a, b in pairs)


def scene_rows(runs: Runs) -> list[SceneRow]:
    """A row for each scene, robot, setting and reference."""
    cases = list(dict.fromkeys((r["scene"], r["robot"], r["walk"]) for r in runs))
    order = {setting.name: number for number, setting in enumerate(SETTINGS)}
    rows = []
    for case in cases:
        mine = [r for r in runs if (r["scene"], r["robot"], r["walk"]) == case]
        pairs = dict.fromkeys((r["setting"], r["against"], r["kind"]) for r in mine if r["kind"] != "seeded")
        known = [pair for pair in pairs if pair[0] in order and pair[1] in order]
        for setting, against, kind in sorted(known, key=lambda p: (p[2] == "noise", order[p[1]], order[p[0]])):
            rows.append(_row(case, setting, against, kind, mine))
    return rows


def _row(case: tuple[str, str, str], name: str, against: str, kind: str, runs: Runs) -> SceneRow:
    setting = setting_named(name)
    compared = [r for r in runs if (r["setting"], r["against"], r["kind"]) == (name, against, kind)]
    seeded = [r for r in runs if r["setting"] == name and r["kind"] == "seeded"]
    own = {(r["kind"], r["seed"]): r for r in runs if r["setting"] == OWN.name and r["kind"] != "noise"}
    measured = [*compared, *seeded]
    ratios = [_cost(r) / _cost(own.get((r["kind"], r["seed"]), {})) for r in measured]
    whole = _median([_number(r, "together_s") / _number(r, "sim_s") for r in compared])
    return SceneRow(
        *case,
        setting=NOISE if kind == "noise" else name,
        knob=NOISE if kind == "noise" else setting.knob,
        value="" if kind == "noise" else setting.value,
        against=against,
        machine=setting.machine,
        cpu=_median([_cost(r) for r in measured]),
        ratio=_median(ratios),
        com_mm=_median([_number(r, "com_mm") for r in compared]),
        zmp_mm=_median([_number(r, "zmp_mm") for r in compared]),
        force=_median([_number(r, "force") for r in compared]),
        impact=_median([_number(r, "impact") for r in compared]),
        together=1.0 if whole > 0.99 else whole,
        walked=all(r["completed"] == "yes" for r in compared),
        completed=sum(r["completed"] == "yes" for r in seeded),
        seeds=len(seeded),
        impact_N=_median([_number(r, "impact_N") for r in seeded]),
        margin_mm=_median([_number(r, "margin_mm") for r in seeded]),
    )


def _cost(row: Mapping[str, str]) -> float:
    return _number(row, "cpu_s") / _number(row, "sim_s")


def _number(row: Mapping[str, str], name: str) -> float:
    return float(row.get(name) or "nan")


def _median(values: Sequence[float]) -> float:
    kept = [v for v in values if not math.isnan(v)]
    return median(kept) if kept else math.nan


_WORTH = 0.95  # of the time: a setting that saves less than a twentieth is no reason to change anything


class KnobVerdict(NamedTuple):
    """Whether the scene's knob value `stays`, and the `reason`."""

    scene: str
    robot: str
    knob: str
    stays: bool
    reason: str


def knob_verdicts(rows: Sequence[SceneRow]) -> list[KnobVerdict]:
    """A verdict for each knob with a row of noise.

    A value is good enough where it walks within noise of its reference. The scene's own is kept where good enough and
    no such value saves a twentieth of the time; knobs of the machine always.
    """
    found = []
    for case in dict.fromkeys((r.scene, r.robot, r.walk) for r in rows):
        mine = [r for r in rows if (r.scene, r.robot, r.walk) == case]
        noise = next((r for r in mine if r.setting == NOISE), None)
        if noise is None:
            continue
        for knob in dict.fromkeys(r.knob for r in mine if r.setting not in (OWN.name, NOISE, r.against)):
            values = [r for r in mine if r.knob == knob and r.setting != r.against]
            own = next((r for r in mine if r.setting == OWN.name and r.against == values[0].against), None)
            if own is not None:
                found.append(KnobVerdict(case[0], case[1], knob, *_verdict(own, values, noise)))
    return found


def _verdict(own: SceneRow, values: Sequence[SceneRow], noise: SceneRow) -> tuple[bool, str]:
    if values[0].machine:
        size = "no more than noise does" if own.within(noise) else "more than noise does"
        return True, f"as the papers' robots have it; the finest moves the walk by {_errors(own)}: {size}"
    cheaper = [r for r in values if r.ratio <= _WORTH]
    best = min((r for r in cheaper if r.within(noise)), key=lambda r: r.ratio, default=None)
    if best is not None:
        saved = f"{100 * (1 - best.ratio):.0f} % less time"
        return False, f"{best.value} would do: {saved}, CoM {best.com_mm:.2f} mm off, within noise"
    if not own.within(noise):
        finer = min((r for r in values if r.within(noise)), key=lambda r: r.ratio, default=None)
        if finer is not None:
            return False, f"differs by more than noise ({_errors(own)}); {finer.value} does not, at {finer.ratio:.2f} x"
        return True, f"differs by more than noise ({_errors(own)}), and so does all else of the knob"
    if not cheaper:
        return True, f"{_errors(own)}, within noise; nothing else saves a twentieth of the time"
    worse = min(cheaper, key=lambda r: r.com_mm if r.walked else float("inf"))
    lost = "does not walk" if not worse.walked else _errors(worse)
    return True, f"{_errors(own)}, within noise; {worse.value} saves {100 * (1 - worse.ratio):.0f} % but: {lost}"


def _errors(row: SceneRow) -> str:
    return f"CoM {row.com_mm:.2f} mm, ZMP {row.zmp_mm:.1f} mm, forces {100 * row.force:.1f} %"
