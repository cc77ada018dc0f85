"""The page in a real browser: it plays, can be read and reached, and asks for nothing."""

import json
import os
import re
from pathlib import Path

import numpy as np
import pytest

from plantar import InputError, Percept, Reading, laid_over
from plantar.viewer.page import view_text, write_page

from ...gait.analysis.browser import visit
from ...gait.analysis.test_report_in_browser import READABLE
from . import small_walk
from .small_walk import write_walk

READY = """
for (let i = 0; i < 500 && document.body.dataset.ready !== 'true'; i++) await new Promise(r => setTimeout(r, 20));
const byId = id => document.getElementById(id), space = document.querySelector('.space');
const drawn = async () => { for (let i = 0; i < 3; i++) await new Promise(requestAnimationFrame); };
"""

PLAY = (
    READY
    + """
const pictures = () => [...document.querySelectorAll('canvas')].map(c => c.toDataURL());
const press = key => space.dispatchEvent(new KeyboardEvent('keydown', {key: key, bubbles: true, cancelable: true}));
const now = () => Number(document.body.dataset.time), said = () => document.querySelector('.readout').textContent;
const first = pictures(), begun = said();
byId('time').value = '1.000';
byId('time').dispatchEvent(new Event('input'));
await drawn();
const middle = pictures(), half = said();
press('ArrowRight');
await drawn();
const stepped = now(), told = byId('live').textContent;
press('ArrowLeft');
press('5');
await drawn();
const below = pictures();
document.querySelectorAll('.log [data-time]')[1].click();
await drawn();
const jumped = now(), marked = document.querySelectorAll('.log li.now').length;
press('Home');
byId('robot').click();
await drawn();
const bare = pictures();
press('1');
await drawn();
const home = now();
press(' ');
const playing = byId('play').getAttribute('aria-pressed');
for (let i = 0; i < 200 && now() < 0.1; i++) await new Promise(requestAnimationFrame);
press(' ');
await drawn();
const pen = document.createElement('canvas').getContext('2d');
pen.drawImage(space, 0, 0, 300, 150);
return {trouble: byId('trouble').textContent, begun, half, stepped, told, jumped, marked, home, playing, played: now(),
  changed: [middle.map((p, i) => p !== first[i]), below[0] !== middle[0], bare[0] !== first[0]],
  asked: performance.getEntriesByType('resource').map(e => e.name), size: [space.width, space.height],
  colours: new Set(new Uint32Array(pen.getImageData(0, 0, 300, 150).data.buffer)).size};
"""
)


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    folder = tmp_path_factory.mktemp("view")
    write_page([write_walk(folder / "run.mcap")], folder / "view.html")
    return folder / "view.html"


@pytest.fixture(scope="module")
def both(tmp_path_factory):
    folder = tmp_path_factory.mktemp("both")
    runs = [write_walk(folder / f"{name}.mcap", drawn=name == "new") for name in ("new", "old")]
    write_page(runs, folder / "view.html")
    return folder / "view.html"


def test_the_page_plays_steps_jumps_and_asks_for_nothing(page, tmp_path):
    seen = visit(page, PLAY, tmp_path, webgl=True)
    found = seen.found
    assert found["trouble"] == ""
    assert found["changed"] == [[True, True, True], True, True]
    assert found["colours"] > 20
    assert (found["begun"], found["half"]) == ("left 400 N, right 0 N", "left 200 N, right 200 N")
    assert found["stepped"] == pytest.approx(1.02, abs=0.002)
    assert found["told"].startswith("1.02 seconds: left 196 N")
    assert (found["jumped"], found["marked"], found["home"]) == (1.5, 1, 0.0)
    assert found["playing"] == "true"
    assert 0.1 <= found["played"] < 2.0
    assert found["asked"] == []
    assert [line for line in seen.console if "GPU stall" not in line and "GL Driver" not in line] == []


def test_what_a_sole_perceives_is_listed_as_its_percept_has_it(page, tmp_path):
    script = (
        READY
        + """
byId('time').value = '0.700';
byId('time').dispatchEvent(new Event('input'));
await drawn();
const rows = document.querySelectorAll('.perceived tbody tr');
return [...rows].map(row => [...row.children].map(cell => cell.textContent));
"""
    )
    rows = visit(page, script, tmp_path, webgl=True).found
    for row in rows:
        layout = small_walk.soles()[row[0]]
        percept = Percept(layout, Reading(0.7, small_walk.forces(0.7)[row[0]]))
        assert 0 < percept.active.sum() < len(layout)
        x, y = 1e3 * percept.position_cop_in_sole
        moment = percept.wrench_in_sole[3:5]
        assert row[1] == f"{percept.reading.force.sum():.0f} N"
        assert row[2] == f"{percept.active.sum()} of {len(layout)}"
        for text, values, off in ((row[3], (x, y), 0.6), (row[4], moment, 0.2)):
            assert np.array(re.findall(r"-?[0-9.]+", text), dtype=float) == pytest.approx(values, abs=off)
        assert row[5] == f"{1e4 * percept.support_area:.0f} cm²"
        assert row[6] == f"{1e4 * percept.concave_outline_in_sole.area:.0f} cm²"
    assert [len(row) for row in rows] == [7, 7]


def test_one_scale_for_all_walks_ends_where_99_percent_of_the_loaded_readings_are_below(tmp_path, monkeypatch):
    usual = small_walk.forces

    def with_a_spike(time: float) -> dict[str, np.ndarray]:
        forces = usual(time)
        forces["left"] = np.where(
            (np.arange(len(forces["left"])) == 0) & (abs(time - 0.5) < 0.01), 5000.0, forces["left"]
        )
        return forces

    runs = [write_walk(tmp_path / "usual.mcap")]
    monkeypatch.setattr(small_walk, "forces", with_a_spike)
    runs.append(write_walk(tmp_path / "spike.mcap"))
    write_page(runs, tmp_path / "view.html")
    script = READY + "return [byId('full').textContent, byId('scale').textContent];"
    full, scale = visit(tmp_path / "view.html", script, tmp_path, webgl=True).found
    readings = [usual(t) for t in np.linspace(0.0, small_walk.SECONDS, 200)]
    loaded = np.concatenate([f for both in readings for f in both.values()])
    assert float(full.removesuffix(" N")) == pytest.approx(np.percentile(loaded[loaded > 1.0], 99.0), rel=0.1)
    assert "99 % of the loaded readings are below" in " ".join(scale.split())


def test_large_and_negative_forces_are_not_clipped(tmp_path, monkeypatch):
    heavy = {"left": np.full(8, 9000.0), "right": np.full(8, -2.0)}
    monkeypatch.setattr(small_walk, "forces", lambda time: heavy)
    write_page([write_walk(tmp_path / "run.mcap")], tmp_path / "view.html")
    found = visit(tmp_path / "view.html", READY + "return document.querySelector('.readout').textContent;", tmp_path)
    assert found.found == "left 72000 N, right -16 N"


def test_the_force_is_vertical_and_none_where_nothing_was_measured(tmp_path, monkeypatch):
    left, right = small_walk.soles().values()
    rocker = laid_over(left, lambda x, y: 0.5 * x**2 / 0.2)
    monkeypatch.setattr(small_walk, "soles", lambda: {"left": rocker, "right": right})
    monkeypatch.setattr(small_walk, "forces", lambda time: {"left": np.full(8, 100.0), "right": np.full(8, np.nan)})
    write_page([write_walk(tmp_path / "run.mcap")], tmp_path / "view.html")
    found = visit(tmp_path / "view.html", READY + "return document.querySelector('.readout').textContent;", tmp_path)
    assert found.found == f"left {100.0 * rocker.rotations[:, 2, 2].sum():.0f} N, right not measured"


@pytest.mark.long
@pytest.mark.parametrize("dark", [False, True])
@pytest.mark.parametrize("which", ["page", "both"])
def test_the_page_can_be_read_and_reached(which, dark, tmp_path, request):
    probe = READY + READABLE
    found = visit(request.getfixturevalue(which), probe, tmp_path, dark=dark, width=1000 if dark else 390, webgl=True)
    assert found.found["texts"] > 30
    assert found.found["weak"] == found.found["unnamed"] == found.found["outline"] == []
    assert found.found["wide"] <= 0


@pytest.mark.skipif("PLANTAR_AXE" not in os.environ, reason="PLANTAR_AXE does not name an axe.min.js")
@pytest.mark.parametrize("dark", [False, True])
@pytest.mark.parametrize("width", [390, 1000])
def test_axe_has_no_finding(both, tmp_path, dark, width):
    axe = Path(os.environ["PLANTAR_AXE"]).read_text(encoding="utf-8").replace("</script", "<\\/script")
    copy = tmp_path / "with_axe.html"
    copy.write_text(both.read_text(encoding="utf-8").replace("</main>", f"</main><script>{axe}</script>"))
    probe = READY + "return (await axe.run(document)).violations.map(v => [v.impact, v.id, v.nodes[0].html]);"
    found = visit(copy, probe, tmp_path, dark=dark, width=width, webgl=True).found
    assert found == [], json.dumps(found, indent=1)


def test_the_page_is_one_small_file_and_shows_text_as_text(page, both):
    text = page.read_text()
    assert len(text) < 1.2e6
    assert "foothold found &lt;b&gt;&amp;" in text
    outside = re.sub(r"<script.*?</script>", "", text, flags=re.DOTALL)
    assert re.findall(r"(?:src|href)=\"(?!data:)", outside) == []
    assert "url(" not in outside
    assert "(new)" in both.read_text()
    assert "(old)" in both.read_text()
    told = write_page([page.parent / "run.mcap"], page.parent / "again.html")
    assert told["walks"] == [{"name": "test, box, seed 4", "duration_s": 2.0, "log_lines": 2}]
    assert "test, box, seed 4: 2.0 s" in view_text(told)


def test_a_page_does_not_replace_its_recording(tmp_path, monkeypatch):
    run = write_walk(tmp_path / "run.mcap")
    before = run.read_bytes()
    monkeypatch.chdir(tmp_path)
    with pytest.raises(InputError, match=r"cannot write run\.mcap: it is what this is made of"):
        write_page(run, "run.mcap")
    assert run.read_bytes() == before


def test_three_recordings_are_too_many(tmp_path):
    with pytest.raises(InputError, match="allowed: 1, or 2"):
        write_page(["a.mcap"] * 3, tmp_path / "x.html")
