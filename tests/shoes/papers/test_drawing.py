"""Tests of the drawing: a reviewer's list, and its sections against rays in the print."""

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely

from plantar.shoes import ShoeReport
from plantar.shoes.papers import sheet as sheet_module
from plantar.shoes.papers.drawing import draw_shoe, sheet_of
from plantar.shoes.papers.sheet import Sheet, View
from plantar.shoes.units import to_mm

from ..shoe_witness import hits


def sheet(exported: tuple[ShoeReport, Path], index: int) -> Sheet:
    build = exported[0].build
    surface = build.shoes[index].surface
    assert surface is not None
    return sheet_of(build.shoes[index], build, surface)


@pytest.mark.parametrize("index", [0, 1])
def test_a_reviewer_finds_datums_every_feature_tolerances_and_the_title(exported, index):
    report = exported[0]
    shoe = exported[0].build.shoes[index]
    p = report.build.parameters
    plan = shoe.plan
    drawn = sheet(exported, index)
    texts = [t[1] for t in drawn.texts]
    assert {"A", "B", "C"} <= set(texts)
    for title in ("Title", "Part", "Material", "Scale", "Tolerances", "Date", "Drawn by", "State", "Revision"):
        assert title in texts
    assert f"small, {shoe.side} shoe" in texts
    assert any(t.startswith("not built") for t in texts)
    assert any("ISO 2768" in t for t in texts)
    assert any(re.fullmatch(r"\d(\.\d)?:\d(\.\d)?", t) for t in texts)
    rows = {t: texts[i + 1 : i + 4] for i, t in enumerate(texts)}
    for number, (x, y, _) in zip(shoe.layout.ids, to_mm(shoe.layout.positions).tolist(), strict=True):
        assert rows[f"pocket {number}"] == [f"{x:.2f}", f"{y:.2f}", "⌀0.3 A B C"]
    ports = [t for t in texts if t.startswith("port ") and "-" in t]
    assert len(ports) == len(plan.route)
    assert len([t for t in texts if t.startswith("lug, ")]) == len(report.build.retention.places)
    assert any(t.startswith("board slot") for t in texts)
    for detail in ("pocket and rib", "port", "lug", "slot of the board"):
        assert any(re.match(rf"[D-G]   {detail}   \d", t) for t in texts), detail
    low_x, low_y, high_x, high_y = plan.contact.bounds
    for size in (high_x - low_x, high_y - low_y):
        assert f"{size:.1f} ±0.3" in texts
    for level in (p.thickness, p.rim_top):
        assert any(t.startswith(f"{level:g} ±") for t in texts)
    for inspected in ("flatness of A", "pocket depth from A", "rib", "gap of foot and wall", "slot of each lug"):
        tolerance = rows[inspected][1]
        assert re.search(r"[±+]?\d", tolerance), inspected
    for _, points in drawn.lines:  # all of it on the sheet, within its frame
        assert ((points >= [19.9, 9.9]) & (points <= [410.1, 287.1])).all()


def test_a_drawing_is_made_once_for_all_its_formats(exported, tmp_path, monkeypatch):
    build = exported[0].build
    surface = build.shoes[0].surface
    assert surface is not None
    figures: list[Any] = []
    made = sheet_module.new_figure
    monkeypatch.setattr(sheet_module, "new_figure", lambda *size: figures.append(made(*size)) or figures[-1])
    paths = draw_shoe(build.shoes[0], build, surface, [tmp_path / f"a.{e}" for e in ("pdf", "png", "svg")])
    assert len(figures) == 1
    assert paths[0].read_bytes().startswith(b"%PDF")
    assert paths[1].read_bytes().startswith(b"\x89PNG")
    assert "<!-- pocket 3 -->" in paths[2].read_text()


@pytest.mark.parametrize("index", [0, 1])
def test_the_sections_are_what_rays_meet_in_the_print(exported, index, monkeypatch):
    surface = exported[0].build.shoes[index].surface
    assert surface is not None
    shapes: list[Any] = []
    monkeypatch.setattr(View, "hatch", lambda view, shape: shapes.append(shape))
    texts = [t[1] for t in sheet(exported, index).texts]
    chance = np.random.default_rng(4)
    up = np.array([0.0, 0.0, 1.0])
    for shape, name, across in zip(shapes, ("A-A", "B-B"), (0, 1), strict=False):
        at = float(next(t for t in texts if t.startswith(name)).split(" = ")[1].split(",")[0])
        low, _, high, top = shape.bounds
        for u in chance.uniform(low - 3.0, high + 3.0, 30):
            met = hits(surface, np.array([u, at, -1.0] if across == 0 else [at, u, -1.0]), up) - 1.0
            for z in chance.uniform(0.0, top + 2.0, 8):
                if len(met) and np.abs(met - z).min() < 0.25:  # the text rounds the place
                    continue
                assert shape.contains(shapely.Point(u, z)) == ((met < z).sum() % 2 == 1), (name, u, z)


@pytest.mark.parametrize("index", [0, 1])
def test_sides_toes_and_heel_are_named_where_they_are(exported, index):
    places = {t[1]: t[0] for t in sheet(exported, index).texts}
    side = exported[0].build.shoes[index].side
    inner = places["right, inner side" if side == "left" else "left, inner side"]
    outer = places["left, outer side" if side == "left" else "right, outer side"]
    assert (outer[1] - inner[1]) * (1 if side == "left" else -1) > 0.0  # y is to the left on both feet
    assert places["toes"][0] > places["heel"][0]
