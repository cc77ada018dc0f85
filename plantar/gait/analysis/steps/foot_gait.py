"""Analysis of one foot: its events, its steps and their measures."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from plantar.gait.analysis.prints.footprint import Footprint
from plantar.gait.analysis.steps.events import Contact, Levels
from plantar.recordings.pressure_recording import FootRecording
from plantar.sides import Side

__all__ = ["FootGait", "Step"]


@dataclass(frozen=True, eq=False)
class Step:
    """One complete contact of one foot.

    Attributes:
        side: "left" or "right".
        number: 1 for the first complete contact of its foot.
        heel_strike_s: Time of heel strike.
        toe_off_s: Time of toe off.
        contact: The contact.
        measures: Known measures by their key in `plantar.gait.analysis.measures.MEASURES`.
        regions: Measures of each region of the foot.
        footprint: The footprint of lengths, arch index and regions.
        region: Index (k,) into `REGIONS` of each cell, -1 for none.
        used: Whether it is in the means.
        unused: Why not, or empty.
        odd: Why it is odd, or empty.
        activity: "walking", "running", "hopping" or empty.
    """

    side: Side
    number: int
    heel_strike_s: float
    toe_off_s: float
    contact: Contact
    measures: Mapping[str, float]
    regions: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    footprint: Footprint | None = None
    region: NDArray[np.int64] | None = None
    used: bool = True
    unused: str = ""
    odd: str = ""
    activity: str = ""

    def __getitem__(self, key: str) -> float:
        return self.measures.get(key, float("nan"))


@dataclass(frozen=True, eq=False)
class FootGait:
    """One foot's recording with its events and steps; what needs geometry is None without it.

    Attributes:
        foot: The measurements.
        levels: Force levels of its events, None where the foot carries no load.
        contacts: All contacts, also those cut by the recording.
        steps: The complete ones, measured.
        cop: Centre of pressure (n, 2) of each frame in the sole frame in m, averaged over 50 ms; NaN without load.
        cell_threshold: Force in N (k,) above which a cell counts as loaded.
        picture: Maximum pressure picture (k,) in Pa: mean over the steps, of a platform the largest.
        footprint: Footprint of that picture in an insole or sole.
        region: Index (k,) into `REGIONS` of each cell of the picture, -1 for none.
        sole: The whole insole or sole as a footprint.
        warnings: Warnings about the foot.
    """

    foot: FootRecording
    levels: Levels | None
    contacts: tuple[Contact, ...]
    steps: tuple[Step, ...]
    cop: NDArray[np.float64] | None
    cell_threshold: NDArray[np.float64]
    picture: NDArray[np.float64] | None = None
    footprint: Footprint | None = None
    region: NDArray[np.int64] | None = None
    sole: Footprint | None = None
    warnings: tuple[str, ...] = ()

    @property
    def heel_strikes(self) -> list[float]:
        """Times in s of all recorded heel strikes."""
        return [c.heel_strike for c in self.contacts if c.heel_strike is not None]

    @property
    def toe_offs(self) -> list[float]:
        """Times in s of all recorded toe offs."""
        return [c.toe_off for c in self.contacts if c.toe_off is not None]

    @cached_property
    def used(self) -> tuple[Step, ...]:
        """The steps that are in the means."""
        return tuple(step for step in self.steps if step.used)

    @cached_property
    def columns(self) -> Mapping[str, NDArray[np.float64]]:
        """Each measure over the used steps, NaN where a step has none of it."""
        keys = dict.fromkeys(key for step in self.used for key in step.measures)
        used = [step.measures for step in self.used]
        return {key: np.array([measures.get(key, np.nan) for measures in used]) for key in keys}
