"""Sole readings in a video's corner: taxels, CoP and forces."""

from collections import deque
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.layouts.layout import SoleLayout
from plantar.sensing.reading import Reading
from plantar.sim.figures.drawn_run import FULL_COLOUR, scale_colours
from plantar.sim.figures.render import opencv

_SECONDS = 4.0  # of the forces that are drawn
_LEAST = 0.02  # weight on a sole below which no CoP is drawn
_PAPER = (255, 255, 255)
_INK = (40, 40, 40)
_SOFT = (150, 150, 150)
_LINES = {"left": (31, 107, 191), "right": (204, 84, 26)}
_COP = (217, 26, 77)


class SoleInset:
    """Draws the soles of `layouts` from above, `height` pixels high, and their forces over the `weight` in N."""

    def __init__(self, layouts: Mapping[Side, SoleLayout], weight: float, height: int) -> None:
        self._cv2 = opencv()
        self._layouts = layouts
        self._weight = weight
        self._height = height
        self._margin = max(4, height // 20)
        corners = np.vstack([layouts[side].outline for side in SIDES])
        low = corners.min(axis=0)
        high = corners.max(axis=0)
        self._scale = (height - 2 * self._margin - height // 8) / float(high[0] - low[0])
        self._toe = float(high[0])
        width = int(self._scale * float(high[1] - low[1])) + 2 * self._margin
        self._left = {side: (width * i + self._margin, float(high[1])) for i, side in enumerate(SIDES)}
        self._chart = 2 * width  # x of the chart of forces
        self._width = self._chart + int(1.6 * height)
        self._cells = {
            side: [self._pixels(side, layout.vertices[list(ring), :2]) for ring in layout.corners]
            for side, layout in layouts.items()
        }
        self._colours = scale_colours(255)
        self._past: deque[tuple[float, tuple[float, ...]]] = deque()

    def _pixels(self, side: Side, points: NDArray[np.float64]) -> NDArray[np.int32]:
        left, inner = self._left[side]
        x = left + self._scale * (inner - points[:, 1])
        y = self._margin + self._scale * (self._toe - points[:, 0])
        return np.column_stack([x, y]).round().astype(np.int32)

    def draw(self, picture: NDArray[np.uint8], readings: Mapping[Side, Reading], time: float) -> None:
        """Draw `readings` at `time` in s into the upper left of an RGB `picture` (height, width, 3), in place."""
        cv2 = self._cv2
        inset = np.full((self._height, self._width, 3), _PAPER, dtype=np.uint8)
        totals = []
        for side in SIDES:
            force = np.nan_to_num(readings[side].force)
            totals.append(max(0.0, float(force.sum())))
            share = np.clip(force / (FULL_COLOUR * self._weight), 0.0, 1.0)
            colours = self._colours[(share * (len(self._colours) - 1)).astype(int)]
            for ring, colour in zip(self._cells[side], colours.tolist(), strict=True):
                cv2.fillConvexPoly(inset, ring, colour, cv2.LINE_AA)
            if totals[-1] > _LEAST * self._weight:
                cop = force @ self._layouts[side].positions[:, :2] / force.sum()
                ((x, y),) = self._pixels(side, cop[None]).tolist()
                for wide, colour in ((4, _PAPER), (2, _COP)):
                    cv2.drawMarker(inset, (x, y), colour, cv2.MARKER_CROSS, self._height // 12, wide, cv2.LINE_AA)
            self._write(inset, f"{totals[-1]:.0f} N", self._left[side][0], self._height - self._margin, _INK)
        self._draw_forces(inset, time, tuple(totals))
        corner = picture[: self._height, : self._width]
        corner[:] = inset[: corner.shape[0], : corner.shape[1]]

    def _write(self, inset: NDArray[np.uint8], text: str, x: int, y: int, colour: tuple[int, int, int]) -> None:
        font = self._cv2.FONT_HERSHEY_SIMPLEX
        size = self._height / 360
        self._cv2.putText(inset, text, (x, y), font, size, colour, 1, self._cv2.LINE_AA)

    def _draw_forces(self, inset: NDArray[np.uint8], time: float, totals: tuple[float, ...]) -> None:
        past = self._past
        past.append((time, totals))
        while past[0][0] < time - _SECONDS:
            past.popleft()
        height = self._height - 2 * self._margin
        width = self._width - self._chart - 2 * self._margin
        right = self._chart + self._margin + width
        floor = self._margin + height
        most = 1.4 * self._weight
        level = floor - round(height * self._weight / most)
        self._cv2.line(inset, (self._chart + self._margin, level), (right, level), _SOFT, 1)
        top = self._margin + self._height // 12  # of 1.4 weights: no force of a foot that stands comes there
        self._write(inset, f"force, {_SECONDS:.0f} s; line: weight", self._chart + self._margin, top, _INK)
        times = np.array([t for t, _ in past])
        x = right - width * (time - times) / _SECONDS
        for i, side in enumerate(SIDES):
            y = floor - height * np.clip([forces[i] / most for _, forces in past], 0.0, 1.0)
            line = np.column_stack([x, y]).round().astype(np.int32)
            self._cv2.polylines(inset, [line], False, _LINES[side], 2, self._cv2.LINE_AA)
