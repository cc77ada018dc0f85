"""Analysis of one foot: events, steps and measures."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import Side
from plantar.gait.analysis.masks import SEVEN_MASKS, Masks
from plantar.gait.analysis.prints.footprint import Footprint
from plantar.gait.analysis.steps.events import Contact, Levels
from plantar.recordings.pressure_recording import FootRecording

_ENDS = 0.12  # Part of a contact that is its landing, or its lift-off


@dataclass(frozen=True, eq=False)
class Step:
    """Complete contact of one foot.

    Attributes:
        side: "left" or "right".
        number: 1 for its foot's first complete contact.
        heel_strike_s: In s.
        toe_off_s: In s.
        measures: Known ones by key in `plantar.gait.analysis.measures.MEASURES`.
        footprint: Of lengths, arch index and regions.
        region: Index (k,) into the regions' names of each cell, -1 for none; of overlapping masks the first.
        unused: Why not, or empty.
        odd: Why odd, or empty.
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
    """One foot's recording with events and steps; None for what needs missing geometry.

    Attributes:
        levels: Force levels of events, None without load.
        contacts: All, also those cut by the recording.
        cop: CoP (n, 2) of each frame, sole frame in m, averaged over 50 ms; NaN without load.
        cell_threshold: Cells count as loaded above this force (k,) in N.
        picture: Maximum pressure picture (k,) in Pa: mean over steps, of platforms the largest.
        footprint: Of that picture in an insole or sole.
        region: Index (k,) into the regions' names of each picture cell, -1 for none.
        masks: Regions that are measured.
        sole: Whole insole or sole as footprint.
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
    masks: Masks = SEVEN_MASKS

    @property
    def heel_strikes(self) -> list[float]:
        """Times in s of recorded heel strikes."""
        return [c.heel_strike for c in self.contacts if c.heel_strike is not None]

    @property
    def toe_offs(self) -> list[float]:
        """Times in s of recorded toe offs."""
        return [c.toe_off for c in self.contacts if c.toe_off is not None]

    @cached_property
    def used(self) -> tuple[Step, ...]:
        """Steps in the means."""
        return tuple(step for step in self.steps if step.used)

    @cached_property
    def rolls(self) -> NDArray[np.float64]:
        """CoP at landing, lift-off and hindmost of each used step with five or more positions, in shares of the sole.

        (steps, 3); empty without layout.
        """
        if self.foot.layout is None or self.cop is None:
            return np.zeros((0, 3))
        outline = self.foot.layout.outline[:, 0]
        back = float(outline.min())
        whole = (self.cop[:, 0] - back) / (float(outline.max()) - back)
        rows = []
        for step in self.used:
            along = whole[step.contact.begin : step.contact.end]
            along = along[np.isfinite(along)]
            few = max(1, round(_ENDS * len(along)))
            if len(along) >= 5:
                hindmost = len(along) // 20
                rows.append((along[:few].mean(), along[-few:].mean(), np.partition(along, hindmost)[hindmost]))
        return np.array(rows).reshape(-1, 3)

    @cached_property
    def columns(self) -> Mapping[str, NDArray[np.float64]]:
        """Each measure over the used steps, NaN where missing."""
        keys = dict.fromkeys(key for step in self.used for key in step.measures)
        used = [step.measures for step in self.used]
        return {key: np.array([measures.get(key, np.nan) for measures in used]) for key in keys}
