"""Preemptive foot compliance: a swing that sees the ground (T 4.4.1, Fig. 49), by the laws of `ComplianceGains`."""

import math

import numpy as np
from numpy.typing import NDArray

from plantar.gait.contact.ground_map import GroundMap, GroundMapSettings, GroundView
from plantar.gait.feet.compliance_gains import ComplianceGains, TouchdownGains
from plantar.kernels.base.vectors import vector
from plantar.layouts.layout import SoleLayout
from plantar.mechanics.rotation import vector_from_rotation
from plantar.percepts.percept_options import PROXIMITY_GAIN
from plantar.sensing.virtual_wrench import SoleWrenchSwitch, early_stop, virtual_ground_reaction_wrench

# chosen: leg past the ground that it sees at which a sole that has not touched goes down twice as fast
_DOUBT = 1 / 600
_THERE = 1 / 300  # derived: leg before its place from which a sole is above it; 2 mm
# chosen: leg from the ground that a sole keeps until then, and more the further it has to go; two of the noise of a
# reading
_KEPT = 1 / 150
_LARGEST_RISE = 0.0412  # chosen: leg/beat at which a sole goes up that is too near to the ground; 0.1 m/s on h1
_LARGEST_DRIFT = 0.00206  # chosen: leg/beat that a body moves up or down above a foot that has touched; 5 mm/s on h1
_LARGEST_YIELD = 0.00824  # chosen: leg/beat at which a foot that has touched gives way; 20 mm/s on h1
# chosen: leg/beat^2 by which the speed of a sole in the air changes: sight comes in steps; 20 m/s^2 on h1
_LARGEST_CHANGE = 2.0
_LARGEST_TURN_CHANGE = 2.75  # chosen: rad/beat^2 of its turn, likewise
_SOONER = 0.45  # chosen: share of its time in which a hasty descent comes to the ground sooner
# chosen: of `reserve` before weight is put on a sole at which one that sees its ground late is there: 60 ms on h1, so
# that its touch is over. +-20 % moves the mean landing of two of h1's uneven walks by -7 to +5 %, and no digit of one
# of hrp2kai or of three turns with worn soles on poor ground
_BEFORE = 0.5
# measured: of `damping` that its time constant is at least: 36 ms on h1, the lag of drives. +-20 %: likewise, -4 to 0 %
_SHORTEST = 0.6
_LEVEL = np.zeros(3)
# derived: tangent of the slope that level ground may seem to have; 2 mm of noise, a mean of five, over half a sole, and
# twice
_SLOPE_OF_NOISE = 0.015


class SwingCompliance:
    """A sole's descent and load, from lift-off to landed.

    `double_support`: the walk's, in s. Attributes `force`: vertical in N on the sole, filtered; `by_wrench`: whether
    its law is "wrench"; `stopped`: whether virtual force has stopped the swing (T 4.31).
    """

    def __init__(
        self,
        layout: SoleLayout,
        gains: ComplianceGains,
        touchdown: TouchdownGains,
        ground: GroundMapSettings,
        double_support: float,
    ) -> None:
        self.layout = layout
        self.gains = gains
        self.touchdown = touchdown
        self.ground = GroundMap(layout, ground)
        self.switch = SoleWrenchSwitch(touchdown.contact_force)
        self._leg = gains.body.in_si("leg")
        self._half_loaded = 0.5 * double_support
        brief = min(1.0, double_support / gains.crawl_time)
        self._reserve = brief * gains.reserve
        self._late = gains.late_speed_ratio / brief
        self._speed_unit = gains.body.in_si("leg/beat")
        self._change = _LARGEST_CHANGE * gains.body.in_si("leg/beat^2")
        self._turn_change = _LARGEST_TURN_CHANGE * gains.body.in_si("rad/beat^2")
        self._arm = 0.5 * float(np.linalg.norm(np.ptp(layout.outline, axis=0)))  # m from the middle to an edge
        outline = layout.outline[:, 0]
        taxels = layout.positions[:, 0]
        # m of sole, at its heel or toe, that no taxel looks down from
        self._rim = float(max(taxels.min() - outline.min(), outline.max() - taxels.max()))
        self.by_wrench = gains.law == "wrench"
        self._whole = len(layout) * PROXIMITY_GAIN * ground.sensing_range  # N of a sole that touches everywhere
        self.begin()

    def begin(self, haste: float = 0.0) -> None:
        """A swing begins, with `haste` 0..1 (`plantar.gait.plan.leg_momentum`)."""
        self._haste = haste
        self.ground.begin()
        self.switch.reset()
        self.force = 0.0
        self._speed = 0.0
        self._drift = 0.0
        self._rate = 0.0
        self._turn = (0.0, 0.0)
        self._aim: float | None = None
        self._edge_left: float | None = None  # m that were left to go as the taxels passed an edge
        self._wrench = np.zeros(6)
        self.stopped = False

    def hasten(self) -> None:
        """The foot has to catch the body: it comes down as in a swing with all haste."""
        self._haste = 1.0

    def update_load(self, load: float) -> bool:
        """Whether the foot has landed (T 4.30 corrected), by `load` in N, less its tare."""
        self.force += 0.5 * (load - self.force)
        if not self.by_wrench:
            return self.switch.update_force(self.force)
        up = np.array([0.0, 0.0, self.force, 0.0, 0.0, 0.0])
        reach = self.ground.settings.sensing_range
        virtual = virtual_ground_reaction_wrench(self.layout, self.ground.distance, PROXIMITY_GAIN, reach)
        self._wrench = self.switch.update(up, virtual)
        return self.switch.landed

    def damped(self, planned: float, time_left: float, period: float) -> float:
        """Returns the descent in m in a tick: its plan, damped by the virtual force (T 4.4.1).

        A stopped foot (T 4.31) descends by what it lacks of a touching sole.

        `planned`: swing plan's downward speed in m/s; `time_left`: until the plan puts weight on it, in s; `period` of
        control in s.
        """
        g = self.gains
        force = float(self._wrench[2])
        self.stopped = self.stopped or bool(early_stop(self._wrench, g.stop * self._whole))
        gap = max(0.0, 1.0 - force / self._whole) * self.ground.settings.sensing_range
        late = time_left < g.crawl_time
        wanted = max(0.0, 1.0 - force / (g.stop * self._whole)) * planned
        if self.stopped or late:
            wanted = max(wanted, gap / g.damping)
        wanted += g.touch_speed * (self._late if late else 1.0)
        self._speed = min(wanted, g.top_speed, self._speed + g.acceleration * period)
        return self._moved(self._speed, period)

    def descent(
        self,
        view: GroundView | None,
        planned: float,
        remaining: float,
        time_left: float,
        period: float,
        to_come: float = 0.0,
    ) -> float:
        """Returns the descent in m in a tick; negative: up.

        `planned`: swing plan's downward speed in m/s; `remaining`: horizontal distance in m; `time_left`: until the
        plan puts weight on it, in s; negative if it does; `period` of control in s; `to_come`: descent in m that is
        commanded already and not seen yet (`SwingLag`).
        """
        g = self.gains
        if view is None:
            self._aim = None
            self._speed = min(planned, self._speed + g.acceleration * period)
            return self._moved(self._speed, period)
        distance = view.distance - to_come
        if self._aim is None:
            self._aim = distance
        above = remaining < _THERE * self._leg
        kept = g.margin if above else min(g.clearance, _KEPT * self._leg + g.clearance_slope * remaining)
        if not above and self._haste < 1.0:
            # A rim that no taxel looks down from may still be above an edge that these passed, where it waits if it
            # will have passed it at the foot's place.
            if distance - self._aim > kept:  # the ground is further down by more than the sole keeps of it
                self._edge_left = remaining
            edge = self._edge_left
            if edge is not None and edge - remaining < self._rim <= edge and self._has_time(distance, time_left):
                self._speed = 0.0
                down = self._moved(0.0, period)
                self._aim = distance - down
                return down
        left = self._aim - kept
        quick = 1.0 - _SOONER * self._haste
        # On ground that is not even a sole goes slowly, as far as it is down before it has to carry half of the weight.
        in_time = left / max(time_left + self._half_loaded, g.damping)
        time_left /= quick
        reserve = self._reserve
        hurry = min(1.0, 2.0 - time_left / reserve) if time_left < 2.0 * reserve else 0.0
        doubt = max(0.0, -view.distance) / (_DOUBT * self._leg)  # it should have touched already
        crawl = g.touch_speed * (1.0 + (self._late - 1.0) * hurry + doubt)
        damping = max(g.damping, (time_left - g.crawl_time) / g.steepness)
        if g.damping > reserve and left > g.margin:  # quick steps: it has to be there in time
            damping = min(damping, max(reserve, time_left / math.log(left / g.margin)))
        elif left > g.margin:  # so has one that sees its ground late: it is `margin` off it by then
            there = (time_left - _BEFORE * reserve) / math.log(left / g.margin)
            damping = max(min(damping, there), _SHORTEST * g.damping)
        damping *= quick
        rise = -_LARGEST_RISE * self._speed_unit
        wanted = left / damping + crawl if left > 0.0 else max(rise, left / g.damping)
        behind = distance - self._aim
        if above:
            wanted = max(wanted, crawl)
        elif planned < wanted:  # a hasty foot comes down as it comes to its place
            wanted += self._haste * (planned - wanted)
            self._aim += self._haste * behind
            behind = distance - self._aim
        most = g.top_speed if view.even else min(g.top_speed, max(g.rough_speed, in_time))
        self._speed = min(wanted, most, self._speed + g.acceleration * period)
        self._aim -= self._speed * period
        return self._moved(min(most, max(rise, self._speed + behind / g.correction)), period)

    def _has_time(self, distance: float, time_left: float) -> bool:
        """Whether a sole may wait, `distance` in m above ground, and still be there before weight is put on it."""
        down_in = min(distance, self.ground.settings.sensing_range) / self.gains.top_speed
        return time_left > 2.0 * self._reserve + down_in

    def _moved(self, wanted: float, period: float) -> float:
        """Descent in m in a tick at about a `wanted` speed in m/s."""
        most = self._change * period
        self._rate = min(self._rate + most, max(self._rate - most, wanted))
        return self._rate * period

    def turn(
        self,
        rotation: NDArray[np.float64],
        view: GroundView | None,
        period: float,
        expected: NDArray[np.float64] = _LEVEL,
    ) -> NDArray[np.float64]:
        """Turn of a tick, to the ground's slope, or to the expected one if too little is seen.

        `rotation`: sole's (3, 3), less its heading; `view` of the sole; None comes to rest; `period` of control in s;
        `expected`: that rotation's vector (3,) in rad on ground as expected. Returns the turn (3,) in rad, sole frame.
        """
        x = 0.0
        y = 0.0
        if view is not None and view.slope is None:
            x, y, _ = ((expected - vector_from_rotation(rotation)) / self.gains.turning).tolist()
        # chosen: at the range's end taxels drop out one by one and tilt the plane
        elif view is not None and view.slope is not None and view.distance < 0.8 * self.ground.settings.sensing_range:
            x = view.slope[1] / self.gains.turning
            y = -view.slope[0] / self.gains.turning
            size = math.hypot(x, y)
            largest = self.turn_rate(view.distance, view.slope, view.even)
            if size > largest:
                x = x * largest / size
                y = y * largest / size
        was_x, was_y = self._turn
        change = math.hypot(x - was_x, y - was_y)
        share = min(1.0, self._turn_change * period / change) if change > 0.0 else 1.0
        self._turn = was_x + share * (x - was_x), was_y + share * (y - was_y)
        x, y = self._turn
        return vector(x * period, y * period, 0.0)

    def turn_rate(self, distance: float, slope: tuple[float, float], even: bool = True) -> float:
        """Largest turning rate in rad/s: an edge descends no faster than the sole, unless slope exceeds noise.

        `distance`: down to the first contact in m; `slope`: ground's rise along the sole's x, y (tangents); `even`:
        whether it is all of the ground's, not that from a block's edge to the floor behind it.
        """
        g = self.gains
        gentle = (g.touch_speed + max(0.0, distance) / g.damping) / self._arm
        if not even:
            return min(g.turn_rate, gentle)
        return min(g.turn_rate, gentle + max(0.0, math.hypot(*slope) - _SLOPE_OF_NOISE) / g.turning)

    def holding(self, since: float) -> float:
        """Force in N of a foot `since` seconds after touchdown, until weight is put on it."""
        t = self.touchdown
        return t.touch_force + min(1.0, since / t.load_time) * (t.hold_force - t.touch_force)

    def yielding(self, load: float, target: float, above: float, period: float) -> float:
        """Returns the descent in m in a tick of a foot on ground, for a force; negative: up.

        `load`: vertical in N on the sole; `target`: desired force in N; `above`: height in m above touchdown, from
        which a lost foot returns; `period` of control in s.
        """
        g = self.gains
        t = self.touchdown
        missing = t.admittance * (target - load)
        drift = _LARGEST_DRIFT * self._speed_unit
        self._drift = min(drift, max(-drift, self._drift + missing * period / t.settling))
        wanted = missing + self._drift
        if load < 0.3 * t.hold_force:  # chosen: below, the foot may have left the ground
            wanted = max(wanted, g.touch_speed + above / g.damping)
        fastest = _LARGEST_YIELD * self._speed_unit
        self._speed = min(fastest, max(-fastest, wanted))
        return self._speed * period
