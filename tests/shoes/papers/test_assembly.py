"""Tests of the assembly page: it is whole, its counts and lengths are the files', and it can be read."""

import base64
import csv
import re

import cv2
import numpy as np
import pytest

from plantar.shoes.papers.picture import rendered_png
from plantar.shoes.solid.pad import prism_surface

from ...gait.analysis.browser import visit
from ...gait.analysis.test_report_in_browser import READABLE
from ...html_text import addresses_of


def test_the_page_is_whole_and_needs_no_network(exported):
    text = (exported[1] / "assembly.html").read_text()
    shops = set(re.findall(r'<a href="(https://[^"]+)">', text))  # followed where a reader asks, never loaded
    assert all(a.startswith(("#", "data:")) for a in addresses_of(text) if a not in shops)
    assert "url(" not in text


def test_each_step_has_a_picture_that_shows_its_parts(exported):
    text = (exported[1] / "assembly.html").read_text()
    steps = re.findall(r'<section aria-labelledby="step\d+">.*?</section>', text, re.DOTALL)
    assert len(steps) == 9
    pictures = [re.findall(r'alt="([^"]+)" src="data:image/png;base64,([^"]+)"', step) for step in steps]
    assert all(len(one) == 1 for one in pictures)
    seen = [cv2.imdecode(np.frombuffer(base64.b64decode(one[0][1]), np.uint8), cv2.IMREAD_COLOR) for one in pictures]
    assert all(image.shape[1] == 480 for image in seen)
    for image in seen:  # something is drawn, and around it is white
        drawn = (image < 250).any(axis=2)
        assert 0.1 < drawn.mean() < 0.95
        assert not drawn[:3].any()
        assert not drawn[:, :3].any()
    wires = seen[4].astype(int)
    assert ((wires[..., 2] - wires[..., 1] > 60) & (wires[..., 2] - wires[..., 0] > 60)).sum() > 100  # red ones
    assert len({image.tobytes() for image in seen}) == len(seen)


def test_counts_and_lengths_are_those_of_the_files(exported):
    _, folder = exported
    text = re.sub(r"<[^>]+>", " ", (folder / "assembly.html").read_text())
    with (folder / "wiring.csv").open() as file:
        rows = [r for r in csv.DictReader(file) if r["side"] == "left"]
    wires = [float(r["wire_mm"]) for r in rows if r["from_cell"]]
    (lead,) = (float(r["wire_mm"]) for r in rows if not r["from_cell"])
    for words in (
        f"{len(rows)} taxels for each foot",
        f"{len(wires)} wires for each foot",
        f"{min(wires):.0f} to {max(wires):.0f} long",
        f"{lead:.0f} long",
        "Draw 1 strap(s)",
        "Material: PA12, MJF",
        "tare",
    ):
        assert words in text, words
    total = re.search(r"(\d+) in all", text)
    assert abs(float(total[1]) - sum(wires)) < 1.0
    told = {int(b) for line in re.findall(r"from \d+ ([^f]+)", text) for b in re.findall(r"(\d+) \(\d+\)", line)}
    assert told == {int(r["cell"]) for r in rows if r["from_cell"]}


def test_wires_are_no_shorter_than_straight_and_as_long_as_their_ways(exported):
    _, folder = exported
    with (folder / "wiring.csv").open() as file:
        rows = [r for r in csv.DictReader(file) if r["side"] == "right"]
    place = {r["cell"]: np.array([float(r["x_mm"]), float(r["y_mm"])]) for r in rows}
    for r in rows:
        if r["from_cell"]:
            port = np.array([float(r["port_x_mm"]), float(r["port_y_mm"])])
            way = np.hypot(*(port - place[r["from_cell"]])) + np.hypot(*(place[r["cell"]] - port))
            assert float(r["wire_mm"]) == pytest.approx(way, abs=0.06)


def test_a_rendered_file_is_a_png_of_what_was_rendered():
    import shapely

    body = prism_surface(shapely.box(0.0, 0.0, 40.0, 20.0), 0.0, 5.0)
    content = rendered_png([(body, (1.0, 0.0, 0.0))], azimuth=-90.0, elevation=90.0, width=100)
    image = cv2.imdecode(np.frombuffer(content, np.uint8), cv2.IMREAD_COLOR)
    assert image.shape[1] == 100
    assert image[image.shape[0] // 2, 50].tolist()[:2] == [0, 0]  # blue and green
    assert image[image.shape[0] // 2, 50, 2] > 200


@pytest.mark.long
@pytest.mark.parametrize(("dark", "width"), [(False, 390), (True, 390), (False, 1100), (True, 1100)])
def test_the_page_can_be_read_and_reached(exported, dark, width, tmp_path):
    seen = visit(exported[1] / "assembly.html", READABLE, tmp_path, dark=dark, width=width)
    assert seen.console == []
    found = seen.found
    assert found["weak"] == found["unnamed"] == found["outline"] == found["axe"] == []
    assert found["wide"] <= 0
    assert found["texts"] > 40
    assert found["background"] == ("rgb(13, 17, 23)" if dark else "rgb(255, 255, 255)")
