"""A stance foot's support polygon by its taxels, from touchdown to lift-off (T 4.4.2-4.4.3).

A taxel that carried counts until lift-off: cells go dark as the ZMP moves away.
"""

import math
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from plantar.common.arrays import read_only
from plantar.common.settings.part import Part
from plantar.common.settings.schema import fixed, number, switch
from plantar.geometry.polygon import area, centroid, signed_margin
from plantar.kernels.gait.carried_load import mark_carried, take_in
from plantar.kernels.gait.seen_depth import SeenDepth
from plantar.layouts.layout import SoleLayout
from plantar.sensing.activation import TaxelActivation
from plantar.sensing.partial_contact import PartialContact
from plantar.sensing.reading import Reading

_NO_LINES = read_only(np.empty((0, 3)))
# measured: times in a row that silence denies the ground believed in until it counts: the mean of a load that jumps
# lies where it never was: of 400 touches of a whole sole in three places 76 lose a part after one, 18 after two, none
# after three
_DENIALS = 3
_IN_SIGHT = 1.5  # chosen: times a step down, below the range's end, from where a sole's sight of the ground counts
# chosen: s between readings that are taken, whose counts stand for 4 ms each: a sole that is read at 500 Hz would
# stand on what its first 6 ms touch
_APART = 0.003
_BESIDE = 0.3  # chosen: of a taxel's size from where the load is, towards the side that rises: what still lies under it


class ContactSettings(Part, table="contact", needs={"control.footholds": ("force", "skin")}):
    """Finding a foot's contact polygon by taxels.

    Attributes:
        level: Slope in rad of the sole against the ground above noise: then silent taxels on the rising side show
            nothing.
        model_error: Allowed force misfit, as a share of the largest force.
        remember: Whether a foot without sight presumes the last foothold's edges.
        fit: Whether edges are fitted to the loads; without, the contact polygon is the convex hull of the cells of
            active taxels, as printed (T 4.22, 4.24), by thresholds from their noise.
    """

    # Vertical force in N from which taxels count; chosen: 90 N on h1: a sole that carries less may lie on one edge
    minimum_load: float = fixed(0.107, "weight")
    # Readings with that load before the contact polygon counts; chosen: 12 ms: a touch's first readings come one after
    # the other
    settle_readings: ClassVar[int] = 3
    # Standard deviation of a taxel's noise in N; nature: the noise of a taxel in a scene, 1.5 N on h1
    taxel_noise: float = fixed(0.00178, "weight")
    # Share of a new reading in the running mean that decides whether a taxel has carried
    smoothing: ClassVar[float] = 0.3  # chosen: three readings, 12 ms
    # Share of the old in the running sum that edges are fitted to; chosen: twelve readings, 50 ms
    forgetting: ClassVar[float] = 0.92
    # Force in N that the ground believed in would put on a taxel, from which its silence counts
    least_expected: float = fixed(0.00593, "weight")  # derived: 3.3 of `taxel_noise`
    # Share of that force below which a taxel is silent; chosen: bounded by a taxel's gain and noise
    least_share: ClassVar[float] = 0.3
    # Depth in m below the nearest ground from which a taxel has no ground to stand on; chosen: 12 mm on h1: six times
    # the noise of a distance, below the thickness of a stone
    step_down: float = fixed(0.02, "leg")
    # Depth in m for all deeper or out of range; derived: the range of T 4.2.1: farther is not seen
    deep: float = fixed(1 / 12, "leg")
    sight: ClassVar[float] = 0.3  # Share of a new reading in the running mean of what is seen; derived: as `smoothing`
    # Number of taxels that have to see ground; derived: three span a plane, one more tells its error
    least_seen: ClassVar[int] = 4
    # Distance in m of the load from the believed polygon's edge, from which silence counts
    least_margin: float = fixed(0.12, "sole")  # chosen: 30 mm of 250, a taxel's width and a half
    # Share of the load that silent taxels should carry, from which the belief is wrong
    least_wrong: ClassVar[float] = 0.1  # chosen: bounded by what gains and noise leave
    level: float = number(1.5e-4, "rad", 0, 0.5)  # chosen: above the noise of a levelled sole
    # Running mean in N of a taxel that carried; derived: 5.6 standard deviations of that mean, by `taxel_noise` and
    # `smoothing`
    least_force: float = fixed(0.00415, "weight")
    # derived: Share of the strongest neighbor's force that its cover can cause; 10 % crosstalk makes a twentieth at a
    # straight edge
    least_beside: ClassVar[float] = 0.08
    model_error: float = number(0.1, "1", 0, 1)  # chosen: about the spread of taxels' gains
    # Share of the sole from which on the contact polygon counts as the whole sole; chosen: half a row of 42 taxels at
    # one side are missing
    full_ratio: ClassVar[float] = 0.93
    # Readings between two fits of a contact polygon that has settled; chosen: 32 ms; a time above all depends on it
    fit_every: ClassVar[int] = 8
    # Vertical force in N from which the foot stands and its loads show the edges
    standing_load: float = fixed(0.533, "weight")  # chosen: more than half of the weight: the other foot carries less
    # Readings of the ground from which a foothold is planned with before the foot is on it
    foresee_readings: ClassVar[int] = 6  # chosen: 24 ms
    # Distance in m that the foot may still have to go for that; chosen: 15 mm on h1, of an edge that is known to half a
    # cell
    foresee_reach: float = fixed(0.06, "sole")
    # Time in s before the planned touchdown from which it is too late for that
    foresee_least: float = fixed(0.283, "beat")  # chosen: 70 ms on h1
    remember: bool = switch(True)
    fit: bool = switch(True)
    # Time in s into single support until which it is refined; chosen: 0.15 s on h1, a sixth of a single support
    watch: float = fixed(0.607, "beat")


class StanceContact:
    """A foot's support over its stance. `sensing_range` of proximity, in m."""

    def __init__(self, layout: SoleLayout, settings: ContactSettings, sensing_range: float = math.inf) -> None:
        self.layout = layout
        self.settings = settings
        self._fit = PartialContact(layout)
        most = max((len(near) for near in layout.neighbours), default=0)
        self._near = np.full((len(layout), max(1, most)), -1, dtype=np.intp)
        for i, near in enumerate(layout.neighbours):
            self._near[i, : len(near)] = near
        self._whole_area = area(self._fit.polygon(np.empty((0, 3))))
        # From higher up, taxels that see no ground may only be out of range: that needs the sight of a step down.
        highest = sensing_range - _IN_SIGHT * settings.step_down
        self._sight = SeenDepth(len(layout), settings.least_seen, highest, settings.deep, settings.sight)
        self._depth = np.asarray(self._sight.depth)
        high = max(layout.contact_levels.cell, layout.force_threshold)
        taxels = TaxelActivation(high, layout.force_threshold, layout.force_limit)
        self._taxels = None if settings.fit else taxels
        self._active: NDArray[np.bool_] | None = None
        self.lift()

    def lift(self) -> None:
        """Clear a leaving foot's contact."""
        n = len(self.layout)
        self.settled = False
        self.polygon_in_sole: NDArray[np.float64] = self.layout.outline
        self.area_ratio = 1.0
        self._mean = np.zeros(n)
        self._carried = np.zeros(n, dtype=bool)
        self._sum = np.zeros(n)
        self._weight = 0.0
        self._count = 0
        self._idle = np.zeros(n, dtype=bool)
        self._sight.lift()
        self._edges: NDArray[np.float64] | None = None
        self._edges_of = 0
        self._seen_time = -1.0
        self._believed: NDArray[np.float64] | None = None
        self._remembered: NDArray[np.float64] | None = None
        self._denied = 0
        self.lines: NDArray[np.float64] = np.empty((0, 3))
        self._time = -1.0
        self._slope = np.zeros(2)
        self._fit.reset()
        if self._taxels is not None:
            self._taxels.reset()

    @property
    def whole(self) -> bool:
        """Whether, as known, the whole sole is supported."""
        return self.polygon_in_sole is self.layout.outline

    @property
    def seen(self) -> bool:
        """Whether the ground was seen before touchdown; found by loads alone, it can shrink."""
        return bool(self._sight.looks)

    @property
    def center_in_sole(self) -> NDArray[np.float64]:
        """Support polygon's centroid (2,), sole frame, in m."""
        found = centroid(self.polygon_in_sole)
        assert found is not None
        return found

    def update(self, reading: Reading, load: float, slope: NDArray[np.float64] | None = None) -> bool:
        """Returns whether a sole's latest `reading` settles or changes the polygon.

        `load` is vertical in N, `slope` the sole's rise (2,) along x, y against the ground in m/m, None for level.
        """
        s = self.settings
        if reading.time < self._time + _APART or load < s.minimum_load:
            return False
        self._time = reading.time
        if slope is not None:
            self._slope = self._slope + (s.smoothing if self._count else 1.0) * (slope - self._slope)
        self._count += 1
        if self._taxels is not None:
            self._active = self._taxels.update(reading.force)
        # The sum of the weights, for a mean that is right from the first reading on.
        self._weight = s.forgetting * self._weight + 1.0
        # The first reading begins the mean; from zero it would take long to rise. A dead taxel is a taxel without load,
        # not a fault of the foothold.
        take_in(reading.force, s.forgetting, s.smoothing if self._count > 1 else 1.0, self._sum, self._mean)
        if self._count >= s.settle_readings:
            # Ground that was seen needs no doubt of what lies next to it.
            mark_carried(self._mean, self._near, s.least_force, 0.0 if self.seen else s.least_beside, self._carried)
        if self._count < s.settle_readings or (self.settled and self._count % s.fit_every):
            return False
        return self._find()

    def expect(self, lines: NDArray[np.float64]) -> None:
        """Presume the last foothold's edges (m, 3) n . x <= h, sole frame, until loads contradict."""
        least = (1.0 - self.settings.full_ratio) * self._whole_area
        cut = [line for line in lines if area(self._fit.polygon(line[None])) < self._whole_area - least]
        kept = np.array(cut).reshape(-1, 3)
        left = self._fit.polygon(kept)
        if len(kept) and len(left) >= 3 and area(left) > least:
            self._remembered = kept

    def update_view(self, reading: Reading) -> None:
        """Add a descending foot's view; a `reading` without proximity is ignored."""
        distance = reading.proximity
        if distance is None or reading.time <= self._seen_time:
            return
        self._seen_time = reading.time
        self._sight.look(distance)

    def foresee(self, ahead: NDArray[np.float64]) -> NDArray[np.float64] | None:
        """Part (k, 2) of a descending sole in m that will carry; None for all, or too little seen.

        `ahead` (2,) in m: the sole's remaining move in its own plane.
        """
        if self._sight.looks < self.settings.foresee_readings:
            return None
        lines = self._from_sight()
        if lines is None or not len(lines):
            return None
        # The ground stays and the sole goes on: in the sole's frame as it lands the edges lie back by what is still
        # ahead.
        lines = np.column_stack([lines[:, :2], lines[:, 2] - lines[:, :2] @ ahead])
        polygon = self._fit.polygon(lines)
        if len(polygon) < 3 or area(polygon) > self.settings.full_ratio * self._whole_area:
            return None
        return polygon

    def _from_sight(self) -> NDArray[np.float64] | None:
        """Edges (m, 3) as seen before touchdown, or None."""
        looks = self._sight.looks
        if not looks:
            return None
        if self._edges_of != looks:  # a new view
            self._edges = _NO_LINES
            if self._sight.shows(self.settings.step_down):
                idle = self._depth > self.settings.step_down
                self._edges = self._fit.between(np.isfinite(self._depth) & ~idle, idle)
            self._edges_of = looks
        return self._edges

    def _find(self) -> bool:
        if self._active is not None:
            return self._take_cells(self._active)
        s = self.settings
        mean = self._sum / self._weight
        first = not self.settled
        before = self.polygon_in_sole
        self.settled = True
        if first:
            self._believed = self._from_sight()
        if self._believed is not None:
            outside = self._carried & (mean > s.least_expected) & ~self._over(self._believed)
            if int(outside.sum()) >= s.least_seen:
                self._believed = None  # what was seen there is not what carries
        lines = self._from_loads(mean) if self._believed is None else self._believed
        polygon = self._fit.polygon(lines)
        # A foot that still settles presses on a corner or a line; once it stands, the loads show the edges.
        if len(lines) and self._believed is None and float(mean.sum()) > s.standing_load:
            largest = float(mean.max())
            # Noise shrinks with the readings summed, what the model of the sole leaves out does not.
            noise = math.hypot(s.taxel_noise / self._weight**0.5, s.model_error * largest)
            found = self._fit.update(mean, self._carried, noise, start=lines)
            if found.residual < s.model_error * largest:
                polygon = found.polygon
                lines = found.lines
        if len(polygon) < 3:
            return first
        ratio = area(polygon) / self._whole_area
        # A sliver that is missing is an edge that was not found well, and not worth a change of the plan.
        if ratio > s.full_ratio or not len(lines):
            polygon = self.layout.outline
            ratio = 1.0
            lines = np.empty((0, 3))
        self.area_ratio = ratio
        self.polygon_in_sole = polygon
        self.lines = lines
        return first or polygon is not before

    def _take_cells(self, active: NDArray[np.bool_]) -> bool:
        """Take the hull of `active` cells (n,) (T 4.24) for the contact polygon."""
        first = not self.settled
        self.settled = True
        polygon, size, _, _ = self.layout.kernel.hull(active)
        if len(polygon) < 3:
            return first
        ratio = size / self._whole_area
        whole = ratio > self.settings.full_ratio
        if whole and self.whole:
            return first
        self.area_ratio = 1.0 if whole else ratio
        self.polygon_in_sole = self.layout.outline if whole else polygon
        return True

    def _from_loads(self, mean: NDArray[np.float64]) -> NDArray[np.float64]:
        """Edges (m, 3) as remembered unless loads contradict; else by loads."""
        if self._remembered is not None and self._beyond(self._remembered, mean):
            self._forget()
        silent = self._silent(mean)
        self._denied = 0 if silent is None else self._denied + 1
        lasts = self._denied >= _DENIALS
        if self._remembered is not None and lasts:
            self._forget()
        if self._remembered is not None:
            return self._remembered
        if silent is not None and lasts:
            self._idle |= silent
        self._idle &= ~self._carried
        return self._fit.between(self._carried, self._idle)

    def _forget(self) -> None:
        self._remembered = None
        self._fit.reset()

    def _beyond(self, lines: NDArray[np.float64], mean: NDArray[np.float64]) -> bool:
        """Whether taxels (n,) beyond lines carry more than neighbors on the ground give them."""
        carried = np.where(mean > self.settings.taxel_noise, mean, 0.0)
        return float(carried[~self._over(lines)].sum()) > self.settings.least_wrong * float(carried.sum())

    def _over(self, lines: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Taxels (n,) partly within lines."""
        # derived: Half the width of a hexagonal cell, which is 1.07 to 1.24 sqrt(A) for an area A.
        reach = 0.6 * math.sqrt(self.layout.cell_area)
        return np.asarray((self.layout.positions[:, :2] @ lines[:, :2].T < lines[:, 2] + reach).all(axis=1))

    def _silent(self, mean: NDArray[np.float64]) -> NDArray[np.bool_] | None:
        """Silent taxels (n,) that should carry on the believed ground, or None."""
        s = self.settings
        mean = np.where(mean > s.taxel_noise, mean, 0.0)  # noise that cannot be negative adds up
        load = float(mean.sum())
        if load <= 0.0:
            return None
        cop = (mean @ self.layout.positions[:, :2]) / load
        # A load near the edge lifts the rest off, whether there is ground or not: only a load well inside is evidence.
        lines = np.empty((0, 3)) if self._remembered is None else self._remembered
        if self._fit.edges is not None:
            lines = self._fit.edges.lines
        polygon = self._fit.polygon(lines)
        around = float(np.hypot(*(np.roll(polygon, -1, axis=0) - polygon).T).sum())
        if around <= 0.0:
            return None  # the lines of a noisy fit leave nothing: no ground that silence could deny
        # derived: 2 A / U is a circle's radius: 0.4 of it, for a polygon too small for the margin
        if signed_margin(polygon, cop) < min(s.least_margin, 0.8 * area(polygon) / around):
            return None
        expected = self._fit.expected(load, cop, lines)
        silent = (expected > s.least_expected) & (mean < s.least_share * expected) & ~self._carried
        silent &= ~self._risen(cop)
        # derived: Three at least: a dead taxel is silent, too.
        wrong = int(silent.sum()) >= 3 and float(expected[silent].sum()) > s.least_wrong * load
        return silent if wrong else None

    def _risen(self, cop: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Taxels (n,) lifted by a turned sole resting on an edge at a point (2,)."""
        s = self.settings
        places = self.layout.positions[:, :2]
        cell = math.sqrt(self.layout.cell_area)
        steep = float(np.hypot(self._slope[0], self._slope[1]))
        if steep <= s.level:
            return np.zeros(len(places), dtype=bool)
        return np.asarray((places - cop) @ self._slope > _BESIDE * cell * steep)
