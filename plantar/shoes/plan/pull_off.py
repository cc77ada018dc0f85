"""How firmly clips, straps or screws hold a shoe, against its weight in swing and a scuff at the toe. Lengths in mm.

- A clip's arm is a cantilever bent by the hook's reach d; its retaining face has 45 degrees: F = E b t^3 d / (4 L^3),
  pull-off P = F (mu + tan 45) / (1 - mu tan 45)          (Bayer, Snap-fit joints for plastics) It snaps on with the
  same force: 200 N at most by hand (EN 1005-3)
- A strap slips where its hooks and loops shear over their overlap, and pulls on both lugs at 45 degrees: P = 2 sin 45 x
  shear strength (7 N/cm^2, data sheets) x width x overlap
- A set screw presses with 100 N, tightened by two fingers: P = mu 100 N

Needed are 5 g on the worn mass in swing, and at the toe, dragged by a tenth of the robot's weight, a moment of mu 0.1 m
g (thickness + rim / 3) about the heel's edge.
"""

import math
from dataclasses import dataclass

from plantar.mechanics.lip import GRAVITY
from plantar.shoes.parameters import ShoeParameters

_MU = 0.3  # plastic on plastic or metal
_SWING = 5.0  # g
_SCUFF = 0.1  # of the robot's weight on the toe
# MPa and mm of hooks and loops
_SHEAR = 0.07
_OVERLAP = 50.0
_SCREW = 100.0  # N

SNAP_MOST = 200.0  # force in N that a person pushes with his body at most, at work (EN 1005-3)


@dataclass(frozen=True)
class PullOff:
    """Holding and needed forces.

    `force`: force in N to pull off downwards; `swing`: needed in N: 5 g on the worn mass; `moment`: held in N m about
    the heel's edge; `scuff`: needed in N m; `snap`: force in N to snap on the stiffest clip; 0 without clips.
    """

    force: float
    swing: float
    moment: float
    scuff: float
    snap: float = 0.0


def clip_force(length: float, parameters: ShoeParameters) -> float:
    """Gives pull-off force in N of a clip with an arm of a free length in mm, by parameters.

    Example:
        >>> round(clip_force(28.0, ShoeParameters()), 1)
        11.8
    """
    p = parameters
    bend = p.printed.modulus * p.clip_width * p.clip_thickness**3 * p.clip_hook / (4.0 * length**3)
    return bend * (_MU + 1.0) / (1.0 - _MU)


def pull_off(
    kind: str, places: tuple[tuple[float, float], ...], width: float, heel: float, worn: float, mass: float,
    parameters: ShoeParameters,
) -> PullOff:  # fmt: skip
    """Holding forces of a shoe.

    `kind`: "clips", "straps" or "screws"; `places`: each holder's x in mm, and a clip's arm length in mm; `width`:
    strap's in mm; `heel`: foot's rear edge x in mm; `worn`: mass in kg; `mass`: robot's in kg.
    """
    p = parameters
    strap = 2.0 * math.sqrt(0.5) * _SHEAR * width * _OVERLAP / 2.0  # at each of its two lugs
    each = [clip_force(arm, p) if kind == "clips" else strap if kind == "straps" else _MU * _SCREW for _, arm in places]
    moment = sum(f * (x - heel) for f, (x, _) in zip(each, places, strict=True))
    scuff = _MU * _SCUFF * mass * GRAVITY * (p.thickness + p.rim_height / 3.0)
    snap = max(each) if kind == "clips" else 0.0
    rounded = (round(v, 3) for v in (sum(each), _SWING * GRAVITY * worn, 1e-3 * moment, 1e-3 * scuff, snap))
    return PullOff(*rounded)
