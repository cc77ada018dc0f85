"""The loop of every run: sensors, control and physics in turn."""

import gc
import math
import os
import time as clock
from abc import ABC, abstractmethod
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from plantar.common.atomic import output_folder, parent_folder
from plantar.sim.figures.render import FRAME_RATE

Progress = Callable[[float, str], None]
"""Takes the fraction done and a text, about ten times a second."""

_LONGEST = 5  # times its first duration, after which a run whose end is put off again and again is cut off


@dataclass(frozen=True)
class Result:
    """What the loop of a run leaves.

    `ticks_us`: wall time of each control tick in us; `wall_time` of the run in s; `overrun`: cut and first planned end
    in s, or None.
    """

    ticks_us: list[float]
    wall_time: float
    overrun: tuple[float, float] | None


@contextmanager
def _without_long_collections() -> Iterator[None]:
    """Garbage is looked for among what comes later only: among all that was set up it takes ten control periods."""
    if gc.get_freeze_count():  # by the caller, whose it stays
        yield
        return
    gc.freeze()
    try:
        yield
    finally:
        gc.unfreeze()


class Run(ABC):
    """A scene that is built and ready to run.

    `seed` of noise and open choices; `periods`: physics step and control period in s; `skipped`: counts of what was not
    computed; `sense_every`: physics steps from one `sense` to the next.
    """

    seed: int
    periods: tuple[float, float]
    skipped: Counter[str]
    sense_every: int = 1

    @property
    @abstractmethod
    def end(self) -> float:
        """Simulated time in s of the end, as planned now."""

    @property
    @abstractmethod
    def ended(self) -> bool:
        """Whether it ended early, for example by a fall."""

    @abstractmethod
    def sense(self, k: int) -> None:
        """Read what is measured at physics step `k`: each multiple of `sense_every`, and some between."""

    @abstractmethod
    def control(self) -> float:
        """One control tick; returns the controller's wall time in us."""

    @abstractmethod
    def advance(self, steps: int = 1) -> int:
        """Physics steps with drives, disturbances, judge: so many, or fewer; returns how many."""

    def after_tick(self) -> None:  # noqa: B027
        """Work after a control tick's physics step."""

    @abstractmethod
    def state_text(self) -> str:
        """Progress text of the run."""

    @abstractmethod
    def open_log(self, path: Path, files: ExitStack) -> None:
        """Begin the recording at `path`, closed with `files`."""

    @abstractmethod
    def open_film(self, path: Path, files: ExitStack) -> Callable[[], None]:
        """Begin a video at `path`, closed with `files`; returns its frame function."""

    @abstractmethod
    def summary(self, result: Result) -> dict[str, Any]:
        """The summary of the loop's `result`, as `plantar sim --json` prints it."""

    @abstractmethod
    def plot(self, folder: Path, recording: Path) -> Sequence[Path]:
        """Draw figures from a `recording` into `folder`; returns their files."""

    def run(
        self,
        *,
        record: str | os.PathLike[str] | None = None,
        video: str | os.PathLike[str] | None = None,
        progress: Progress | None = None,
    ) -> dict[str, Any]:
        """Run to the end or fall; returns the summary, or raises a SceneError for unstable physics.

        Args:
            record: MCAP file; a killed run leaves what was flushed.
            video: MP4 file, in real time.
            progress: Called ten times a second with fraction and text.
        """
        with ExitStack() as files:
            files.enter_context(_without_long_collections())
            if record is not None:
                self.open_log(Path(record), files)
            return self.summary(self._loop(None if video is None else self.open_film(Path(video), files), progress))

    def run_to_files(
        self, record: Path | None, video: Path | None, plot: Path | None, progress: Progress | None
    ) -> dict[str, Any]:
        """Run, record, film and draw; all files appear whole, or none does.

        Args:
            record: Recording, .mcap, or None.
            video: Video, .mp4, or None.
            plot: Folder of the figures, or None.
            progress: Called with fraction and text.

        Returns:
            The summary, with figure paths under "figures".

        Raises:
            SceneError: If it cannot run.
            InputError: If a file cannot be written.
        """
        with ExitStack() as files:
            folder = None if plot is None else files.enter_context(output_folder(plot))
            for file in (record, video):
                if file is not None:
                    files.enter_context(parent_folder(file))
            # Figures are drawn from a recording, whether or not it is kept.
            kept = folder / "run.mcap" if record is None and folder is not None else record
            summary = self.run(record=kept, video=video, progress=progress)
            if plot is not None and folder is not None and kept is not None:
                summary["figures"] = [str(plot / file.name) for file in self.plot(folder, kept)]
                if record is None:
                    kept.unlink()
        return summary

    def _loop(self, add_frame: Callable[[], None] | None, progress: Progress | None) -> Result:
        step, tick = self.periods
        tick_every = max(1, round(tick / step))
        frame_every = max(1, round(1.0 / (FRAME_RATE * step)))
        stops = [tick_every, self.sense_every] if add_frame is None else [tick_every, self.sense_every, frame_every]
        turn = math.lcm(*stops)
        ahead = [min(every - k % every for every in stops) for k in range(turn)]  # steps to the next stop
        ticks: list[float] = []
        began = clock.perf_counter()
        shown = began
        k = 0
        last = math.ceil(self.end / step)
        longest = _LONGEST * last
        while k < last and k < longest and not self.ended:
            self.sense(k)
            is_tick = k % tick_every == 0
            if is_tick:
                ticks.append(self.control())
                last = math.ceil(self.end / step)  # a change of the plan may make it later
                if progress is not None and (now := clock.perf_counter()) - shown > 0.1:
                    shown = now
                    progress(k * step / self.end, self.state_text())
            if add_frame is not None and k % frame_every == 0:
                add_frame()
            if is_tick:
                self.advance(1)
                self.after_tick()
                k += 1
            else:
                k += self.advance(min(ahead[k % turn], last - k, longest - k))
        if add_frame is None:
            self.skipped["rendered_frames"] += math.ceil(k / frame_every)
        overrun = (k * step, longest * step / _LONGEST) if k >= longest else None
        return Result(ticks, clock.perf_counter() - began, overrun)

    def common(
        self, result: Result, names: tuple[str, str], reasons: list[dict[str, Any]], fell: bool, time: float
    ) -> dict[str, Any]:
        """Returns the summary part of all runs.

        By the loop's `result`, `names` of scene and robot, failed `reasons`, whether it `fell`, and simulated `time` in
        s.
        """
        ticks = np.array(result.ticks_us or [0.0])
        return {
            "scene": names[0],
            "robot": names[1],
            "seed": self.seed,
            "completed": not reasons and not fell,
            "reasons": reasons,
            "fell": fell,
            "sim_time_s": round(time, 4),
            "wall_time_s": round(result.wall_time, 4),
            "real_time_factor": round(time / max(result.wall_time, 1e-9), 2),
            "control_us": {f"p{share}": round(float(np.percentile(ticks, share)), 1) for share in (50, 99)},
            "skipped": dict(self.skipped),
        }
