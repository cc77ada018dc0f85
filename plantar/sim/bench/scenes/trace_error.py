"""By how much a run differs from its reference, as long as both are the same walk."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from plantar.sim.bench.scenes.changed_run import SAMPLE, Trace

__all__ = ["PARTED", "TraceError", "trace_error"]

PARTED = 1 / 60
"""Of the leg: distance of two centres of mass from which on runs count as two walks; 10 mm on H1."""

_SAME_LANDING = 0.05  # s between landings of two runs that are the same landing


class TraceError(NamedTuple):
    """Root mean square differences up to the time at which the runs part.

    Attributes:
        com_m: Of the centre of mass in m.
        zmp_m: Of the zero moment point in m.
        force: Of the vertical forces on both soles, over the body's weight.
        impact: Of the landings' impacts until then, over the reference's; NaN for none.
        together_s: Time in s until the runs part, or end.
        whole_s: Time in s of the reference.
    """

    com_m: float
    zmp_m: float
    force: float
    impact: float
    together_s: float
    whole_s: float


def trace_error(trace: Trace, reference: Trace) -> TraceError:
    """Returns how a run's `trace` differs from its `reference` of the same seed, without noise.

    Runs that differ in the last digit may decide differently about a footstep, so differences count until the centers
    of mass are `PARTED` of the leg apart.

    Example:
        >>> import numpy as np
        >>> still = Trace(np.zeros((3, 3)), np.zeros((3, 2)), np.ones((3, 2)), (("left", 0.01, 200.0),), 0.6, 800.0)
        >>> from dataclasses import replace
        >>> drifted = replace(still, com=np.array([[0.0, 0, 0], [0.001, 0, 0], [0.02, 0, 0]]))
        >>> round(trace_error(drifted, still).together_s, 3), round(1e3 * trace_error(drifted, still).com_m, 3)
        (0.02, 0.707)
    """
    k = min(len(trace.com), len(reference.com))
    apart = np.linalg.norm(trace.com[:k] - reference.com[:k], axis=1)
    far = np.flatnonzero(apart > PARTED * reference.leg)
    n = max(1, int(far[0]) if far.size else k)
    zmp = np.linalg.norm(trace.zmp[:n] - reference.zmp[:n], axis=1)
    force = (trace.force[:n] - reference.force[:n]) / reference.weight
    until = n * SAMPLE
    impacts = []
    for (side, time, impact), (other_side, other_time, other) in zip(trace.landings, reference.landings, strict=False):
        if side != other_side or abs(time - other_time) > _SAME_LANDING or other_time > until:
            break
        if other > 0.0:
            impacts.append((impact - other) / other)
    return TraceError(
        com_m=_rms(apart[:n]),
        zmp_m=_rms(zmp[np.isfinite(zmp)]),
        force=_rms(force),
        impact=_rms(np.array(impacts)) if impacts else float("nan"),
        together_s=until,
        whole_s=len(reference.com) * SAMPLE,
    )


def _rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(np.square(values)))) if values.size else 0.0
