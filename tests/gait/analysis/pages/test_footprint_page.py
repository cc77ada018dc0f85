"""The page of a footprint image in a real browser: it can be read at 390 px, and its figure prints whole."""

import numpy as np
import pytest

from plantar.gait.analysis.analyse import analyse_recording

from ..browser import visit
from ..printing import printed_images
from ..test_report_in_browser import READABLE, whole

cv2 = pytest.importorskip("cv2", reason="OpenCV is not installed: pip install '.[formats]'")

pytestmark = pytest.mark.drawn


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    """The page of two feet of 240 mm at 2 pixels a mm."""
    folder = tmp_path_factory.mktemp("print")
    image = np.full((640, 640, 3), 255, dtype=np.uint8)
    for middle in (160, 480):
        for up, half_length, half_width in ((70, 70, 52), (190, 120, 40), (310, 76, 90), (450, 24, 60)):
            cv2.ellipse(image, (middle, 600 - up), (half_width, half_length), 0, 0, 360, (60, 60, 160), -1)
    assert cv2.imwrite(str(folder / "print.png"), image)
    analyse_recording(folder / "print.png", folder / "out", mm_per_pixel=0.5)
    return folder / "out" / "report.html"


@pytest.mark.parametrize("dark", [False, pytest.param(True, marks=pytest.mark.long)])
def test_the_page_can_be_read_on_a_telephone(page, tmp_path, dark):
    seen = visit(page, READABLE, tmp_path, dark=dark, width=390)
    found = seen.found
    assert seen.console == []
    assert found["texts"] > 20
    assert found["weak"] == found["unnamed"] == found["outline"] == found["axe"] == []
    assert found["wide"] <= 0


def test_the_figure_is_printed_whole(page, tmp_path):
    images = printed_images(page, tmp_path)
    assert len(images) == page.read_text().count("<figure") == 1
    assert whole(images)
    assert float((images[0].high - images[0].low)[1]) > 0.3
