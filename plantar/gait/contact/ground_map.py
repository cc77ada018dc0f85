"""Ground under a swinging sole: a distance map, and its highest part's plane.

The sensors' bias shows at lift-off, when the distance is the sole's rise.
"""

import math
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from plantar.common.record import Record
from plantar.common.settings.part import Part
from plantar.common.settings.schema import choice, share
from plantar.kernels.gait.ground_sight import GroundSight
from plantar.layouts.layout import SoleLayout
from plantar.percepts.percept import Percept
from plantar.percepts.percept_options import PROXIMITY_GAIN
from plantar.sensing.virtual_wrench import virtual_ground_reaction_wrench

_LARGEST_BIAS_STEP = 0.0025  # chosen: leg that one touch changes the bias by: more is ground that moved
_NEAR_TOUCH = 0.025  # chosen: leg that the ground may seem away at a touch for the bias to learn from it
_EVEN = 0.9  # chosen: share of the taxels that see ground which lies on a plane where all of it is one
_LIFTED_OFF = 1 / 120  # chosen: leg that a sole has risen when it is compared with the distance it sees
# derived: leg: standard deviation of a taxel's distance that is expected at least; 2 mm on h1, the noise of a reading
# in a scene
_LEAST_NOISE = 1 / 300
_NOISE_SHARE = 0.02  # chosen: share of a reading in what is known of that; fifty readings, a fifth of a second
_LEAST_BIAS = 0.75  # chosen: standard deviations of a taxel's distance that noise cannot make of that
# chosen: control ticks for which poses are kept, for readings that are late; 60 ms at 200 Hz, six times the delay of
# drawn sensors
_REMEMBERED = 12


class GroundMapSettings(
    Part, table="ground_map", needs={"control.pfc": (True,)}, given_by={"sensing_range": "sensing.proximity_range"}
):
    """Ground map of a swing foot, and its plane.

    Attributes:
        orientation: How the sole turns: "plane" fitted to the distances, or virtual "moment".
        sensing_range: Of proximity, in m.
        still: Move in m a control tick that halves it.
    """

    orientation: str = choice("plane", "moment")
    sensing_range: float = share(1 / 12, "leg", 0.005, 0.5)  # nature: T 4.2.1, 50 mm on h1
    # Slope in rad beyond which the sole does not follow the ground; chosen: 14 degrees
    largest_slope: ClassVar[float] = 0.25
    # Number of taxels that must lie on a slope for the sole to follow it; chosen: a quarter of 42: fewer lie in a
    # corner
    follow_taxels: ClassVar[int] = 10
    # Number averaged while the sole stands still; chosen: 60 readings, 0.24 s: the noise of 2 mm becomes 0.26 mm
    readings: ClassVar[int] = 60
    # The same while it moves fast; chosen: five readings, 20 ms, in which a descending foot moves by a millimetre
    readings_moving: ClassVar[int] = 5
    still: float = share(1 / 6000, "leg", 1e-06, 0.01)  # chosen: 0.1 mm a tick, 20 mm/s
    # Difference from the map, in standard deviations, that shows moved ground; nature: one normal value in 5e8 is
    # farther off
    jump: ClassVar[float] = 6.0
    # The same for the mean of all taxels, which is less noisy; chosen: the mean of 42 has 0.15 by noise, ten times less
    jump_of_all: ClassVar[float] = 1.5


class GroundView(Record, frozen=True):
    """The ground under a swinging sole.

    `distance`: down to the first contact in m; `middle`: down under the sole's middle in m; the same without a plane;
    `slope` of the ground along the sole's x, y (tangents) to turn by; None if too little is seen; `even`: whether
    nearly all lies on one plane.
    """

    distance: float
    middle: float
    slope: tuple[float, float] | None
    even: bool = True


class GroundMap:
    """Ground under one sole since lift-off. `bias`: distances' known excess in m."""

    def __init__(self, layout: SoleLayout, settings: GroundMapSettings) -> None:
        self.layout = layout
        self.settings = settings
        self.bias = 0.0
        self._centre = layout.positions.mean(axis=0)
        self._spread = ((layout.positions - self._centre) ** 2).mean(axis=0)[:2]
        self._leg = settings.body.leg
        self._sight = GroundSight(
            layout.positions,
            layout.outline,
            (settings.readings_moving, settings.readings, settings.still),
            (_LEAST_NOISE * self._leg, _NOISE_SHARE),
            (settings.jump, settings.jump_of_all),
            (settings.follow_taxels, settings.largest_slope),
            _REMEMBERED,
        )
        self._distance = np.asarray(self._sight.distance)
        self._read = -math.inf
        self._rising = False
        self._stood: tuple[NDArray[np.float64], NDArray[np.float64]] | None = None
        self._liftoff: float | None = None

    @property
    def distance(self) -> NDArray[np.float64]:
        """Each taxel's distance (n,) from the ground in m, less the bias; inf or NaN if unseen."""
        return self._distance - self.bias

    def begin(self) -> None:
        """Empty the map for a swing."""
        self._sight.begin()
        self._read = -math.inf
        self._rising = True
        self._liftoff = None if self._stood is None else self._height(*self._stood)
        self._stood = None

    def stand(self, position: NDArray[np.float64], rotation: NDArray[np.float64]) -> None:
        """Store the loaded sole's height before lift-off: estimated `position` (3,), world frame, in m, and `rotation`
        to world (3, 3).
        """
        self._stood = (position, rotation)

    def update(
        self, percept: Percept, position: NDArray[np.float64], rotation: NDArray[np.float64], time: float
    ) -> GroundView | None:
        """Returns the ground with the new `percept` of a sole at a `time` in s, or None if unseen; `position` and
        `rotation` as of `stand`.
        """
        sight = self._sight
        sight.move(time, position, rotation)
        distances = percept.reading.proximity
        read = percept.reading.time
        if distances is not None and read > self._read:
            self._read = read
            sight.mix(distances, read, position, rotation)
        view = self._view()
        if not self._rising:
            return view
        return self._lifted_off(view, self._height(position, rotation))

    def touched(self) -> None:
        """At touchdown the map's remaining distance is the bias."""
        view = self._view()
        if view is not None and abs(view.distance) < _NEAR_TOUCH * self._leg:
            largest = _LARGEST_BIAS_STEP * self._leg
            self.bias += min(largest, max(-largest, 0.5 * view.distance))

    def _height(self, position: NDArray[np.float64], rotation: NDArray[np.float64]) -> float:
        return float(position[2] + rotation[2, :2].dot(self._centre[:2]))

    def _lifted_off(self, view: GroundView | None, height: float) -> GroundView | None:
        """Bias from a sole just risen to a height in m."""
        if self._liftoff is None:
            self._liftoff = height
        risen = height - self._liftoff
        if risen < _LIFTED_OFF * self._leg:
            return view
        self._rising = False
        if view is None or not view.even or abs(view.middle - risen) < _LEAST_BIAS * self._sight.noise:
            return view
        self.bias += view.middle - risen
        return self._view()

    def _view(self) -> GroundView | None:
        sight = self._sight
        if not sight.look(self.bias):
            return None
        slope: tuple[float, float] | None = None  # too little to stand on, or too steep: the sole stays level
        if sight.sloped:
            slope = (sight.slope_x, sight.slope_y)
            if sight.found and self.settings.orientation == "moment":
                slope = self._slope_of_moment(sight.seen)
        return GroundView(sight.nearest, sight.middle, slope, sight.on_plane > _EVEN * sight.seen)

    def _slope_of_moment(self, count: int) -> tuple[float, float]:
        """Slope for a level sole by the virtual moment about its middle (T 4.26)."""
        distance = self._distance - self.bias
        wrench = virtual_ground_reaction_wrench(self.layout, distance, PROXIMITY_GAIN, self.settings.sensing_range)
        moment_x = wrench[3] - self._centre[1] * wrench[2]
        moment_y = wrench[4] + self._centre[0] * wrench[2]
        return (
            float(-moment_y / (PROXIMITY_GAIN * count * self._spread[0])),
            float(moment_x / (PROXIMITY_GAIN * count * self._spread[1])),
        )
