"""Contact models compared on a pushed free body of 43 kg with one sole.

The truth is MuJoCo's contact wrench of the same step.
"""

import math
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np
from contact_soles import CANDIDATES, MASS, Candidate, Sole, bounding_rectangle, build_sole
from numpy.typing import NDArray

from plantar.geometry.polygon import area, convex_hull
from plantar.layouts.layout import SoleLayout
from plantar.mechanics.lip import GRAVITY
from plantar.sensing.force import center_of_pressure
from plantar.sim.model.contact_truth import contact_wrench_in_frame, foot_contacts, support_polygon_of_contacts

PLANE = '<geom name="ground" type="plane" size="2 2 0.1" {contact}/>'  # the ground
INNER = 0.7  # part of the half size within which loads are balanced
_BEAMS = (0.12, 0.06)  # widths in m
_TIPPED = math.radians(1.0)
_TIPPING_LOAD = 600.0  # N
_BEAM_OFFSETS = (-0.031, -0.013, 0.0, 0.009, 0.027)


@dataclass(frozen=True)
class ContactRow:
    """Figures of one contact model; inf: it toppled, or did not tip.

    Attributes:
        contacts: In full-sole stance.
        cop_median_mm: Taxel CoP error there; `cop_max_mm` the largest.
        moment_max_Nm: Largest error of (tx, ty).
        edge_x_mm: True CoP at tipping along x, less the true edge: negative tips early.
        seen_x_mm: Taxel CoP then, less the true edge.
        beam_contact_ratio: Contact hull over true contact area; mean over the beams.
        beam_taxel_ratio: The same of the active cells' corners.
        beam_silent_cells: Inactive cells with a quarter or more on the beam.
        step_us: Median of a full-sole physics step; `read_us` of a taxel reading.
    """

    name: str
    contacts: int
    cop_median_mm: float
    cop_max_mm: float
    force_max_N: float
    moment_max_Nm: float
    edge_x_mm: float
    edge_y_mm: float
    seen_x_mm: float
    seen_y_mm: float
    beam_contact_ratio: float
    beam_taxel_ratio: float
    beam_wrong_cells: int
    beam_silent_cells: int
    step_us: float
    read_us: float

    @property
    def millisecond_us(self) -> float:
        """Cost in us of a simulated ms: a step and a quarter reading (250 Hz)."""
        return self.step_us + 0.25 * self.read_us


class Rig:
    """A free sole that is pushed with a wrench."""

    def __init__(self, sole: Sole, layout: SoleLayout) -> None:
        self.sole = sole
        self.layout = layout
        self.data = mujoco.MjData(sole.model)
        self._body = sole.model.body("left_foot").id

    def push(
        self,
        force: float,
        point: NDArray[np.float64],
        tangential: tuple[float, float] = (0.0, 0.0),
        twist: float = 0.0,
    ) -> None:
        """Push to a normal `force` in N at a `point` (2,) in the sole frame in m, with `tangential` in N and `twist` in
        N m.
        """
        data = self.data
        at = data.site_xpos[self.sole.site]
        com = data.xipos[self._body] - at
        push = np.array([tangential[0], tangential[1], -force])
        # The ground's wrench about the sole's origin is (.., force y, -force x, ..): the push has the opposite moment.
        moment = np.array([-force * point[1], force * point[0], twist]) - np.cross(com, push)
        push[2] += MASS * GRAVITY
        data.xfrc_applied[self._body] = np.concatenate([push, moment])

    def step(self, count: int = 1) -> None:
        """Run the physics."""
        for _ in range(count):
            mujoco.mj_step(self.sole.model, self.data)

    def wrench(self) -> NDArray[np.float64]:
        """True wrench (6,) in the sole frame."""
        contacts = foot_contacts(self.sole.model, self.data, self.sole.geoms)
        site = self.sole.site
        return contact_wrench_in_frame(contacts, self.data.site_xpos[site], self.data.site_xmat[site])

    def tilt(self) -> float:
        """Angle in rad between the sole's normal and the vertical."""
        return math.acos(min(1.0, float(self.data.site_xmat[self.sole.site][8])))


def compare_contact_models(
    layout: SoleLayout,
    *,
    candidates: Iterable[Candidate] = CANDIDATES,
    seeds: int = 2,
    progress: Callable[[float, str], None],
) -> list[ContactRow]:
    """Returns a row a candidate of contact models against MuJoCo's contact wrench.

    The `layout`'s bounding rectangle is the true edge; `seeds` are random load cases at each of 25 CoPs in full-sole
    stance, `candidates` what is compared; `progress` gets fraction and text.
    """
    rows = []
    candidates = tuple(candidates)
    soles = [build_sole(candidate, layout, PLANE) for candidate in candidates]
    times = _run_times(soles, layout)
    for i, (candidate, sole) in enumerate(zip(candidates, soles, strict=True)):
        progress(i / len(candidates), candidate.name)
        rows.append(
            ContactRow(
                name=candidate.name,
                **full_stance(sole, layout, seeds),
                **tip_over(sole, layout),
                **_on_beams(candidate, layout),
                **times[i],
            )
        )
    return rows


def full_stance(sole: Sole, layout: SoleLayout, seeds: int) -> dict[str, Any]:
    """Errors in full-sole stance: CoP over the inner 70 %, 200-844 N, tangential loads, twist.

    Returns its fields of `ContactRow` for a `sole` of a `layout` on flat ground, with `seeds` load cases a CoP.
    """
    middle, half = bounding_rectangle(layout)
    targets = [middle + half * (x, y) for x in np.linspace(-INNER, INNER, 5) for y in np.linspace(-INNER, INNER, 5)]
    errors = []
    forces = []
    moments = []
    contacts = 0
    for seed in range(seeds):
        rng = np.random.default_rng(seed)
        rig = _standing(sole, layout, MASS * GRAVITY)
        contacts = int(rig.data.ncon)
        for target in targets:
            wrench = _loaded(rig, target, rng)
            if wrench is None:
                errors.append(math.inf)
                rig = _standing(sole, layout, MASS * GRAVITY)
                continue
            taxels = layout.wrench_map @ sole.read(rig.data)
            cop = _cop(taxels)
            true = _cop(wrench)
            errors.append(float(np.hypot(*(cop - true))) * 1e3)
            forces.append(abs(float(taxels[2] - wrench[2])))
            moments.append(float(np.hypot(*(taxels - wrench)[3:5])))
    return {
        "contacts": contacts,
        "cop_median_mm": float(np.median(errors)),
        "cop_max_mm": max(errors),
        "force_max_N": max(forces, default=math.inf),
        "moment_max_Nm": max(moments, default=math.inf),
    }


def _standing(sole: Sole, layout: SoleLayout, load: float) -> Rig:
    rig = Rig(sole, layout)
    rig.push(load, bounding_rectangle(layout)[0])
    rig.step(100)
    return rig


def _loaded(rig: Rig, target: NDArray[np.float64], rng: np.random.Generator) -> NDArray[np.float64] | None:
    """True wrench (6,) under a random load with a CoP (2,); None where toppled."""
    load = float(rng.uniform(200.0, 844.0))
    angle = float(rng.uniform(0.0, 2.0 * math.pi))
    side = float(rng.uniform(0.0, 0.3)) * load
    twist = float(rng.uniform(-5.0, 5.0)) * load / 844.0
    for _ in range(8):  # the push is about the sole's place, which moves a little
        rig.push(load, target, (side * math.cos(angle), side * math.sin(angle)), twist)
        rig.step(15)
    wrench = rig.wrench()
    return None if rig.tilt() > 0.02 or wrench[2] < 0.5 * load else wrench


def tip_over(sole: Sole, layout: SoleLayout) -> dict[str, Any]:
    """Where the sole tips as the load moves out at 40 mm/s.

    Returns its fields of `ContactRow` for a `sole` of a `layout` on flat ground.
    """
    out: dict[str, Any] = {}
    for name, direction in (("x", np.array([1.0, 0.0])), ("y", np.array([0.0, 1.0]))):
        edges, seen = zip(*(_edge(sole, layout, sign * direction) for sign in (-1.0, 1.0)), strict=True)
        out[f"edge_{name}_mm"] = float(max(edges, key=abs))
        out[f"seen_{name}_mm"] = float(max(seen, key=abs))
    return out


def _edge(sole: Sole, layout: SoleLayout, direction: NDArray[np.float64]) -> tuple[float, float]:
    """Distances beyond the true edge in mm, in a direction, where the sole tips, truly and by taxels."""
    middle, half_sizes = bounding_rectangle(layout)
    half = float(half_sizes @ np.abs(direction))
    rig = _standing(sole, layout, _TIPPING_LOAD)
    pivot = -math.inf
    shown = -math.inf
    reach = 0.9 * half
    while rig.tilt() < _TIPPED and reach < half + 0.03:
        reach += 0.04 * sole.model.opt.timestep
        rig.push(_TIPPING_LOAD, middle + reach * direction)
        rig.step()
        wrench = rig.wrench()
        if wrench[2] > 100.0:
            pivot = max(pivot, float((_cop(wrench) - middle) @ direction))
            cop = center_of_pressure(layout, sole.read(rig.data), 0.0)
            shown = shown if cop is None else max(shown, float((cop - middle) @ direction))
    return (pivot - half) * 1e3 if rig.tilt() >= _TIPPED else math.inf, (shown - half) * 1e3


def _on_beams(candidate: Candidate, layout: SoleLayout) -> dict[str, Any]:
    import shapely

    middle, half = bounding_rectangle(layout)
    contact_ratio = []
    taxel_ratio = []
    wrong = 0
    silent = 0
    shapes = [shapely.Polygon(layout.cell_polygon(i)) for i in range(len(layout))]
    for width in _BEAMS:
        for offset in _BEAM_OFFSETS:
            ground = (
                f'<geom name="beam" type="box" size="{0.5 * width} 1 0.05" pos="{middle[0] + offset} 0 -0.05" '
                "{contact}/>"
            )
            rig = Rig(build_sole(candidate, layout, ground), layout)
            for _ in range(20):
                rig.push(600.0, middle + np.array([offset, 0.0]))
                rig.step(10)
            low = middle[0] + offset - 0.5 * width
            high = middle[0] + offset + 0.5 * width
            true = width * 2.0 * half[1]
            contacts = foot_contacts(rig.sole.model, rig.data, rig.sole.geoms)
            contact_ratio.append(area(support_polygon_of_contacts([contacts])) / true)
            active = rig.sole.read(rig.data) > layout.force_threshold
            corners = [layout.cell_polygon(int(i)) for i in np.flatnonzero(active)]
            taxel_ratio.append(area(convex_hull(np.concatenate(corners))) / true if corners else 0.0)
            share = shapely.area(shapely.intersection(shapes, shapely.box(low, -1.0, high, 1.0))) / layout.areas
            wrong += int((active & (share == 0.0)).sum())
            silent += int((~active & (share >= 0.25)).sum())
    return {
        "beam_contact_ratio": float(np.mean(contact_ratio)),
        "beam_taxel_ratio": float(np.mean(taxel_ratio)),
        "beam_wrong_cells": wrong,
        "beam_silent_cells": silent,
    }


def _run_times(soles: Sequence[Sole], layout: SoleLayout) -> list[dict[str, Any]]:
    middle, half = bounding_rectangle(layout)
    rigs = [Rig(sole, layout) for sole in soles]
    for rig in rigs:
        rig.push(MASS * GRAVITY, middle + 0.1 * half)
        rig.step(100)
    steps, reads = np.zeros((2, len(rigs), 300))
    for k in range(300):
        for i, rig in enumerate(rigs):
            start = time.perf_counter()
            rig.step()
            between = time.perf_counter()
            rig.sole.read(rig.data)
            reads[i, k] = time.perf_counter() - between
            steps[i, k] = between - start
    return [
        {"step_us": float(step) * 1e6, "read_us": float(read) * 1e6}
        for step, read in zip(np.median(steps, axis=1), np.median(reads, axis=1), strict=True)
    ]


def _cop(wrench: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(np.array([-wrench[4], wrench[3]]) / wrench[2])
