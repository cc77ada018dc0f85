"""Footprints in images, drawn so that their measures are known."""

import json
import math
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from plantar import FormatError, InputError, cli
from plantar.formats import detect_format, read_recording
from plantar.formats.footprint_image import read_footprints
from plantar.formats.format import ReadOptions
from plantar.gait.analysis.analyse import analyse_recording

from .corruption import refusals

cv2 = pytest.importorskip("cv2", reason="OpenCV is not installed: pip install '.[formats]'")

MM = 0.5


@pytest.fixture(autouse=True)
def _quick_figures(quick_figures):
    """Of all footprints here; the tests of their pages draw them whole."""


def canvas(feet: int = 1, background: int = 255) -> np.ndarray:
    return np.full((640, 320 * feet, 3), background, dtype=np.uint8)


def draw_foot(image, middle, side, colour, toes=True, arch=False, gap=1.0):
    """A foot of 240 mm, toes up: heel, lateral midfoot, ball, and toes that lie apart from it, farther with `gap`."""
    medial = 1.0 if side == "left" else -1.0  # in the image to the right of a left foot

    def disc(u: float, v: float, a: float, b: float) -> None:
        centre = round(middle + medial * v / MM), round(600 - u / MM)
        cv2.ellipse(image, centre, (round(b / MM), round(a / MM)), 0, 0, 360, colour, -1, cv2.LINE_AA)

    disc(35, 0, 35, 26)
    x0, x1 = sorted((middle - medial * 32 / MM, middle - medial * 2 / MM))
    if not arch:
        cv2.rectangle(image, (round(x0), round(600 - 160 / MM)), (round(x1), round(600 - 30 / MM)), colour, -1)
    disc(155, 0, 38, 45)
    if toes:
        disc(222 * gap, 24, 18, 12)
        for v in (2, -10, -20, -29):
            disc((214 - 0.3 * abs(v)) * gap, v, 9, 5)


def save(path: Path, image: np.ndarray) -> Path:
    assert cv2.imwrite(str(path), image)
    return path


@pytest.mark.parametrize("side", ["left", "right"])
def test_a_foot_without_a_midfoot_is_one_foot(tmp_path, side):
    image = canvas()
    draw_foot(image, 160, side, (60, 60, 160), arch=True)
    result = analyse_recording(save(tmp_path / "print.png", image), tmp_path / "out", mm_per_pixel=MM)
    (name,) = result["feet"]
    assert name == side
    assert result["feet"][name]["footprint"]["length_m"] == pytest.approx(0.24, abs=0.003)
    assert result["feet"][name]["footprint"]["arch_index"] < 0.1  # the ball alone reaches into the middle third


@pytest.mark.sample(1)
@pytest.mark.parametrize("gap", [0.97, 1.0, 1.04])
@pytest.mark.parametrize("side", ["left", "right"])
def test_the_shape_does_not_depend_on_the_scale(tmp_path, side, gap):
    """A picture of a foot may be of any size; where that is no foot's, the scale is doubted."""
    image = canvas()
    draw_foot(image, 160, side, (60, 60, 160), gap=gap)
    path, found, options = save(tmp_path / "print.png", image), [], ReadOptions(side=side)
    for scale in (None, 0.02, 0.2, 0.5, 0.7, 5.0):
        result = analyse_recording(path, tmp_path / "out", mm_per_pixel=scale, options=options, figures=False)
        foot = result["feet"][side]["footprint"]
        toeless = foot["toeless_length_m"] / foot["length_m"] if scale else None
        found.append((foot["arch_index"], foot["region_area_percent"]["hallux"], toeless))
        doubts = [w for w in result["warnings"] if "m long, feet are 0.08 to 0.4 m: check" in w]
        assert len(doubts) == (scale in (0.02, 5.0))
    assert np.ptp([row[:2] for row in found], axis=0) == pytest.approx([0.0, 0.0], abs=1e-6)
    assert np.ptp([row[2] for row in found[1:]]) == pytest.approx(0.0, abs=1e-6)
    assert {p.name for p in (tmp_path / "out").iterdir()} == {"metrics.json", "footprints.csv"}
    assert found[1][2] == pytest.approx(193.0 / (222.0 * gap + 18.0), abs=0.01)


@pytest.mark.sample(2)
@pytest.mark.parametrize(("suffix", "side"), [("png", "left"), ("jpg", "right"), ("tif", "left"), ("bmp", "right")])
def test_a_drawn_foot(tmp_path, suffix, side):
    image = canvas()
    draw_foot(image, 160, side, (60, 60, 160))
    path = save(tmp_path / f"print.{suffix}", image)
    assert detect_format(path).name == "image"
    result = analyse_recording(path, tmp_path / "out", mm_per_pixel=MM)
    (name,) = result["feet"]
    foot = result["feet"][name]["footprint"]
    assert name == side
    assert foot["length_m"] == pytest.approx(0.240, abs=0.002)
    assert foot["width_m"] == pytest.approx(0.090, abs=0.003)
    assert foot["toeless_length_m"] == pytest.approx(0.193, abs=0.004)
    assert foot["toes_told_apart"]
    assert foot["axis_angle_deg"] == pytest.approx(0.0, abs=6.0)
    assert 0.2 < foot["arch_index"] < 0.35
    assert foot["region_areas_m2"]["heel"] > foot["region_areas_m2"]["hallux"] > 0.0
    names = {p.name for p in (tmp_path / "out").iterdir()}
    assert names == {"metrics.json", "footprints.csv", "footprint.png", "footprint.svg", "report.html"}
    assert json.loads((tmp_path / "out" / "metrics.json").read_text())["feet"][side]["footprint"] == foot


def test_an_ellipse_has_its_measures_at_any_angle_and_background(tmp_path):
    third = (2 / math.pi) * (math.asin(1 / 3) + math.sqrt(8) / 9)
    for angle, background, colour in ((0, 255, (40, 40, 40)), (25, 20, (200, 220, 210)), (-40, 128, (60, 180, 60))):
        image = canvas(2, background)
        cv2.ellipse(image, (320, 320), (90, 240), angle, 0, 360, colour, -1, cv2.LINE_AA)
        path = save(tmp_path / "ellipse.png", image)
        result = analyse_recording(path, tmp_path / "out", mm_per_pixel=MM, options=ReadOptions(side="left"))
        foot = result["feet"]["left"]["footprint"]
        assert foot["arch_index"] == pytest.approx(third, rel=0.01)
        assert foot["area_m2"] == pytest.approx(math.pi * 0.045 * 0.120, rel=0.02)
        assert foot["length_m"] == pytest.approx(0.240, rel=0.015)
        assert foot["width_m"] == pytest.approx(0.090, rel=0.02)
        assert not foot["toes_told_apart"]
        assert abs(foot["axis_angle_deg"]) % 180 == pytest.approx(abs(angle), abs=1.0) or abs(
            abs(foot["axis_angle_deg"]) - 180 + abs(angle)
        ) == pytest.approx(0.0, abs=1.0)


def test_two_feet_a_scan_with_noise_and_resolution(tmp_path):
    image = canvas(2, 235)
    draw_foot(image, 170, "left", (120, 140, 90))
    draw_foot(image, 470, "right", (120, 140, 90))
    random = np.random.default_rng(0)
    noisy = np.clip(image + random.normal(0.0, 6.0, image.shape), 0, 255).astype(np.uint8)
    noisy[100:104, 20:24] = 0  # dust
    result = analyse_recording(save(tmp_path / "scan.png", noisy), tmp_path / "out", mm_per_pixel=MM)
    assert list(result["feet"]) == ["left", "right"]
    left, right = (result["feet"][s]["footprint"] for s in ("left", "right"))
    assert left["length_m"] == pytest.approx(0.240, abs=0.003)
    assert left["arch_index"] == pytest.approx(right["arch_index"], abs=0.01)
    bare = analyse_recording(tmp_path / "scan.png", tmp_path / "out2")
    assert bare["mm_per_pixel"] is None
    assert bare["feet"]["left"]["footprint"]["length_m"] is None
    assert bare["feet"]["left"]["footprint"]["arch_index"] == pytest.approx(left["arch_index"], abs=1e-9)
    assert any("give --mm-per-pixel" in w for w in bare["warnings"])


def test_the_stated_resolution_is_used(tmp_path):
    from PIL import Image

    image = canvas()
    draw_foot(image, 160, "left", (40, 40, 40))
    for suffix in ("png", "jpg"):
        path = tmp_path / f"scan.{suffix}"
        Image.fromarray(image).save(path, dpi=(50.8, 50.8) if suffix == "png" else (51, 51))
        found = read_footprints(path)
        assert found.pixel == pytest.approx(0.5e-3, rel=0.01)
        assert any("resolution that the image states" in w for w in found.warnings)


def test_what_is_no_footprint(tmp_path):
    blank = save(tmp_path / "blank.png", canvas())
    with pytest.raises(FormatError, match="no footprint stands out"):
        read_footprints(blank)
    with pytest.raises(FormatError, match="no recording over time"):
        read_recording(blank)
    with pytest.raises(InputError, match=r"allowed: 0\.001 to 50"):
        read_footprints(blank, -1.0)
    (tmp_path / "bad.png").write_bytes(blank.read_bytes()[:60])
    with pytest.raises(FormatError, match="not an image that can be read"):
        read_footprints(tmp_path / "bad.png")
    for arguments in (["analyze", str(blank)], ["analyze", str(tmp_path / "bad.png")]):
        done = CliRunner().invoke(cli.app, [*arguments, "-o", str(tmp_path / "none")])
        assert isinstance(done.exception, FormatError)
    assert not (tmp_path / "none").exists()


@pytest.mark.sample(2)
@pytest.mark.parametrize("suffix", ["png", "jpg", "tif", "bmp"])
def test_damage(tmp_path, suffix):
    image = canvas()
    draw_foot(image, 160, "left", (40, 40, 40))
    path = save(tmp_path / f"print.{suffix}", image)
    refusals(path, trials=6, read=lambda path: read_footprints(path, MM), header=200)
