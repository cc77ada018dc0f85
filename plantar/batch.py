"""Percept's members over whole recordings: forces (..., taxels), without a Python loop over frames.

Memory-mapped arrays may exceed memory: contiguous float64 is read in place, other rows block by block. `threads` share
the frames without the interpreter lock; results are the same to the last bit.
"""

import math
import os
from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.arguments import instance, integer, number
from plantar.common.arrays import held_numbers
from plantar.common.lazy import lazy
from plantar.errors import ReadingError
from plantar.kernels.skin import frames as _kernel
from plantar.layouts.layout import SoleLayout
from plantar.sensing.ground_plane import checked_range, ground_fit

BLOCK = 4096
"""Frames that are looked at together where a conversion or an iterator cuts a recording into pieces."""

_Done = TypeVar("_Done")

_LEAST = 512  # Frames that are worth a hand-over to another thread


@dataclass(frozen=True, eq=False)
class Loads:
    """Sums of each frame's forces; "..." are dimensions before taxels.

    Attributes:
        wrench: Ground reaction wrench (..., 6) about sole origin in N and N m (T 4.23).
        contact_area: Area (...) of active cells in m^2 (T 4.22).
        center_of_pressure: Position (..., 2) in sole frame in m (T 4.21); NaN without load.

    Example:
        >>> Loads(np.array([[0.0, 0.0, 5.0, 0.0, 0.0, 0.0]]), np.zeros(1), np.zeros((1, 2))).vertical_force.tolist()
        [5.0]
    """

    wrench: NDArray[np.float64]
    contact_area: NDArray[np.float64]
    center_of_pressure: NDArray[np.float64]

    @property
    def vertical_force(self) -> NDArray[np.float64]:
        """Vertical force (...) in N."""
        return self.wrench[..., 2]


@dataclass(frozen=True, eq=False)
class SupportPolygons:
    """Convex support polygon of each frame (T 4.24).

    Attributes:
        area: Area (...) in m^2, 0 without contact.
        centroid: Centroid (..., 2) in m; NaN without contact.
        size: Number of vertices (...).
        vertices: Vertices (sum of sizes, 2) of all polygons in m, in order of frames; None if not kept.

    Example:
        >>> corners = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
        >>> found = SupportPolygons(np.array([0.0, 0.5]), np.zeros((2, 2)), np.array([0, 3]), corners)
        >>> found.polygon(0).shape, found.polygon(1).tolist()
        ((0, 2), [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    """

    area: NDArray[np.float64]
    centroid: NDArray[np.float64]
    size: NDArray[np.int64]
    vertices: NDArray[np.float64] | None = None

    def polygon(self, *frame: int) -> NDArray[np.float64]:
        """Support polygon of one frame.

        Args:
            frame: Index of frame along each dimension; below 0 from the last.

        Returns:
            Vertices (k, 2) in m, counter-clockwise; empty without contact.

        Raises:
            ReadingError: No vertices.
            IndexError: Not one index a dimension.
        """
        if self.vertices is None:
            raise ReadingError("support polygons hold no vertices; ask for them with vertices=True")
        if len(frame) != self.size.ndim:
            raise IndexError(f"{len(frame)} indices of a frame; expected {self.size.ndim}, one a dimension")
        end = int(self._ends[frame])
        return self.vertices[end - int(self.size[frame]) : end]

    @lazy
    def _ends(self) -> NDArray[np.int64]:
        return np.cumsum(self.size).reshape(self.size.shape)


@dataclass(frozen=True, eq=False)
class GroundPlanes:
    """Ground plane of each frame: z = -height + slope . (x, y) in sole frame.

    Attributes:
        height: Height (...) in m of sole origin above ground; NaN where no taxel sees it.
        slope: Rise (..., 2) of ground along sole's x and y, as a ratio; NaN likewise.
        residual: RMS distance (...) in m of points used; NaN likewise.
        directions: Directions (...) in which points determine a slope: 2, 1, 0, and -1 without a plane.
        inliers: Taxels (..., n) whose points were used.

    Example:
        >>> from plantar import grid_layout
        >>> layout = grid_layout([[0, 0], [0.2, 0], [0.2, 0.1], [0, 0.1]], pitch=(0.05, 0.05))
        >>> planes = ground_planes(layout, np.full((3, len(layout)), 0.03))
        >>> planes.slope.shape, planes.inliers.all().item()
        ((3, 2), True)
    """

    height: NDArray[np.float64]
    slope: NDArray[np.float64]
    residual: NDArray[np.float64]
    directions: NDArray[np.int64]
    inliers: NDArray[np.bool_]


def wrenches(
    layout: SoleLayout,
    force: ArrayLike,
    threshold: float | None = None,
    out: NDArray[np.float64] | None = None,
    *,
    threads: int | None = 1,
) -> NDArray[np.float64]:
    """Ground reaction wrench of every frame (T 4.23), at memory speed.

    Args:
        layout: Sole, n taxels.
        force: Normal forces (..., n) in N.
        threshold: Activation threshold in N; layout's if None, -inf to count every finite force.
        out: Array (..., 6) to write to, float64 and contiguous; a new one if None.
        threads: Threads; one per core if None.

    Returns:
        Wrench (..., 6) about sole origin in N and N m.

    Raises:
        ReadingError, InputError: Forces not (..., taxels).

    Example:
        >>> from plantar import hex_layout
        >>> layout = hex_layout([[-0.1, -0.07], [0.1, -0.07], [0.1, 0.07], [-0.1, 0.07]], clip=False)
        >>> wrenches(layout, np.full((1000, len(layout)), 10.0)).shape
        (1000, 6)
    """
    array, lead = _frames(layout, force)
    if out is None:
        out = np.empty((*lead, 6))
    elif out.shape != (*lead, 6) or out.dtype != np.float64 or not out.flags.carray:
        raise ReadingError(
            f"out has shape {out.shape}, type {out.dtype}; expected {(*lead, 6)} contiguous, writeable float64"
        )
    rows_out = out.reshape(-1, 6)
    low, high = _limits(layout, threshold)

    def work(rows: slice) -> None:
        _kernel.wrenches(layout.kernel, _doubles(array[rows]), low, high, rows_out[rows])

    _shared(work, _pieces(array, threads), threads)
    return out


def loads(layout: SoleLayout, force: ArrayLike, threshold: float | None = None, *, threads: int | None = 1) -> Loads:
    """Wrench, contact area and CoP of every frame (T 4.21-4.23).

    Args:
        layout: Sole, n taxels.
        force: Normal forces (..., n) in N.
        threshold: Activation threshold in N; layout's if None.
        threads: Threads; one per core if None.

    Returns:
        Sums of each frame.

    Raises:
        ReadingError, InputError: Forces not (..., taxels).

    Example:
        >>> from plantar import hex_layout
        >>> layout = hex_layout([[-0.1, -0.07], [0.1, -0.07], [0.1, 0.07], [-0.1, 0.07]], clip=False)
        >>> loads(layout, np.full((2, len(layout)), 10.0)).vertical_force.tolist()
        [330.0, 330.0]
    """
    array, lead = _frames(layout, force)
    out = np.empty((len(array), 9))
    low, high = _limits(layout, threshold)

    def work(rows: slice) -> None:
        _kernel.loads(layout.kernel, _doubles(array[rows]), low, high, out[rows])

    _shared(work, _pieces(array, threads), threads)
    out = out.reshape(*lead, 9)
    return Loads(out[..., :6], out[..., 6], out[..., 7:])


def support_polygons(
    layout: SoleLayout,
    force: ArrayLike,
    threshold: float | None = None,
    *,
    vertices: bool = False,
    threads: int | None = 1,
) -> SupportPolygons:
    """Convex support polygon of every frame, with area and centroid (T 4.24).

    Args:
        layout: Sole, n taxels.
        force: Normal forces (..., n) in N.
        threshold: Activation threshold in N; layout's if None.
        vertices: Keep polygons, not only their measures.
        threads: Threads; one per core if None.

    Returns:
        Measures of each polygon, and polygons if kept.

    Raises:
        ReadingError, InputError: Forces not (..., taxels).

    Example:
        >>> from plantar import hex_layout
        >>> layout = hex_layout([[-0.1, -0.07], [0.1, -0.07], [0.1, 0.07], [-0.1, 0.07]], clip=False)
        >>> support_polygons(layout, np.zeros((3, len(layout)))).area.tolist()
        [0.0, 0.0, 0.0]
    """
    array, lead = _frames(layout, force)
    measure = np.empty((len(array), 3))
    size = np.empty(len(array), dtype=np.intp)
    low, high = _limits(layout, threshold)

    def work(rows: slice) -> list[NDArray[np.float64]]:
        part = _doubles(array[rows])
        sizes = size[rows]
        measured = measure[rows]
        found = []
        done = 0
        while done < len(part):
            points = np.empty((max(len(layout.vertices), 32 * (len(part) - done)) if vertices else 0, 2))
            count = _kernel.hulls(layout.kernel, part[done:], low, high, sizes[done:], measured[done:], points)
            if vertices:
                found.append(points[: int(sizes[done : done + count].sum())].copy())
            done += count
        return found

    found = _shared(work, _pieces(array, threads, BLOCK if vertices else None), threads)
    measure = measure.reshape(*lead, 3)
    kept = _joined([part for parts in found for part in parts], threads) if vertices else None
    return SupportPolygons(measure[..., 0], measure[..., 1:], size.reshape(lead), kept)


def ground_planes(
    layout: SoleLayout,
    distance: ArrayLike,
    *,
    sensing_range: float | None = None,
    tolerance: float = 2e-3,
    threads: int | None = 1,
) -> GroundPlanes:
    """Ground plane under the sole in every frame, as `plantar.fit_ground_plane`.

    Args:
        layout: Sole, n taxels.
        distance: Distances (..., n) in m; inf out of range, NaN if dead.
        sensing_range: Distance in m, of either sign, out of range from there; layout's if None.
        tolerance: Distance in m from plane that noise explains.
        threads: Threads; one per core if None.

    Returns:
        Planes.

    Raises:
        ReadingError, InputError: Distances not (..., taxels).

    Example:
        >>> from plantar import hex_layout
        >>> layout = hex_layout([[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]])
        >>> planes = ground_planes(layout, np.array([[0.03], [np.inf]]) - 0.1 * layout.positions[:, 0])
        >>> planes.height.round(9).tolist(), planes.directions.tolist()
        ([0.03, nan], [2, -1])
    """
    array, lead = _frames(layout, distance, "distances")
    reach = checked_range(layout, sensing_range, tolerance)
    out = np.empty((len(array), 4))
    directions = np.empty(len(array), dtype=np.intp)
    inliers = np.zeros(array.shape, dtype=bool)
    used = inliers.view(np.uint8)
    fit = ground_fit(layout)

    def work(rows: slice) -> None:
        fit.frames(_doubles(array[rows]), reach, tolerance, out[rows], directions[rows], used[rows])

    _shared(work, _pieces(array, threads), threads)
    out = out.reshape(*lead, 4)
    inliers = inliers.reshape(*lead, len(layout))
    return GroundPlanes(out[..., 0], out[..., 1:3], out[..., 3], directions.reshape(lead), inliers)


def blocks(force: NDArray[np.float64], frames: int = BLOCK) -> Iterator[tuple[slice, NDArray[np.float64]]]:
    """Cut a recording into blocks of frames.

    Args:
        force: Forces (frames, n), e.g. memory-mapped.
        frames: Frames in a block.

    Yields:
        Slice of frames, and a view of them, read when used.

    Raises:
        InputError: `frames` below 1.

    Example:
        >>> [(rows.start, rows.stop, part.shape) for rows, part in blocks(np.zeros((5, 3)), frames=2)]
        [(0, 2, (2, 3)), (2, 4, (2, 3)), (4, 5, (1, 3))]
    """
    frames = integer(frames, "frames of a block", 1)
    for start in range(0, len(force), frames):
        rows = slice(start, min(start + frames, len(force)))
        yield rows, force[rows]


def _joined(parts: list[NDArray[np.float64]], threads: int | None) -> NDArray[np.float64]:
    ends = np.cumsum([0, *map(len, parts)]).tolist()
    out = np.empty((ends[-1], 2))

    def work(which: slice) -> None:
        for i in range(which.start, which.stop):
            out[ends[i] : ends[i + 1]] = parts[i]

    _shared(work, [slice(i, i + 1) for i in range(len(parts))], threads)
    return out


def _frames(layout: SoleLayout, force: ArrayLike, name: str = "forces") -> tuple[NDArray[np.float64], tuple[int, ...]]:
    """Forces (frames, n) of the layout, and the frames' dimensions."""
    instance(layout, SoleLayout, "layout")
    array = held_numbers(force, name, ReadingError)
    if array.ndim < 1 or array.shape[-1] != len(layout):
        raise ReadingError(f"{name} have shape {array.shape}; expected (..., {len(layout)})")
    lead = array.shape[:-1]
    return array.reshape(math.prod(lead), len(layout)), lead


def _limits(layout: SoleLayout, threshold: float | None) -> tuple[float, float]:
    low = layout.force_threshold if threshold is None else number(threshold, "activation threshold")
    return low, layout.force_limit


def _is_plain(force: NDArray[np.generic]) -> bool:
    return force.dtype == np.float64 and force.flags.c_contiguous and force.dtype.isnative and force.flags.aligned


def _doubles(force: NDArray[np.float64]) -> NDArray[np.float64]:
    """Forces as the kernels take them, converted if needed."""
    return force if _is_plain(force) else np.ascontiguousarray(force, dtype=np.float64)


def _pieces(force: NDArray[np.float64], threads: int | None, frames: int | None = None) -> list[slice]:
    """Frames in pieces: one for one thread, else four a thread, `BLOCK` where something is copied."""
    count = len(force)
    workers = _workers(threads)
    size = max(count, 1) if workers == 1 else max(-(-count // (4 * workers)), _LEAST)
    if frames is not None or not _is_plain(force):
        size = min(size, frames or BLOCK)
    return [rows for rows, _ in blocks(force, size)]


def _workers(threads: int | None) -> int:
    if threads is not None:
        return integer(threads, "threads", 1)
    affinity = getattr(os, "sched_getaffinity", None)  # not everywhere: without it all cores count
    return len(affinity(0)) if affinity else os.cpu_count() or 1


def _shared(work: Callable[[slice], _Done], pieces: list[slice], threads: int | None) -> list[_Done]:
    """Results of work on each piece, in order, by as many threads as there is work for.

    The caller's thread is one; waking threads costs up to 0.3 ms.
    """
    others = min(_workers(threads), len(pieces)) - 1
    if others <= 0:
        return [work(rows) for rows in pieces]
    left = deque(enumerate(pieces))
    done: dict[int, _Done] = {}

    def take() -> None:
        while left:
            try:
                place, rows = left.popleft()
            except IndexError:  # another thread has taken the last one
                return
            done[place] = work(rows)

    with ThreadPoolExecutor(others) as pool:
        helpers = [pool.submit(take) for _ in range(others)]
        take()
        for helper in helpers:
            helper.result()
    return [done[place] for place in range(len(pieces))]
