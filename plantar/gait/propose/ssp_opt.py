"""SSP-Opt: swing foot's place and time for the DCM to reach the next phase's start (K 28-33).

With tau = e^(w t) the DCM at touchdown and the wanted one are linear (K 28, K 23-24): a convex quadratic program of
three numbers, the footstep in a convex polygon, tau in bounds.

    w_d |xi_s(u_e) - xi(tau)|^2 + c w_n (w_u |u_e - u_n|^2 + w_tau (tau - tau_n)^2) + (1 - c) w_s (same, u_s, tau_s)

In closed form: the polygon's closest point in the metric of the cost reduced by the best tau, or the bound that it
passes. tau is a share of its upper bound, w t cut at `ankle_strategy.MOST_GROWTH`.
"""

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.arguments import positive
from plantar.common.arrays import array
from plantar.common.settings.part import Part
from plantar.common.settings.schema import number, share
from plantar.common.sides import Side
from plantar.errors import InputError
from plantar.gait.balance.ankle_strategy import MOST_GROWTH, sway_share
from plantar.geometry.polygon import part_inside


class StepWeights(
    Part, table="step_weights", needs={"control.step_adjustment": (True,), "step_adjustment.method": ("ssp_opt",)}
):
    """Weights of a footstep change (K Table 1).

    Attributes:
        dynamics: w_d of the DCM error at touchdown.
        nominal: w_n of the difference from nominal, times confidence.
        smooth: w_s of the difference from the last tick, times 1 - confidence.
        location: Factor on w_u = 1 / (s_max - s_min) of the region.
        time: Factor on w_tau = 1 / (tau_max - tau_min).
    """

    dynamics: float = number(15.0, "1", 1e-3, 1e6)  # nature: K Table 1
    nominal: float = number(1.0, "1", 1e-3, 1e6)  # nature: K Table 1
    smooth: float = number(1.0, "1", 1e-3, 1e6)  # nature: K Table 1
    location: float = number(1.0, "1", 1e-3, 1e6)  # nature: K Table 1
    time: float = number(1.0, "1", 1e-3, 1e6)  # nature: K Table 1


class StepRegionRules(Part, table="step_region", needs={"control.step_adjustment": (True,)}):
    """Where the swing foot can land beside the stance foot (K 32).

    The paper's 0.2 m forward and 0.12 m outwards for a leg of 0.6 m cannot lengthen steps of 0.2 m.

    Attributes:
        forward: Farthest forward in m.
        backward: Farthest backward in m.
        clearance: Least gap in m between inner sole edges, side by side.
        outside: Largest distance in m between sole middle lines.
    """

    forward: float = share(0.417, "leg", 0, 1)  # chosen: 0.25 m on h1: steps of 0.2 m need more than the paper's
    backward: float = share(0.333, "leg", 0, 1)  # nature: K Table 1, 0.2 m
    clearance: float = share(0.0233, "leg", 0, 0.5)  # chosen: 14 mm on h1
    outside: float = share(0.55, "leg", 0, 1)  # chosen: 0.33 m on h1


def footstep_region(
    rules: StepRegionRules,
    swing: Side,
    stance: tuple[float, float, float],
    touching: float,
    half_planes: tuple[tuple[float, float, float], ...] = (),
) -> NDArray[np.float64]:
    """Returns the landing region (K 32): convex polygon (k, 2), world, in m, or empty.

    Args:
        rules: Box beside the stance foot.
        stance: (x, y, yaw), world frame, in m, m, rad.
        touching: Distance in m between sole origins with touching inner edges.
        half_planes: Lines (nx, ny, h), world frame: n . u > h is cut off.

    Example:
        >>> rules = StepRegionRules(forward=0.2, backward=0.2, clearance=0.01, outside=0.27)
        >>> footstep_region(rules, "left", (1.0, 0.0, 0.0), 0.14).round(9).tolist()
        [[0.8, 0.15], [1.2, 0.15], [1.2, 0.27], [0.8, 0.27]]
        >>> len(footstep_region(rules, "right", (1.0, 0.0, 0.0), 0.14, ((0.0, -1.0, 0.1),)))
        0
    """
    x, y, yaw = stance
    inside = touching + rules.clearance
    near, far = (inside, rules.outside) if swing == "left" else (-rules.outside, -inside)
    c = math.cos(yaw)
    s = math.sin(yaw)
    corners = ((-rules.backward, near), (rules.forward, near), (rules.forward, far), (-rules.backward, far))
    region = np.array([(x + c * ahead - s * aside, y + s * ahead + c * aside) for ahead, aside in corners])
    for nx, ny, h in half_planes:
        region = part_inside(region, nx, ny, h)
    return region


def touching_distance(outlines: Mapping[Side, NDArray[np.float64]]) -> float:
    """Distance in m between sole origins with touching inner edges, by `outlines` (k, 2) in m.

    Example:
        >>> square = np.array([(-0.1, -0.05), (0.1, -0.05), (0.1, 0.06), (-0.1, 0.06)])
        >>> round(touching_distance({"left": square, "right": square}), 3)
        0.11
    """
    return float(outlines["right"][:, 1].max() - outlines["left"][:, 1].min())


class SspProblem(NamedTuple):
    """A single support now, world frame.

    Attributes:
        omega: Pendulum's in rad/s.
        dcm: xi_c (2,) in m.
        vrp: u* (2,) in m until touchdown, cut to the support.
        offset: Push's u_w (2,) on the VRP in m.
        stance: u_i (2,) in m, stance foot's middle.
        elapsed: T_c since its start in s.
        target: Last tick's footstep and T_s in s: (x, y, time).
        region: Footstep's convex (k, 2) in m, counter-clockwise (`footstep_region`).
        shortest: Least T_s in s.
        longest: Largest T_s in s.
        next_stride: s_n (2,) in m to the next footstep.
        next_duration: T_n of the next single support in s.
        double_support: T_d in s, 0 or more.
        confidence: c: 1 keeps the nominal footstep, 0 the last tick's.
    """

    omega: float
    dcm: ArrayLike
    vrp: ArrayLike
    offset: ArrayLike
    stance: ArrayLike
    elapsed: float
    target: tuple[float, float, float]
    nominal: tuple[float, float, float]
    region: ArrayLike
    shortest: float
    longest: float
    next_stride: ArrayLike
    next_duration: float
    double_support: float = 0.0
    confidence: float = 0.0


class SspSolution(NamedTuple):
    """The best footstep.

    `place`: u_e (2,) in m; `time`: T_s in s; `missed`: DCM error (2,) in m at the next phase's start: xi(T_s) - xi_s;
    `at_bound`: -1 at the shortest time, 1 at the longest, else 0; `residual`: largest KKT violation, relative to the
    gradient's largest term.
    """

    place: NDArray[np.float64]
    time: float
    missed: NDArray[np.float64]
    at_edge: bool
    at_bound: int
    residual: float


class _Program(NamedTuple):
    """Cost in (u_x, u_y, s), s = tau / tau_max: weighted squares."""

    dynamics: float
    slope: float
    fixed: tuple[float, float]
    grown: tuple[float, float]
    place_weights: tuple[float, float]
    places: tuple[float, float]
    time_weight: float
    time: float
    low: float

    def reduced(self, ux: float, uy: float) -> float:
        """A footstep's best s, unbounded."""
        fx, fy = self.fixed
        gx, gy = self.grown
        lead = gx * (self.slope * ux + fx) + gy * (self.slope * uy + fy)
        return (self.dynamics * lead + self.time_weight * self.time) / (
            self.dynamics * (gx * gx + gy * gy) + self.time_weight
        )

    def gradient(self, ux: float, uy: float, s: float) -> tuple[float, float, float, float, float]:
        """Cost's gradient, and its largest term for place and s."""
        fx, fy = self.fixed
        gx, gy = self.grown
        wx, wy = self.place_weights
        px, py = self.places
        rx = self.slope * ux + fx - gx * s
        ry = self.slope * uy + fy - gy * s
        pull = self.dynamics * self.slope
        drawn = self.time_weight * (s - self.time)
        size = abs(fx) + abs(fy) + abs(self.slope) * (abs(ux) + abs(uy)) + (abs(gx) + abs(gy)) * s
        return (
            pull * rx + wx * (ux - px),
            pull * ry + wy * (uy - py),
            drawn - self.dynamics * (gx * rx + gy * ry),
            abs(pull) * size + (wx + wy) * (abs(ux) + abs(uy) + abs(px) + abs(py)),
            self.dynamics * (abs(gx) + abs(gy)) * size + self.time_weight * (s + abs(self.time)),
        )


def solve_ssp(problem: SspProblem, weights: StepWeights) -> SspSolution | None:
    """Best footstep and time (K 31-33); None for an empty region.

    Example:
        A robot that steps in place is pushed to the left; the left foot lands farther out, and sooner.

        >>> region = footstep_region(StepRegionRules(), "left", (0.0, -0.1, 0.0), 0.14)
        >>> pushed = SspProblem(
        ...     omega=3.44, dcm=[0.0, 0.02], vrp=[0.0, -0.07], offset=[0.0, 0.0], stance=[0.0, -0.1], elapsed=0.3,
        ...     target=(0.0, 0.1, 0.8), nominal=(0.0, 0.1, 0.8), region=region, shortest=0.5, longest=1.7,
        ...     next_stride=[0.0, -0.2], next_duration=0.8, confidence=1.0,
        ... )
        >>> found = solve_ssp(pushed, StepWeights())
        >>> found.place.round(3).tolist(), round(found.time, 3), found.residual < 1e-8
        ([0.0, 0.202], 0.649, True)
    """
    region: list[list[float]] = array(problem.region, "region", ("k", 2), finite=True).tolist()
    if not region:
        return None
    positive(problem.omega, "pendulum frequency", "rad/s")
    if not problem.shortest <= problem.longest:
        raise InputError(f"shortest single support is {problem.shortest} s, the longest {problem.longest} s")
    high = min(max(problem.longest, problem.elapsed), MOST_GROWTH / problem.omega)
    program = _program(problem, weights, region, high)
    (ux, uy), edges = _place_of_best_time(program, region)
    s = program.reduced(ux, uy)
    bound = 0
    if not program.low <= s <= 1.0:
        bound, s = (-1, program.low) if s < program.low else (1, 1.0)
        (ux, uy), edges = _place_of_time(program, region, s)
    missed = (
        program.grown[0] * s - program.slope * ux - program.fixed[0],
        program.grown[1] * s - program.slope * uy - program.fixed[1],
    )
    return SspSolution(
        np.array((ux, uy)),
        high + math.log(s) / problem.omega,
        np.array(missed),
        bool(edges),
        bound,
        _residual(program, (ux, uy, s), bound, edges, region),
    )


def _program(problem: SspProblem, weights: StepWeights, region: list[list[float]], high: float) -> _Program:
    """A problem's cost, with tau as a share of that at `high`."""
    w = problem.omega
    c = min(max(problem.confidence, 0.0), 1.0)
    x, y = array(problem.dcm, "DCM", (2,), finite=True).tolist()
    px, py = array(problem.vrp, "VRP", (2,), finite=True).tolist()
    ox, oy = array(problem.offset, "VRP offset", (2,), finite=True).tolist()
    ix, iy = array(problem.stance, "place of the stance foot", (2,), finite=True).tolist()
    sx, sy = array(problem.next_stride, "stride of the next step", (2,), finite=True).tolist()
    swayed = sway_share(w, problem.double_support)
    later = math.exp(-w * max(problem.next_duration + problem.double_support, 0.0))
    grown = math.exp(min(w * (high - problem.elapsed), MOST_GROWTH))
    low = math.exp(-w * max(high - max(problem.shortest, problem.elapsed), 0.0))
    by_nominal = c * weights.nominal
    by_target = (1.0 - c) * weights.smooth
    both = by_nominal + by_target
    nx, ny, nt = problem.nominal
    tx, ty, tt = problem.target
    # K Table 1: w_u = 1 / (s_max - s_min) along each axis, w_tau = 1 / (tau_max - tau_min). A region or a range of no
    # width leaves nothing to weigh.
    wide = max(p[0] for p in region) - min(p[0] for p in region)
    deep = max(p[1] for p in region) - min(p[1] for p in region)
    by_place = both * weights.location
    first = math.exp(-w * max(high - problem.shortest, 0.0))
    # nature: floating point: no division by 0
    by_time = both * weights.time * math.exp(min(w * high, MOST_GROWTH)) / max(1.0 - first, 1e-9)
    drawn = [math.exp(min(w * (t - high), MOST_GROWTH)) for t in (nt, tt)]
    return _Program(
        weights.dynamics,
        1.0 + swayed,
        # xi_s of K 23-24 less u* - u_w, where the u_w of both cancel.
        (sx * later - ix * swayed - px, sy * later - iy * swayed - py),
        (grown * (x - px + ox), grown * (y - py + oy)),
        (by_place / max(wide, 1e-3), by_place / max(deep, 1e-3)),  # chosen: a region of a millimetre is a point
        ((by_nominal * nx + by_target * tx) / both, (by_nominal * ny + by_target * ty) / both),
        by_time,
        (by_nominal * drawn[0] + by_target * drawn[1]) / both,
        low,
    )


def _place_of_best_time(program: _Program, region: list[list[float]]) -> tuple[tuple[float, float], list[int]]:
    """Best footstep with each one's best time, and its region edges."""
    d = program.dynamics
    k = program.slope
    gx, gy = program.grown
    fx, fy = program.fixed
    wx, wy = program.place_weights
    px, py = program.places
    # What is missed along `grown` can be made up for by time, and costs only what the time's weight leaves of it.
    square = gx * gx + gy * gy
    size = math.sqrt(square)
    left = program.time_weight / (d * square + program.time_weight)
    ex, ey = (gx / size, gy / size) if size > 0.0 else (1.0, 0.0)
    across = d * k * k
    along = d * k * k * left
    # Hessian across + (along - across) e e', with the weights of the place on its diagonal.
    sxx = across * ey * ey + along * ex * ex + wx
    syy = across * ex * ex + along * ey * ey + wy
    sxy = (along - across) * ex * ey
    # Drawn to what misses nothing at the time's own target across `grown`, and along it as far as the time resists.
    mx = fx - gx * program.time
    my = fy - gy * program.time
    off_across = ex * my - ey * mx
    off_along = ex * mx + ey * my
    qx = d * k * (-ey * off_across + left * ex * off_along) - wx * px
    qy = d * k * (ex * off_across + left * ey * off_along) - wy * py
    det = sxx * syy - sxy * sxy
    return _nearest(region, ((sxy * qy - syy * qx) / det, (sxy * qx - sxx * qy) / det), (sxx, sxy, syy))


def _place_of_time(program: _Program, region: list[list[float]], s: float) -> tuple[tuple[float, float], list[int]]:
    """Best footstep of one time, and its region edges."""
    d = program.dynamics
    k = program.slope
    wx, wy = program.place_weights
    px, py = program.places
    fx, fy = program.fixed
    gx, gy = program.grown
    sxx = d * k * k + wx
    syy = d * k * k + wy
    free = ((wx * px - d * k * (fx - gx * s)) / sxx, (wy * py - d * k * (fy - gy * s)) / syy)
    return _nearest(region, free, (sxx, 0.0, syy))


def _nearest(
    region: list[list[float]], free: tuple[float, float], metric: tuple[float, float, float]
) -> tuple[tuple[float, float], list[int]]:
    """Closest point of a convex polygon in a metric, and its edges; none inside."""
    x, y = free
    sxx, sxy, syy = metric
    count = len(region)
    inside = len(region) > 2
    best = (region[0][0], region[0][1])
    least = math.inf
    edges = [0]
    ax, ay = region[-1]
    for i in range(count):
        bx, by = region[i]
        dx = bx - ax
        dy = by - ay
        ox = x - ax
        oy = y - ay
        if dx * oy - dy * ox < 0.0 or not inside:
            inside = False
            # In a metric, too, what is closest lies on an edge that the free point is outside of.
            mx = sxx * dx + sxy * dy
            my = sxy * dx + syy * dy
            length = mx * dx + my * dy
            t = min(max((mx * ox + my * oy) / length, 0.0), 1.0) if length > 0.0 else 0.0
            rx = ox - t * dx
            ry = oy - t * dy
            off = sxx * rx * rx + 2.0 * sxy * rx * ry + syy * ry * ry
            if off < least:
                at = (ax + t * dx, ay + t * dy) if t < 1.0 else (bx, by)
                best = at
                least = off
                # At a corner, the edge that ends there comes first.
                edges = [i] if 0.0 < t < 1.0 else [i, (i + 1) % count] if t > 0.0 else [(i - 1) % count, i]
        ax = bx
        ay = by
    return (free, []) if inside else (best, edges)


def _residual(
    program: _Program, solution: tuple[float, float, float], bound: int, edges: list[int], region: list[list[float]]
) -> float:
    """Cost slope in the best allowed direction, relative to the gradient's largest term."""
    gx, gy, gs, size, time_size = program.gradient(*solution)
    by_time = abs(gs) if bound == 0 else max(0.0, -gs if bound < 0 else gs)
    if not edges:
        by_place = math.hypot(gx, gy)
    else:
        rays = []
        for i in edges:
            ax, ay = region[i - 1]
            bx, by = region[i]
            length = math.hypot(bx - ax, by - ay) or 1.0
            rays.append(((bx - ax) / length, (by - ay) / length))
        if len(edges) == 1:
            dx, dy = rays[0]
            inward = len(region) > 2
            by_place = max(abs(gx * dx + gy * dy), (gx * dy - gy * dx) if inward else 0.0)
        else:
            # The edge that ends at the corner is left backwards, the one that begins there forwards.
            (ax, ay), (bx, by) = rays
            by_place = max(0.0, gx * ax + gy * ay, -gx * bx - gy * by)
    return max(by_place / max(size, 1e-300), by_time / max(time_size, 1e-300))  # nature: floating point: 0 / 0 is 0
