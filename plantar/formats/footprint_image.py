"""Footprints in images (PNG, JPEG, TIFF, BMP), found against the background."""

import struct
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.files.gate import read_apart
from plantar.common.files.image_size import stated_size
from plantar.common.files.input_file import read_input
from plantar.common.optional_library import optional_library
from plantar.errors import FormatError, InputError
from plantar.formats.format import Format

_MAGIC = (b"\x89PNG\r\n\x1a\n", b"\xff\xd8\xff", b"II*\0", b"MM\0*", b"BM")
_LARGEST = 250e6  # Most bytes of a file, and of an image once it is decoded: 83 million pixels in colour
_IMAGE = "not an image that can be read (PNG, JPEG, TIFF or BMP of 16 x 16 pixels or more)"
# What begins each scan of a JPEG, and how many pixels all of them may go over
_SCAN = b"\xff\xda"
_MOST_SCANNED = 2e9
_WORKING = 1600  # Longer side in pixels that is enough to outline a foot; larger images are reduced


@dataclass(frozen=True, eq=False)
class Print:
    """One footprint.

    `mask`: its pixels (h, w); `contours`: outlines (k, 2) of foot and separate toes as (column, row) in mask pixels.
    """

    mask: NDArray[np.bool_]
    contours: tuple[NDArray[np.float64], ...]


@dataclass(frozen=True, eq=False)
class FootprintImage:
    """Image with one or two footprints, left to right.

    `pixel`: mask pixel in m, or None; `picture`: RGB image (h, w, 3) of the masks' size; `warnings`: what was assumed.
    """

    path: Path
    pixel: float | None
    picture: NDArray[np.uint8]
    prints: tuple[Print, ...]
    warnings: tuple[str, ...]


def read_footprints(path: Path, mm_per_pixel: float | None = None) -> FootprintImage:
    """Returns footprints in an image at path, of mm_per_pixel mm or the file's resolution."""
    if mm_per_pixel is not None and not (np.isfinite(mm_per_pixel) and 0.001 <= mm_per_pixel <= 50.0):
        raise InputError(f"--mm-per-pixel {mm_per_pixel} is not possible; allowed: 0.001 to 50")
    with optional_library("cv2", "formats"):
        import cv2  # 0.1 s: only where an image is read
    data = read_input(path, FormatError, _LARGEST)
    warnings: list[str] = []
    image, factor = _decoded(path, data)
    if mm_per_pixel is None:
        mm_per_pixel = _stated_resolution(data)
        if mm_per_pixel is None:
            warnings.append("the image states no resolution: no lengths and areas; give --mm-per-pixel")
        else:
            warnings.append(f"{mm_per_pixel:.4g} mm a pixel, from the resolution that the image states")
    pixel = None if mm_per_pixel is None else mm_per_pixel * 1e-3 / factor
    prints = _prints(cv2, _foreground(cv2, image), pixel, warnings)
    if not prints:
        raise FormatError(f"{path}: no footprint stands out from the background of the image")
    return FootprintImage(path, pixel, np.ascontiguousarray(image[:, :, ::-1]), tuple(prints), tuple(warnings))


def _decoded(path: Path, data: bytes) -> tuple[NDArray[np.uint8], float]:
    _refuse_large(path, data)
    held = read_apart("image", path, FormatError)
    image = np.asarray(held["image"])
    if image.ndim != 3 or min(image.shape[:2]) < 16:
        raise FormatError(f"{path}: {_IMAGE}")
    return image, float(held["factor"])


def decoded_image(path: Path) -> dict[str, Any]:
    """Image large enough to outline a foot, for `confined`.

    Returns "image": 8-bit BGR over white (h, w, 3), empty if OpenCV reads none; "factor": of its reduction.
    """
    import cv2

    raw = cv2.imdecode(np.fromfile(path, dtype=np.uint8), cv2.IMREAD_UNCHANGED)
    if raw is None:
        return {"image": np.zeros((0, 0, 3), dtype=np.uint8), "factor": 1.0}
    raw, factor = _reduced(cv2, raw)
    if raw.dtype != np.uint8:
        raw = raw.astype(float)
        known = raw[np.isfinite(raw)]
        low, high = (float(known.min()), float(known.max())) if known.size else (0.0, 1.0)
        share = (np.nan_to_num(raw, nan=low, posinf=high, neginf=low) - low) / max(high - low, 1e-9)
        raw = (share * 255.0).clip(0, 255).astype(np.uint8)
    if raw.ndim == 2 or raw.shape[2] == 1:
        return {"image": cv2.cvtColor(raw, cv2.COLOR_GRAY2BGR), "factor": factor}
    if raw.shape[2] == 4:
        alpha = raw[:, :, 3:].astype(float) / 255.0
        raw = (raw[:, :, :3] * alpha + 255.0 * (1.0 - alpha)).astype(np.uint8)
    return {"image": raw[:, :, :3], "factor": factor}


def _refuse_large(path: Path, data: bytes) -> None:
    size = stated_size(data)
    if size is None or min(size.width, size.height) < 16:
        raise FormatError(f"{path}: {_IMAGE}")
    if size.memory > _LARGEST:
        raise FormatError(
            f"{path}: an image of {size.width} x {size.height} pixels takes {size.memory / 1e6:.0f} MB; "
            f"allowed: up to {_LARGEST / 1e6:.0f} MB"
        )
    scans = data.count(_SCAN) if data.startswith(_MAGIC[1]) else 0
    if scans * size.width * size.height > _MOST_SCANNED:
        raise FormatError(f"{path}: a JPEG of {scans} scans of {size.width} x {size.height} pixels takes too long")


def _reduced(cv2: Any, image: NDArray[Any]) -> tuple[NDArray[Any], float]:
    factor = min(1.0, _WORKING / max(image.shape[:2]))
    if factor == 1.0:
        return image, 1.0
    size = max(1, round(image.shape[1] * factor)), max(1, round(image.shape[0] * factor))
    return cv2.resize(image, size, interpolation=cv2.INTER_AREA), size[0] / image.shape[1]


def _stated_resolution(data: bytes) -> float | None:
    """mm a pixel stated by PNG (pHYs) or JPEG (JFIF); None without, or for a screen's 72 or 96 dpi."""
    per_metre = 0.0
    if data.startswith(_MAGIC[0]):
        at = data.find(b"pHYs", 0, 4096)
        if at > 0 and len(data) >= at + 13 and data[at + 12] == 1:
            per_metre = float(struct.unpack_from(">I", data, at + 4)[0])
    elif data.startswith(_MAGIC[1]) and data[6:10] == b"JFIF" and len(data) > 16:
        unit = data[13]
        density = float(struct.unpack_from(">H", data, 14)[0])
        per_metre = density / 0.0254 if unit == 1 else density * 100.0 if unit == 2 else 0.0
    dpi = per_metre * 0.0254
    if dpi < 20.0 or dpi > 4800.0 or min(abs(dpi - 72.0), abs(dpi - 96.0)) < 0.6:
        return None
    return 1e3 / per_metre


def _foreground(cv2: Any, image: NDArray[np.uint8]) -> NDArray[np.uint8]:
    smooth = cv2.GaussianBlur(image, (0, 0), max(1.0, max(image.shape[:2]) / 500.0))
    lab = cv2.cvtColor(smooth, cv2.COLOR_BGR2LAB).astype(np.float32)
    rim = max(2, min(image.shape[:2]) // 60)
    sides = (lab[:rim], lab[-rim:], lab[:, :rim], lab[:, -rim:])
    border = np.concatenate([side.reshape(-1, 3) for side in sides])
    distance = np.sqrt(((lab - np.median(border, axis=0)) ** 2).sum(axis=2))
    scaled = np.clip(distance * (255.0 / max(float(distance.max()), 1e-6)), 0, 255).astype(np.uint8)
    if float(distance.max()) < 12.0:
        return np.zeros(image.shape[:2], dtype=np.uint8)
    level, _ = cv2.threshold(scaled, 0, 255, cv2.THRESH_BINARY + cv2.THRESH_OTSU)
    noise = float(np.percentile(scaled[:rim], 99.0))
    inside = scaled[scaled > 0.7 * level]
    edge = min(level, 0.5 * float(np.median(inside)) if inside.size else level)  # halfway: where the edge is
    mask = (scaled > max(edge, min(noise + 6.0, level))).astype(np.uint8)
    kernel = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (3, 3))
    return np.asarray(cv2.morphologyEx(cv2.morphologyEx(mask, cv2.MORPH_OPEN, kernel), cv2.MORPH_CLOSE, kernel))


def _prints(cv2: Any, mask: NDArray[np.uint8], pixel: float | None, warnings: list[str]) -> list[Print]:
    count, labels, stats, centres = cv2.connectedComponentsWithStats(mask, connectivity=8)
    areas = stats[1:, cv2.CC_STAT_AREA].astype(float)
    if not len(areas):
        return []
    big = [i + 1 for i in range(count - 1) if areas[i] >= 0.005 * areas.max() and areas[i] >= 0.0002 * mask.size]
    big = [i for i in big if not (stats[i, 2] > 0.98 * mask.shape[1] and stats[i, 3] > 0.98 * mask.shape[0])]
    if not big:
        return []
    boxes = {i: stats[i, :4].astype(float) for i in big}
    longest = max(boxes.values(), key=lambda b: float(max(b[2], b[3])))
    length = max(longest[2:])
    upright = mask.shape[0] >= mask.shape[1] or longest[3] >= longest[2]
    groups: list[list[int]] = []
    for i in sorted(big, key=lambda k: -stats[k, cv2.CC_STAT_AREA]):
        near = [g for g in groups if _belongs(boxes, stats, g, i, upright, length)]
        if near:
            best = min(near, key=lambda g: float(np.hypot(*(centres[i] - centres[g[0]]))))
            best.append(i)
        else:
            groups.append([i])
    groups = [
        g for g in groups if sum(areas[i - 1] for i in g) >= 0.25 * max(sum(areas[i - 1] for i in h) for h in groups)
    ]
    if len(groups) > 2:
        warnings.append(f"{len(groups)} shapes stand out: the two largest are taken as feet")
        groups = sorted(groups, key=lambda g: -sum(areas[i - 1] for i in g))[:2]
    out: list[Print] = []
    for group in sorted(groups, key=lambda g: float(centres[g[0]][0])):
        own = np.isin(labels, group)
        found, _ = cv2.findContours(own.astype(np.uint8), cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
        contours = tuple(c.reshape(-1, 2).astype(float) for c in found if len(c) >= 3)
        out.append(Print(own, contours))
    return out


def _belongs(
    boxes: dict[int, NDArray[np.float64]], stats: Any, group: list[int], part: int, upright: bool, length: float
) -> bool:
    """Whether a part is of a group's foot: in line, and apart by under 0.4 of the foot (a high arch)."""
    across, along = (0, 1) if upright else (1, 0)
    low = min(boxes[i][across] for i in group)
    high = max(boxes[i][across] + boxes[i][across + 2] for i in group)
    box = boxes[part]
    middle = box[across] + 0.5 * box[across + 2]
    if not low - 0.25 * (high - low) <= middle <= high + 0.25 * (high - low):
        return False
    first = min(boxes[i][along] for i in group)
    last = max(boxes[i][along] + boxes[i][along + 2] for i in group)
    gap = max(first - (box[along] + box[along + 2]), box[along] - last)
    whole = max(last, box[along] + box[along + 2]) - min(first, box[along])
    return bool(gap < 0.4 * max(length, whole) and whole < 4.5 * max(high - low, box[across + 2]))


FORMAT = Format(
    name="image",
    title="footprint image, with --mm-per-pixel",
    suffixes=(".png", ".jpg", ".tif", ".bmp"),
    recognises=lambda head: head.startswith(_MAGIC),
    read=None,
    order=19,
)
