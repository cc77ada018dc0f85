"""Lazy percept of a sole."""

from __future__ import annotations

from functools import partial
from importlib import import_module
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.arguments import instance, number
from plantar.common.lazy import lazy
from plantar.common.record import constructed_by_kernel
from plantar.errors import ReadingError
from plantar.kernels.skin.percept_fields import PerceptFields
from plantar.layouts.layout import SoleLayout
from plantar.layouts.taxel_values import taxel_mask
from plantar.mechanics.zmp import zero_moment_wrench
from plantar.percepts.percept_options import PerceptOptions
from plantar.percepts.percept_shapes import ShapeMembers
from plantar.percepts.percept_virtual import VirtualMembers
from plantar.sensing.activation import active_of, active_taxels
from plantar.sensing.force import scaled_by_area
from plantar.sensing.health import TaxelHealth, fill_from_neighbours
from plantar.sensing.reading import Reading


@constructed_by_kernel
class Percept(ShapeMembers, VirtualMembers, PerceptFields):
    """Percept of a reading through its layout.

    Members are computed at first use, and read-only. An unloaded sole has no CoP (None), area 0, an empty polygon and a
    zero wrench; an absent modality None. Faulty taxels are left out of every sum; `health` lists them.

    Args:
        layout: Sole, n taxels.
        reading: Reading of its taxels.
        force_threshold: Activation threshold epsilon_f in N; layout's if None.
        active: Mask (n,) of active taxels, of a `TaxelActivation`; those above threshold if None.
        stuck: Mask (n,) of stuck taxels, of a `StuckMonitor`; none if None.
        options: Other options; defaults if None.

    Raises:
        ReadingError, InputError: Reading or mask does not fit.

    Example:
        >>> from plantar import Percept, Reading, hex_layout
        >>> layout = hex_layout([[0, 0], [0.2, 0], [0.2, 0.1], [0, 0.1]])
        >>> empty = Percept(layout, Reading(time=0.0, force=np.zeros(len(layout))))
        >>> empty.position_cop_in_sole is None, empty.contact_area, empty.support_polygon_in_sole.shape
        (True, 0.0, (0, 2))
    """

    PLAIN = (SoleLayout, Reading, PerceptOptions())
    """What needs no check: the classes of layout and reading, and the options where none are told."""

    if TYPE_CHECKING:  # what the kernel keeps and finds
        force_threshold: float
        _given_active: NDArray[np.bool_] | None
        _stuck: NDArray[np.bool_] | None

        def _keep(self, *fields: Any) -> None: ...
        def _fill_summed(self, *fields: Any) -> None: ...
        def _active_above(self) -> NDArray[np.bool_] | None: ...
        def _loads(self) -> NDArray[np.float64]: ...
        def _wrench(self) -> NDArray[np.float64]: ...
        def _cop(self) -> NDArray[np.float64] | None: ...
        def _centroid(self) -> NDArray[np.float64] | None: ...
        def _hull(self) -> tuple[NDArray[np.float64], float, float, float]: ...

    def __init__(
        self,
        layout: SoleLayout,
        reading: Reading,
        force_threshold: float | None = None,
        *,
        active: ArrayLike | None = None,
        stuck: ArrayLike | None = None,
        options: PerceptOptions | None = None,
    ) -> None: ...

    def _checked(
        self,
        layout: SoleLayout,
        reading: Reading,
        force_threshold: float | None,
        active: ArrayLike | None,
        stuck: ArrayLike | None,
        options: PerceptOptions | None,
    ) -> tuple[Any, ...]:
        instance(layout, SoleLayout, "layout")
        instance(reading, Reading, "reading")
        if reading.force.shape[0] != len(layout.corners):
            raise ReadingError(f"reading has {reading.force.shape[0]} taxels; layout '{layout.name}' has {len(layout)}")
        return (
            layout.force_threshold if force_threshold is None else number(force_threshold, "force threshold"),
            None if active is None else taxel_mask(layout, active, "mask 'active'").copy(),
            None if stuck is None else taxel_mask(layout, stuck, "mask 'stuck'").copy(),
            self.PLAIN[2] if options is None else instance(options, PerceptOptions, "options"),
        )

    def __repr__(self) -> str:
        return f"Percept({_shown('percept_text', self)})"

    def _repr_html_(self) -> str:
        return _shown("percept_html", self)

    def __reduce__(self) -> tuple[Any, ...]:
        # Copies and pickles compute their members again: numpy forgets what is read-only.
        masks: dict[str, Any] = {"active": self._given_active, "stuck": self._stuck, "options": self.options}
        return partial(type(self), **masks), (self.layout, self.reading, self.force_threshold)

    @classmethod
    def members(cls) -> tuple[str, ...]:
        """Names of all lazy members; computed ones are in `__dict__`."""
        own = (vars(base).items() for base in cls.__mro__)
        return tuple(name for items in own for name, value in items if isinstance(value, lazy))

    @lazy
    def health(self) -> TaxelHealth:
        """Dead, saturated and stuck taxels."""
        force = self.reading.force
        stuck = np.zeros(force.shape, dtype=bool) if self._stuck is None else self._stuck
        dead, saturated = self.layout.kernel.faults(force, self.layout.force_limit)
        return TaxelHealth(dead, saturated, stuck)

    @lazy
    def sound_force(self) -> NDArray[np.float64]:
        """Normal forces (n,) in N; NaN if faulty, or with `fill` by its neighbours' pressure."""
        faulty = self.health.faulty
        if self.options.fill:
            return fill_from_neighbours(self.layout, self.reading.force, faulty, per_area=True)
        return np.where(faulty, np.nan, self.reading.force)

    @lazy
    def active(self) -> NDArray[np.bool_]:
        """Active taxels (n,) (T 4.22); faulty ones only if filled, none of a sole that measures no more than noise."""
        mask = self._active_above()
        if mask is not None:
            return mask
        leaves_out = self._stuck is None and not self.options.fill  # what is faulty, without a look at each fault
        force = self.reading.force if leaves_out else self.sound_force
        if self._given_active is None:
            return active_of(self.layout, force, self.force_threshold)
        return np.asarray(self._given_active & active_taxels(force, 0.0, self.layout.force_limit))

    @lazy
    def active_force(self) -> NDArray[np.float64]:
        """Normal forces (n,) of active taxels in N, 0 elsewhere."""
        return np.where(self.active, self.sound_force if self.options.fill else self.reading.force, 0.0)

    @lazy
    def vertical_force(self) -> float:
        """Vertical force on the sole in N."""
        return self._loads().item(2)

    @lazy
    def contact_area(self) -> float:
        """Area in m^2 of the active cells (T 4.22)."""
        return self._loads().item(6)

    @lazy
    def position_cop_in_sole(self) -> NDArray[np.float64] | None:
        """Center of pressure (2,) in sole frame in m, or None without load (T 4.21)."""
        return self._cop()

    @lazy
    def cop_deviation_in_sole(self) -> NDArray[np.float64] | None:
        """Standard deviation (2,) in m of the CoP by the errors of the calibration's gains, or None without load or
        calibration."""
        known = self.layout.calibration
        return None if known is None else known.cop_deviation(self.layout, self.active_force)

    @lazy
    def surface_cop_in_sole(self) -> NDArray[np.float64] | None:
        """Center of pressure (3,) on the surface in sole frame in m, or None without load; exact to second order."""
        cop = self.position_cop_in_sole
        if cop is None:
            return None
        if self.layout.is_level:
            return np.array([*cop.tolist(), 0.0])
        places = self.layout.positions
        axes = self.layout.rotations[:, :, 2]
        share = self.active_force * axes[:, 2]
        rise = ((places[:, :2] - cop) * axes[:, :2]).sum(axis=1) / axes[:, 2]
        return np.array([*cop.tolist(), share @ (places[:, 2] + 0.5 * rise) / share.sum()])

    @lazy
    def wrench_in_sole(self) -> NDArray[np.float64]:
        """Ground reaction wrench (6,) about sole origin in N and N m (T 4.23)."""
        return self._wrench()

    @lazy
    def zero_moment_wrench_in_sole(self) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
        """ZMP (3,) in the sole plane in m and the wrench (6,) about it, or None without load (T 4.2.4)."""
        return zero_moment_wrench(self.wrench_in_sole, minimum_force=0.0)

    @lazy
    def pressure_driven_wrench_in_sole(self) -> NDArray[np.float64]:
        """Wrench (6,) amplified on a small contact area, in N and N m (T 3.26-3.27)."""
        xi = self.options.reference_area
        return scaled_by_area(self.wrench_in_sole, self.contact_area, self.layout.cell_area if xi is None else xi)

    @lazy
    def support_polygon_in_sole(self) -> NDArray[np.float64]:
        """Convex support polygon (k, 2) in sole frame in m, counter-clockwise (T 4.24)."""
        return self._hull()[0]

    @lazy
    def support_area(self) -> float:
        """Area A_p of support polygon in m^2."""
        return float(self._hull()[1])

    @lazy
    def area_ratio(self) -> float:
        """A_p / A_s: area of support polygon over sole outline (T 4.3.2 rule b)."""
        return self.support_area / self.layout.sole_area

    @lazy
    def centroid_in_sole(self) -> NDArray[np.float64] | None:
        """Centroid (2,) of support polygon in sole frame in m, or None without contact (T 4.4.2)."""
        return self._centroid()


def _shown(form: str, percept: Percept) -> str:
    """A percept in a form of `plantar.percepts.percept_figure`, loaded when one is shown."""
    return str(getattr(import_module("plantar.percepts.percept_figure"), form)(percept))
