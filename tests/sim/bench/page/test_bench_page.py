"""The page of `plantar bench all`, from made-up results, as text and in a browser."""

import re
from pathlib import Path
from typing import Any

import pytest

from plantar.sim.bench.page.bench_page import bench_page

from ....gait.analysis.browser import visit
from ....gait.analysis.test_report_in_browser import READABLE
from ....html_text import addresses_of


def kernel(name: str, route: str, median: float, ratio: float, **named: Any) -> dict[str, Any]:
    row = {"kernel": name, "size": "20", "route": route, "ours": route.startswith("plantar"), "approximate": False}
    return {**row, "median_us": median, "spread": 0.1, "ratio": ratio, "error": 1e-16, **named}


def scene(setting: str, knob: str, value: str, **named: Any) -> dict[str, Any]:
    row = {"scene": "flat", "robot": "h1", "setting": setting, "knob": knob, "value": value, "against": "reference"}
    return {**row, "walked": True, "ratio": 1.0, "com_mm": 0.4, **named}


RESULT: dict[str, Any] = {
    "made": {"version": "Plantar <1>", "date": "2026-11-23", "machine": "here & there", "quick": True},
    "kernels": {
        "results": [
            kernel("hull + area", "plantar", 1.0, 1.0),
            kernel("hull + area", "shapely, ready", 40.0, 40.0),
            kernel("hull + area", "quick <b>guess</b>", 0.1, 0.1, approximate=True, error=0.2),
            kernel("wrench", "plantar", 2.0, 1.0),
            kernel("wrench", "numpy", 1.6, 0.8),
        ],
        "targets": [
            {"what": "hull", "wanted": 30.0, "figure": 40.0, "unit": "x", "at_least": True, "where": "", "met": True},
            {"what": "tick <", "wanted": 40.0, "figure": 50.0, "unit": "us", "at_least": 0, "where": "", "met": False},
        ],
    },
    "contact": {
        "chosen": "box",
        "models": [
            {"name": "box", "step_us": 8.0, "read_us": 37.0, "cop_max_mm": 0.0},
            {"name": "spheres", "step_us": 88.0, "read_us": 129.0, "cop_max_mm": 3.0},
            {"name": "fallen", "step_us": 8.0, "read_us": 9.0, "cop_max_mm": None},
        ],
    },
    "skip": {
        "scenes": [
            {"scene": "flat", "robot": "h1", "sim_s": 12.0, "run_s": 3.0, "factor": 9.0, "saved": 2.0,
             "same_motion": False, "shares": {"physics": 0.2, "sensing": 0.8}},
        ]
    },
    "scenes": {
        "rows": [
            scene("scene's own", "scene's own", ""),
            scene("physics step: 0.5 ms", "physics step", "0.5 ms", ratio=1.4, com_mm=0.2),
            scene("solver iterations: 1", "solver iterations", "1", walked=False, com_mm=5.0),
            scene("sensor noise", "sensor noise", "", against="scene's own", com_mm=0.9),
            scene("reference", "reference", "", com_mm=0.0, ratio=2.0),
        ],
        "verdicts": [{"scene": "flat", "robot": "h1", "knob": "step", "stays": False, "reason": "0.5 ms < 1 ms"}],
    },
    "papers": {
        "experiments": [
            {"what": "a slab", "robot": "h1", "source": "T 4", "printed": {"impact on the slab": 1100.0},
             "completed": True, "printed_fell": True, "ours": {"impact on the slab": 60.0}, "fell": False},
            {"what": "a beam", "robot": "h1", "source": "T 5", "printed": {"steps": 50.0}, "completed": False,
             "printed_fell": False, "ours": {"steps": None}, "fell": True},
        ]
    },
}  # fmt: skip


def test_the_page_is_whole_and_needs_no_network():
    text = bench_page(RESULT)
    addresses = addresses_of(text)
    assert {a for a in addresses if not a.startswith("#")} == {"data:,"}
    assert "url(" not in text
    assert "@import" not in text


def test_what_is_not_good_is_reported():
    text = bench_page(RESULT)
    for words in (
        "tick &lt;: 50.0 us, wanted at most 40",
        "0.80 ×",
        "a better one",
        "Not walked with: flat, h1: solver",
        "<b>no</b>",
    ):
        assert words in text
    assert "1100\u00a0N, fell" in text
    assert "–, fell" in text
    assert "1 of 2" in text
    assert "<b>guess" not in text


def test_an_approximation_is_no_rival_and_the_fastest_of_others_is():
    row = re.search(r'<th scope="row">hull \+ area, 20</th>(.*?)</tr>', bench_page(RESULT))
    assert "shapely, ready" in row[1]
    assert "40 ×" in row[1]


def test_parts_that_were_not_measured_are_left_out():
    text = bench_page({"made": RESULT["made"]})
    assert "<section" not in text
    for part in ("kernels", "contact", "skip", "scenes", "papers"):
        assert bench_page({part: RESULT[part]}).count("<section") == 1


def test_figures_are_embedded_where_a_part_has_one():
    figure = (Path(__file__).resolve().parents[4] / "benchmarks" / "kernels.png").read_bytes()
    text = bench_page(RESULT, {"kernels": figure})
    assert text.count("<figure") == 1
    assert text.index('id="kernels"') < text.index("<figure") < text.index('id="papers"')


@pytest.mark.long
@pytest.mark.parametrize(("dark", "width"), [(False, 390), (True, 390), (False, 1100), (True, 1100)])
def test_the_page_can_be_read_and_reached(dark, width, tmp_path):
    page = tmp_path / "bench.html"
    page.write_text(bench_page(RESULT), encoding="utf-8")
    seen = visit(page, READABLE, tmp_path, dark=dark, width=width)
    assert seen.console == []
    found = seen.found
    assert found["weak"] == found["unnamed"] == found["outline"] == found["axe"] == []
    assert found["wide"] <= 0
    assert found["texts"] > 50
    assert (sum(map(int, re.findall(r"\d+", found["background"])[:3])) < 200) == dark
