"""Members of a percept from proximity, temperature and acceleration."""

import numpy as np
from numpy.typing import NDArray

from plantar.common.lazy import lazy
from plantar.layouts.layout import SoleLayout
from plantar.percepts.percept_options import PerceptOptions
from plantar.sensing import ground_plane as _ground
from plantar.sensing import proximity as _proximity
from plantar.sensing import temperature as _temperature
from plantar.sensing import virtual_wrench as _virtual
from plantar.sensing.proximity import HeightContour
from plantar.sensing.reading import Reading


class VirtualMembers:
    """Members of a `Percept` other than forces; None without the modality."""

    layout: SoleLayout
    reading: Reading
    options: PerceptOptions

    @lazy
    def near(self) -> NDArray[np.bool_] | None:
        """Taxels (n,) nearer than the layout's proximity threshold (T 4.2.7 corrected)."""
        if self.reading.proximity is None:
            return None
        return _proximity.near_taxels(self.reading.proximity, self.layout.proximity_threshold)

    @lazy
    def preemptive_polygon_in_sole(self) -> NDArray[np.float64] | None:
        """Preemptive support polygon (k, 2) in sole frame in m, empty if none is near (T 4.2.7 corrected)."""
        return None if self.near is None else _proximity.cells_polygon(self.layout, self.near)

    @lazy
    def height_contours_in_sole(self) -> tuple[HeightContour, ...] | None:
        """Contours of the ground, lowest first (T 4.2.7 corrected, Fig. 39-b)."""
        if self.reading.proximity is None:
            return None
        return _proximity.height_contours(self.layout, self.reading.proximity, self.options.contour_heights)

    @lazy
    def virtual_wrench_in_sole(self) -> NDArray[np.float64] | None:
        """Virtual ground reaction wrench (6,) about sole origin in N and N m (T 4.26)."""
        if self.reading.proximity is None:
            return None
        return _virtual.virtual_ground_reaction_wrench(self.layout, self.reading.proximity, self.options.proximity_gain)

    @lazy
    def ground_plane_in_sole(self) -> _ground.GroundPlane | None:
        """Ground plane in sole frame: height, slope, residual; None also out of range."""
        return None if self.reading.proximity is None else _ground.fit_ground_plane(self.layout, self.reading.proximity)

    @lazy
    def temperature_wrench_in_sole(self) -> NDArray[np.float64] | None:
        """Virtual wrench (6,) away from heat, 1 N a kelvin, about sole origin (T 3.34-3.37)."""
        if self.reading.temperature is None:
            return None
        return _temperature.temperature_wrench(self.layout, self.reading.temperature)

    @lazy
    def temperature_footprint_in_sole(self) -> NDArray[np.float64] | None:
        """Convex polygon (k, 2) of warm cells in sole frame in m, empty if none (T 4.2.5)."""
        if self.reading.temperature is None:
            return None
        return _temperature.temperature_footprint(self.layout, self.reading.temperature)

    @lazy
    def acceleration_in_sole(self) -> NDArray[np.float64] | None:
        """Acceleration (n, 3) of each taxel in sole frame in m/s^2; NaN if dead."""
        if self.reading.acceleration is None:
            return None
        if self.layout.is_flat:
            return self.reading.acceleration.copy()
        return np.asarray(np.einsum("nij,nj->ni", self.layout.rotations, self.reading.acceleration))
