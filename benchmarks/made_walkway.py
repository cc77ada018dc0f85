"""Made walks over a walkway of 720 x 240 cells, in the forms in which StepUP-P150 publishes its own.

The forms are those of its public code: trial.npz (frames, 720, 240) in kPa, pipeline_1.npz (footsteps, 101, 75, 40)
and metadata.csv. A foot is a heel, a lateral midfoot, five metatarsal heads and toes, each loaded in its part of the
stance.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

ROWS, COLUMNS = 720, 240
PITCH = 0.005
RATE = 100.0
_HEEL = 0.2  # share of the length in which the heel lies
_COLUMNS = (
    "ParticipantID,Footwear,Speed,FootstepID,PassID,StartFrame,EndFrame,Ymin,Ymax,Xmin,Xmax,Orientation,Side,Standing,"
    "Incomplete,Rscore,Outlier,Exclude,RotationAngle,FootLength,FootWidth,MeanPressure"
)
# Parts of a right foot: place along it and to the medial side, radii, in shares of its length; kPa; begin, peak and end
# in shares of the stance.
_PARTS = np.array(
    [
        (0.11, 0.00, 0.105, 0.095, 230, 0.00, 0.18, 0.62),
        (0.38, -0.09, 0.170, 0.055, 90, 0.10, 0.40, 0.78),
        (0.71, 0.115, 0.055, 0.055, 180, 0.25, 0.76, 0.97),
        (0.73, 0.050, 0.050, 0.048, 215, 0.22, 0.76, 0.97),
        (0.72, -0.010, 0.050, 0.045, 200, 0.20, 0.74, 0.96),
        (0.69, -0.065, 0.050, 0.045, 150, 0.18, 0.70, 0.93),
        (0.65, -0.115, 0.050, 0.045, 110, 0.16, 0.66, 0.90),
        (0.925, 0.095, 0.060, 0.045, 220, 0.45, 0.88, 1.00),
        (0.900, 0.025, 0.030, 0.024, 90, 0.50, 0.87, 0.99),
        (0.875, -0.025, 0.027, 0.022, 70, 0.50, 0.86, 0.98),
        (0.840, -0.070, 0.026, 0.022, 55, 0.50, 0.85, 0.97),
        (0.800, -0.110, 0.026, 0.022, 45, 0.48, 0.84, 0.96),
    ]
)


@dataclass(frozen=True)
class Walker:
    """A person: foot length and step in m, toe out in rad, step width in m, stance in s, step time in s, load.

    `sole`: how much larger the loaded parts are than those of a bare foot; 1.5 is a flat shoe. `left_heel`: how many
    times its usual pressure the left heel has.
    """

    length: float
    step: float
    out: float
    width: float
    stance: float
    period: float
    load: float
    sole: float = 1.0
    left_heel: float = 1.0


@dataclass(frozen=True, eq=False)
class MadeStep:
    """A footstep: its frames (m, h, w) in kPa as bytes, first frame, first row and column, pass, foot, direction."""

    frames: NDArray[np.uint8]
    begin: int
    row: int
    column: int
    walk: int
    side: str
    orientation: int


def walker(random: np.random.Generator) -> Walker:
    """A person drawn from usual adults."""
    period = random.uniform(0.48, 0.66)
    return Walker(
        length=random.uniform(0.22, 0.29),
        step=random.uniform(0.58, 0.80),
        out=random.normal(0.12, 0.06),
        width=random.uniform(0.07, 0.14),
        stance=random.uniform(1.18, 1.30) * period,
        period=period,
        load=random.uniform(0.7, 1.1),
        sole=random.uniform(1.0, 1.5),
    )


def made_walk(who: Walker, frames: int, random: np.random.Generator) -> list[MadeStep]:
    """Footsteps of a person who walks to and fro over the walkway in a number of frames, in the order they begin."""
    out: list[MadeStep] = []
    time = 0.3
    walk = 0
    while True:
        orientation = 1 - walk % 2
        side = "left" if random.random() < 0.5 else "right"
        middle = random.uniform(0.45, 0.75)
        slope = random.normal(0.0, 0.01)
        along = random.uniform(0.02, who.step)
        while along + who.length < ROWS * PITCH - 0.005:
            stance = who.stance * random.normal(1.0, 0.02)
            if round((time + stance) * RATE) + 2 >= frames:
                return out
            out.append(_footstep(who, along, middle + slope * along, time, stance, walk, side, orientation, random))
            side = "right" if side == "left" else "left"
            along += who.step * random.normal(1.0, 0.03)
            time += who.period * random.normal(1.0, 0.02)
        time += random.uniform(2.0, 3.0)
        walk += 1


def _footstep(
    who: Walker,
    along: float,
    middle: float,
    time: float,
    stance: float,
    walk: int,
    side: str,
    orientation: int,
    random: np.random.Generator,
) -> MadeStep:
    """A footstep whose heel is `along` m into the pass, left or right of its middle line."""
    left = 1.0 if side == "left" else -1.0
    turn = -left * who.out + random.normal(0.0, 0.03)  # to the left; feet turn outwards
    across = middle + left * 0.5 * who.width * random.normal(1.0, 0.1)
    if orientation == 1:
        heel = np.array([along, across])
        axis = np.array([np.cos(turn), -np.sin(turn)])
    else:
        heel = np.array([ROWS * PITCH - along, COLUMNS * PITCH - across])
        axis = -np.array([np.cos(turn), -np.sin(turn)])
    medial = np.array([-axis[1], axis[0]]) * (-left)
    ends = np.array([heel, heel + who.length * axis])
    low = np.maximum(np.floor(ends.min(axis=0) / PITCH).astype(int) - 14, 0)
    high = np.minimum(np.ceil(ends.max(axis=0) / PITCH).astype(int) + 14, (ROWS, COLUMNS))
    places = (np.stack(np.mgrid[low[0] : high[0], low[1] : high[1]], axis=-1) + 0.5) * PITCH - heel
    u = places @ axis / who.length
    v = places @ medial / who.length
    begin = int(np.ceil(time * RATE))
    share = (np.arange(begin, int((time + stance) * RATE) + 1) / RATE - time) / stance
    whole = np.zeros((len(share), *u.shape))
    for x, y, rx, ry, kpa, first, peak, last in _PARTS:
        away = (((u - x) / rx) ** 2 + ((v - y) / ry) ** 2) / who.sole**2
        shape = np.maximum(0.0, 1.0 - away) ** 0.25  # steep at its edge, as a foot's
        rise = np.interp(
            share, [first, 0.5 * (first + peak), peak, 0.5 * (peak + last), last], [0.0, 0.8, 1.0, 0.7, 0.0]
        )
        kpa *= who.left_heel if side == "left" and x < _HEEL else 1.0
        whole = np.maximum(whole, (kpa * who.load * random.normal(1.0, 0.06) * rise)[:, None, None] * shape)
    whole *= random.normal(1.0, 0.03, whole.shape) if whole.any() else 1.0
    cells = np.clip(np.rint(whole), 0, 255).astype(np.uint8)
    rows, columns = (np.flatnonzero(cells.any(axis=axes)) for axes in ((0, 2), (0, 1)))
    on = np.flatnonzero(cells.any(axis=(1, 2)))
    cells = cells[on[0] : on[-1] + 1, rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
    place = (begin + int(on[0]), int(low[0] + rows[0]), int(low[1] + columns[0]))
    return MadeStep(cells, *place, walk, side, orientation)


def trial_of(steps: Sequence[MadeStep], frames: int) -> NDArray[np.uint8]:
    """The walkway (frames, 720, 240) in kPa."""
    out = np.zeros((frames, ROWS, COLUMNS), dtype=np.uint8)
    for step in steps:
        count, rows, columns = step.frames.shape
        part = out[step.begin : step.begin + count, step.row : step.row + rows, step.column : step.column + columns]
        np.maximum(part, step.frames, out=part)
    return out


def upright(step: MadeStep, height: int = 75, width: int = 40, times: int = 101) -> tuple[NDArray[np.uint8], float]:
    """A footstep as StepUP-P150's pipeline 1 makes it: (times, height, width), and the angle in deg that it is turned.

    Turned by half where it walks to higher rows, then by its main axis to the nearest cells, put in the middle, and
    taken at the nearest of its frames.
    """
    frames = step.frames[:, ::-1, ::-1] if step.orientation == 1 else step.frames
    row, column = np.nonzero(frames.max(axis=0))
    _, axes = np.linalg.eigh(np.cov(row, column))
    along, across = axes[:, 1]
    angle = np.degrees(np.arctan2(across, along))
    angle -= 180.0 * np.sign(angle) if abs(angle) > 90.0 else 0.0
    turn = np.radians(-angle)
    size = 2 * max(frames.shape[1:])
    y, x = np.mgrid[:size, :size] - size // 2
    c = np.cos(turn)
    s = np.sin(turn)
    back = (np.rint(c * x - s * y).astype(int), np.rint(s * x + c * y).astype(int))  # columns and rows before turning
    at_row = back[1] + frames.shape[1] // 2
    at_column = back[0] + frames.shape[2] // 2
    inside = (at_row >= 0) & (at_row < frames.shape[1]) & (at_column >= 0) & (at_column < frames.shape[2])
    turned = np.where(inside, frames[:, at_row * inside, at_column * inside], 0)
    on_row, on_column = (np.flatnonzero(turned.any(axis=axes)) for axes in ((0, 2), (0, 1)))
    turned = turned[:, on_row[0] : on_row[-1] + 1, on_column[0] : on_column[-1] + 1][:, :height, :width]
    out = np.zeros((times, height, width), dtype=np.uint8)
    first = (height - turned.shape[1]) // 2, (width - turned.shape[2]) // 2
    nearest = np.rint(np.arange(times) * (len(turned) - 1) / (times - 1)).astype(int)
    out[:, first[0] : first[0] + turned.shape[1], first[1] : first[1] + turned.shape[2]] = turned[nearest]
    return out, -float(angle)


def metadata_of(steps: Sequence[MadeStep], turns: Sequence[float], who: int, footwear: str, speed: str) -> str:
    """Text of metadata.csv."""
    lines = [_COLUMNS]
    for number, (step, turn) in enumerate(zip(steps, turns, strict=True)):
        count, rows, columns = step.frames.shape
        place = f"{step.begin},{step.begin + count - 1},{step.row},{step.row + rows - 1}"
        across = f"{step.column},{step.column + columns - 1}"
        mean = step.frames.sum() / count
        lines.append(
            f"{who},{footwear},{speed},{number},{step.walk},{place},{across},{step.orientation},"
            f"{step.side.capitalize()},0,0,0.5,0,0,{turn:.6f},{rows}.0,{columns}.0,{mean:.6f}"
        )
    return "\n".join(lines) + "\n"


def write_stack(folder: Path, steps: Sequence[MadeStep], who: int, footwear: str, speed: str, kind: str = "u1") -> None:
    """Write pipeline_1.npz of a type of numbers, and metadata.csv."""
    folder.mkdir(parents=True, exist_ok=True)
    made = [upright(step) for step in steps]
    np.savez_compressed(folder / "pipeline_1.npz", np.array([stack for stack, _ in made]).astype(kind))
    (folder / "metadata.csv").write_text(metadata_of(steps, [turn for _, turn in made], who, footwear, speed))
