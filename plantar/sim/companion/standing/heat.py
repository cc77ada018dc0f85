"""How a hot plate warms taxels: radiation, and warm air above it.

A taxel's temperature T: C T' = eps^2 sigma F (T_p^4 - T^4) - h (T - T_air), with the view factor F of the plate's disc,
summed over areas as cos cos dA / (pi r^2) (Incropera, Fundamentals of heat and mass transfer, ch. 13). h includes
radiation to the room.
"""

import math
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.schema import Settings, number

_STEFAN_BOLTZMANN = 5.670374e-8  # W/(m^2 K^4)
_KELVIN = 273.15
_RINGS = 4
_SECTORS = 10


class PlateSettings(Settings):
    """The plate and the skin's thermal properties.

    Attributes:
        temperature: Of the plate; 180 in T.
    """

    temperature: float = number(180.0, "degC", 20.0, 1000.0)
    room: ClassVar[float] = 25.0  # degC
    radius: ClassVar[float] = 0.09  # m: a cooker's small plate
    emissivity: ClassVar[float] = 0.9  # Of plate and skin: oxidised iron and dark silicone rubber
    # Heat capacity of a taxel's area: 0.5 mm of silicone rubber (1100 kg/m^3, 1460 J/(kg K)) and substrate
    capacity: ClassVar[float] = 1200.0
    loss: ClassVar[float] = 12.0  # Heat transfer to the air: natural convection and radiation to the room, in W/(m^2 K)
    plume: ClassVar[float] = 0.05  # Height above the plate at which the air's excess temperature has fallen to 37 %


class HotPlate:
    """A level round plate, upper face about `middle` (3,) in m. `temperature` of the taxels (count,) in degC."""

    def __init__(self, middle: NDArray[np.float64], settings: PlateSettings, count: int) -> None:
        self.settings = settings
        self.middle = np.asarray(middle, dtype=float)
        self.temperature = np.full(count, settings.room)
        radii = (np.arange(_RINGS) + 0.5) / _RINGS * settings.radius
        angles = (np.arange(_SECTORS) + 0.5) / _SECTORS * 2.0 * math.pi
        r, a = (grid.ravel() for grid in np.meshgrid(radii, angles))
        self._spots = self.middle + np.column_stack([r * np.cos(a), r * np.sin(a), np.zeros(len(r))])
        self._areas = r * (settings.radius / _RINGS) * (2.0 * math.pi / _SECTORS)

    def view_factors(self, points: NDArray[np.float64], outward: NDArray[np.float64]) -> NDArray[np.float64]:
        """Returns the plate's view share (n,) for taxels at `points` (n, 3) in m with normals `outward` (n, 3)."""
        to = self._spots - points[:, None]
        square = np.maximum(np.einsum("nsi,nsi->ns", to, to), 1e-8)
        at_taxel = np.maximum(np.einsum("nsi,ni->ns", to, outward), 0.0)
        at_plate = np.maximum(-to[:, :, 2], 0.0)
        return np.asarray(np.minimum((at_taxel * at_plate / (math.pi * square**2)) @ self._areas, 1.0))

    def step(self, points: NDArray[np.float64], outward: NDArray[np.float64], period: float) -> NDArray[np.float64]:
        """Warm taxels at `points` (n, 3) in m with normals `outward` (n, 3) for `period` in s, short against C / h.
        Returns degC (n,).
        """
        s = self.settings
        hot = s.temperature + _KELVIN
        own = self.temperature + _KELVIN
        radiated = s.emissivity**2 * _STEFAN_BOLTZMANN * self.view_factors(points, outward) * (hot**4 - own**4)
        above = points - self.middle
        over = np.hypot(above[:, 0], above[:, 1]) < s.radius
        excess = np.where(over, np.exp(-np.maximum(above[:, 2], 0.0) / s.plume), 0.0)
        air = s.room + (s.temperature - s.room) * excess
        self.temperature = self.temperature + period / s.capacity * (radiated - s.loss * (self.temperature - air))
        return self.temperature
