"""The report in a real browser: it opens, its player moves, and what it shows can be read and reached."""

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from plantar import write_layout
from plantar.formats.nominal_insole import nominal_insole
from plantar.gait.analysis.analyse import analyse_recording
from plantar.gait.analysis.compare import compare_recordings

from .browser import AXE, axe_script, visit
from .printing import PrintedImage, printed, printed_images
from .walks import made_walk

pytestmark = pytest.mark.drawn

WAIT = """
const player = document.getElementById('player');
for (let i = 0; i < 200 && player && player.dataset.ready !== 'true'; i++) await new Promise(r => setTimeout(r, 20));
const $ = id => document.getElementById(id);
const said = () => $('player-readout').textContent;
const typed = key => new KeyboardEvent('keydown', {key: key, bubbles: true, cancelable: true});
const press = (target, key) => target.dispatchEvent(typed(key));
"""

PLAY = (
    WAIT
    + """
const canvas = $('player-canvas'), slider = $('player-frame');
const pixels = () => canvas.toDataURL();
const first = said(), shown = pixels(), blank = document.createElement('canvas');
blank.width = canvas.width;
blank.height = canvas.height;
slider.value = String(Math.round(Number(slider.max) / 2));
slider.dispatchEvent(new Event('input'));
const middle = said(), later = pixels();
canvas.focus();
press(canvas, 'ArrowRight');
const stepped = said(), live = $('player-live').textContent;
press(canvas, 'ArrowLeft');
const back = said();
$('player-next').click();
const event = said();
const from = Number(slider.value);
press(canvas, ' ');
const playing = $('player-play').getAttribute('aria-pressed');
for (let i = 0; i < 100 && Number(slider.value) < from + 20; i++) await new Promise(requestAnimationFrame);
const to = Number(slider.value);
$('player-play').click();
return {ready: player.dataset.ready, frames: Number(slider.max) + 1, first, middle, stepped, live, back, event, from,
  to, playing, paused: $('player-play').getAttribute('aria-pressed'), valuetext: slider.getAttribute('aria-valuetext'),
  drawn: shown !== blank.toDataURL(), moved: shown !== later, last: said(),
  enabled: [...player.querySelectorAll('button, input, select')].every(c => !c.disabled)};
"""
)

READABLE = (
    WAIT
    + """
const parse = c => { const v = c.match(/[\\d.]+/g).map(Number);
  return {r: v[0], g: v[1], b: v[2], a: v.length > 3 ? v[3] : 1}; };
const light = c => { const f = v => (v /= 255) <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4;
  return 0.2126 * f(c.r) + 0.7152 * f(c.g) + 0.0722 * f(c.b); };
const behind = e => { for (let n = e; n; n = n.parentElement) {
    const c = parse(getComputedStyle(n).backgroundColor);
    if (c.a) return c;
  }
  return {r: 255, g: 255, b: 255}; };
const weak = [];
let texts = 0;
for (const e of document.body.querySelectorAll('*')) {
  const own = [...e.childNodes].some(n => n.nodeType === 3 && n.textContent.trim());
  if (!own || ['SCRIPT', 'STYLE', 'NOSCRIPT', 'PRE', 'OPTION'].includes(e.tagName)) continue;
  texts++;
  const a = light(parse(getComputedStyle(e).color)), b = light(behind(e));
  const ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
  if (ratio < 4.5) weak.push(e.tagName + ' ' + e.textContent.slice(0, 30) + ' ' + ratio.toFixed(2));
}
const named = e => (e.getAttribute('aria-label') || e.textContent || '').trim() ||
  (e.id && document.querySelector('label[for="' + e.id + '"]') ? 'label' : '');
const outline = [];
// A page that has just been opened may not have the focus yet, and then no element shows it.
for (let i = 0; i < 200 && !document.hasFocus(); i++) {
  window.focus();
  await new Promise(r => setTimeout(r, 20));
}
for (const e of document.querySelectorAll('a, button, input, select, [tabindex="0"]')) {
  e.focus({focusVisible: true});
  if (document.activeElement !== e || getComputedStyle(e).outlineStyle === 'none') outline.push(e.tagName + ' ' + e.id);
}
const cut = [...document.querySelectorAll('caption span, h1, h2, p, li, dd')].filter(e =>
  e.getBoundingClientRect().right > document.documentElement.clientWidth + 1).map(e => e.textContent.slice(0, 40));
const wide = document.documentElement.scrollWidth - document.documentElement.clientWidth;
const audit = typeof axe === 'undefined' ? [] : (await axe.run(document, {resultTypes: ['violations']})).violations;
return {weak, texts, wide, cut, outline, axe: audit.map(v => [v.impact, v.id, v.nodes[0].html]),
  background: getComputedStyle(document.body).backgroundColor,
  unnamed: [...document.querySelectorAll('a, button, input, select, [role]:not([role=alert]:empty)')]
    .filter(e => !named(e)).map(e => e.id)};
"""
)


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    """The report of a walk of 60 s in two insoles of 99 cells at 100 Hz."""
    folder = tmp_path_factory.mktemp("report")
    write_layout(nominal_insole("x", "left"), folder / "layout.json")
    walk_in(folder / "walk.npz", strides=54)
    analyse_recording(folder / "walk.npz", folder / "out", layout=folder / "layout.json")
    return folder / "out" / "report.html"


def walk_in(path: Path, strides: int, gain: float = 1.0) -> None:
    """Write the forces of a walk of 1.1 s a stride in both insoles."""
    recording = made_walk(strides=strides, noise=0.1).recording
    forces = {side: gain * foot.force for side, foot in recording.feet.items()}
    np.savez(path, time=recording.time, unit="N", **forces)


def test_the_player_moves_by_mouse_and_keyboard_without_errors(report, tmp_path):
    assert report.stat().st_size < 3_000_000
    seen = visit(report, PLAY, tmp_path)
    found: dict[str, Any] = seen.found
    assert seen.console == []
    assert found["ready"] == "true"
    assert found["enabled"]
    assert found["frames"] > 1000
    assert found["drawn"]
    assert found["moved"]
    assert found["middle"] != found["first"]
    assert found["stepped"] != found["middle"] == found["back"]
    assert found["live"] == found["stepped"]
    assert found["event"] != found["back"]
    assert found["to"] > found["from"] + 10
    assert (found["playing"], found["paused"]) == ("true", "false")
    assert found["valuetext"] == found["last"]
    assert re.fullmatch(r"[\d.]+ s; left: \d+ N, \d+ cells loaded; right: \d+ N, \d+ cells loaded", found["first"])


@pytest.mark.long
def test_the_page_is_ready_within_2_seconds(report, tmp_path):
    """From navigation to the first frame in the page's own time; the browser's start does not count."""
    probe = WAIT + "return {at: performance.now(), ready: player.dataset.ready};"
    best = min(visit(report, probe, tmp_path).found["at"] for _ in range(2))
    assert best < 2000.0


@pytest.mark.parametrize("dark", [False, pytest.param(True, marks=pytest.mark.long)])
def test_everything_can_be_read_and_reached(report, tmp_path, dark):
    found = visit(report, READABLE, tmp_path, dark=dark, width=1000 if dark else 390).found  # a telephone's width
    assert found["texts"] > 100
    assert found["weak"] == []
    assert found["unnamed"] == []
    assert found["outline"] == []
    assert found["axe"] == []
    assert found["wide"] <= 0
    assert found["cut"] == []
    assert found["background"] == ("rgb(13, 17, 23)" if dark else "rgb(255, 255, 255)")


@pytest.mark.long
def test_the_comparison_opens_without_errors(tmp_path):
    paths = []
    for i, gain in enumerate((1.0, 1.2)):
        paths.append(tmp_path / f"{i}.npz")
        walk_in(paths[-1], strides=10, gain=gain)
    compare_recordings(*paths, tmp_path / "out")
    seen = visit(tmp_path / "out" / "report.html", READABLE, tmp_path)
    assert seen.console == []
    assert seen.found["weak"] == seen.found["unnamed"] == seen.found["axe"] == []


def test_axe_is_there():
    """The tests of pages run axe-core where it is; elsewhere this test says how to get it."""
    if not AXE.exists():
        pytest.skip(f"no axe-core at {AXE}: pages are not checked by it (sh tools/fetch-axe .venv/axe)")
    assert "axe.run" in axe_script()


def test_the_summary_is_one_sheet(report, tmp_path):
    page = report.with_name("summary.html")
    assert printed(page, tmp_path).count(b"/Type /Page\n") == 1
    images = printed_images(page, tmp_path)
    assert len(images) == 1
    assert (images[0].low >= 0.0).all()
    assert (images[0].high <= 1.0).all()


def test_no_figure_is_cut_in_print(report, tmp_path):
    """Every figure of the page lies whole on one sheet, none is left out, and each is large enough to be read."""
    images = printed_images(report, tmp_path)
    assert len(images) == report.read_text().count("<figure") >= 5
    assert whole(images)
    assert min(float((one.high - one.low)[1]) for one in images) > 0.15


def whole(images: list[PrintedImage]) -> bool:
    """Whether each image is on one sheet, within its margins."""
    inside = all((one.low > 0.02).all() and (one.high < 0.98).all() for one in images)
    return inside and len({one.name for one in images}) == len(images)


@pytest.mark.long
def test_a_figure_that_is_cut_is_noticed(report, tmp_path):
    """A figure higher than a sheet is cut, whatever the page says."""
    text = report.read_text()
    page = tmp_path / "cut.html"
    page.write_text(text.replace("</style>", "figure.wide img { height: 40cm; max-height: none; }</style>"))
    assert not whole(printed_images(page, tmp_path))
