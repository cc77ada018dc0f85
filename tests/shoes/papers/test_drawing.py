"""Tests of the drawing: what stands in it, read from its SVG."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.colors import to_rgba
from matplotlib.path import Path as Line

from plantar.plotting import COLOURS
from plantar.shoes import ShoeReport
from plantar.shoes.papers import drawing
from plantar.shoes.papers.drawing import draw_shoe

from ..shoe_witness import hits


@pytest.mark.parametrize("index", [0, 1])
def test_the_drawing_states_its_dimensions(exported: tuple[ShoeReport, Path], tmp_path: Path, index: int) -> None:
    report, _ = exported
    shoe, p = report.build.shoes[index], report.build.parameters
    assert shoe.surface is not None
    (path,) = draw_shoe(shoe, report.build, shoe.surface, [tmp_path / "drawing.svg"])
    text = path.read_text()
    low_x, low_y, high_x, high_y = shoe.plan.contact.bounds
    for comment in (
        f"{high_x - low_x:.1f}",
        f"{high_y - low_y:.1f}",
        f"{p.thickness:g}",
        f"{p.rim_top:g}",
        f"small, {shoe.side} shoe",
        "From above; overhang of the contact face",
        "A-A, y =",
        "B-B, x =",
    ):
        assert f"<!-- {comment}" in text
    for taxel in shoe.layout.ids:
        assert f"<!-- {taxel} -->" in text


@pytest.mark.parametrize("side", ["left", "right"])
def test_the_sections_are_what_rays_meet_in_the_print_and_its_sides_are_named(
    exported: tuple[ShoeReport, Path], side: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Points all over both sections lie in the print where a ray from below has met it an odd number of times."""
    report, _ = exported
    (shoe,) = (s for s in report.build.shoes if s.side == side)
    assert shoe.surface is not None
    figures: list[Any] = []
    monkeypatch.setattr(drawing, "save_figure", lambda figure, path: figures.append(figure) or Path(path))
    draw_shoe(shoe, report.build, shoe.surface, ["drawing.png"])
    top, *sections = figures[0].axes
    chance, up = np.random.default_rng(4), np.array([0.0, 0.0, 1.0])
    for axes, across in zip(sections, (0, 1), strict=True):
        name, at = axes.get_title(loc="left").split(", seen")[0].split(" = ")
        assert name[-1] == "yx"[across]
        print_, white = [], []
        for patch in axes.patches:
            colour = patch.get_facecolor()
            line = Line(patch.get_xy())
            print_ += [line] if colour[:3] == to_rgba(COLOURS[side])[:3] else []
            white += [line] if colour[:3] == (1.0, 1.0, 1.0) else []
        assert print_
        box = np.concatenate([line.vertices for line in print_])
        for u in chance.uniform(box[:, 0].min() - 3.0, box[:, 0].max() + 3.0, 40):
            place = np.array([u, float(at), -1.0] if across == 0 else [float(at), u, -1.0])
            met = hits(shoe.surface, place, up) - 1.0
            for z in chance.uniform(0.0, box[:, 1].max() + 2.0, 12):
                if len(met) and np.abs(met - z).min() < 0.25:  # the title rounds the place
                    continue
                drawn = any(p.contains_point((u, z)) for p in print_) and not any(
                    w.contains_point((u, z)) for w in white
                )
                assert drawn == ((met < z).sum() % 2 == 1), (name, u, z)
    words = {t.get_text(): t.get_position() for t in top.texts}
    inner = words["right, inner side" if side == "left" else "left, inner side"]
    outer = words["left, outer side" if side == "left" else "right, outer side"]
    assert (outer[1] - inner[1]) * (1 if side == "left" else -1) > 0.0  # y is to the left on both feet
    assert words["toes"][0] > shoe.plan.contact.bounds[2]
    assert words["heel"][0] < shoe.plan.contact.bounds[0]
