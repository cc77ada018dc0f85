"""A page printed to PDF by Chromium, and where its figures lie on the sheets."""

import re
import subprocess
import zlib
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .browser import browser

_OPERATION = re.compile(rb"(?:^|\n)(q|Q)(?=\n)|(?:^|\n)((?:[-.\d]+ ){6})cm|/(\w+) Do")


class PrintedImage(NamedTuple):
    """An image on a sheet: which one, and its lower left and upper right corner in shares of the sheet."""

    name: str
    sheet: int
    low: NDArray[np.float64]
    high: NDArray[np.float64]


def printed_images(page: Path, work: Path) -> list[PrintedImage]:
    """Print a page and find its images: one that is cut lies on two sheets, or beyond the edge of one."""
    content = printed(page, work)
    parts = {m[1]: m[2] for m in re.finditer(rb"(?:^|\n)(\d+) 0 obj\n(.*?)endobj", content, re.DOTALL)}
    images = {number for number, part in parts.items() if b"/Subtype /Image" in part.partition(b"stream\n")[0]}
    sheets = [part for part in parts.values() if b"/Type /Page\n" in part]
    return [image for i, sheet in enumerate(sheets) for image in _images_of(sheet, i, parts, images)]


def printed(page: Path, work: Path) -> bytes:
    """A page as PDF."""
    target = work / "printed.pdf"
    command = [browser(), "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage"]
    command += [f"--user-data-dir={work / 'printing'}", "--no-first-run", "--disable-background-networking"]
    command += ["--no-pdf-header-footer", f"--print-to-pdf={target}", page.resolve().as_uri()]
    subprocess.run(command, check=True, capture_output=True, timeout=600)
    return target.read_bytes()


def _images_of(sheet: bytes, number: int, parts: dict[bytes, bytes], images: set[bytes]) -> list[PrintedImage]:
    """The images of a sheet, by following the transformations of its drawing operations (PDF 32000-1, 8.3 and 8.10)."""
    used = dict(re.findall(rb"/(\w+) (\d+) 0 R", sheet))
    box = np.array(re.search(rb"/MediaBox \[([^\]]*)\]", sheet)[1].split(), dtype=float)
    drawing = parts[used[b"Contents"]]
    stream = drawing[drawing.index(b"stream\n") + 7 : drawing.rindex(b"endstream")]
    state, kept, found = np.eye(3), [], []
    for operation in _OPERATION.finditer(zlib.decompress(stream)):
        if operation[1] == b"q":
            kept.append(state)
        elif operation[1] == b"Q":
            state = kept.pop()
        elif operation[2]:
            a, b, c, d, e, f = map(float, operation[2].split())
            state = np.array([[a, b, 0.0], [c, d, 0.0], [e, f, 1.0]]) @ state
        elif used.get(operation[3]) in images:
            corners = (np.array([[0.0, 0.0, 1.0], [1.0, 1.0, 1.0]]) @ state)[:, :2] / box[2:]
            name = used[operation[3]].decode()
            found.append(PrintedImage(name, number, corners.min(axis=0), corners.max(axis=0)))
    return found
