"""The page of a stream in a browser: it draws what comes, light and dark, wide and narrow, and axe finds nothing."""

import json

import numpy as np
import pytest

from plantar import Reading, hex_layout, mirrored
from plantar.viewer.live_page import _page
from plantar.viewer.live_state import LiveState
from tests.gait.analysis.browser import visit

LEFT = hex_layout([[-0.10, -0.05], [0.14, -0.05], [0.14, 0.05], [-0.10, 0.05]], side="left")
SOLES = {"left": LEFT, "right": mirrored(LEFT)}

PROBE = """
await new Promise(done => setTimeout(done, 1500));
const found = window.axe ? (await axe.run()).violations.map(v => v.id + ': ' + v.nodes[0].html.slice(0, 100)) : [];
const canvas = document.getElementById('soles'), box = canvas.getBoundingClientRect();
const place = {clientX: box.left + box.width / 4, clientY: box.top + box.height / 2, bubbles: true};
canvas.dispatchEvent(new MouseEvent('click', place));
const drawn = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
const text = id => document.getElementById(id).textContent;
const limit = document.getElementById('limit');
limit.value = '100';
await new Promise(done => setTimeout(done, 300));
return {axe: found, wide: document.documentElement.scrollWidth, inner: innerWidth, taxel: text('taxel'),
  alarm: text('alarm'), rows: document.getElementById('measures').rows.length, ready: document.body.dataset.ready,
  colours: new Set(drawn).size};
"""


@pytest.mark.long
@pytest.mark.parametrize(("dark", "width"), [(False, 1200), (True, 390)])
def test_it_draws_what_comes_and_axe_finds_nothing(tmp_path, dark, width):
    state = LiveState(SOLES)
    states = []
    for k in range(60):
        for side, sole in SOLES.items():
            state.take(side, Reading(k / 60.0, np.linspace(0.0, 8.0, len(sole)) * (2.0 + np.sin(k / 9.0))))
        states.append({**state.as_dict(), "status": "1.0 s, faults: 0", "recording": True, "arrived": 0})
    source = (
        "<script>window.EventSource = class { addEventListener(name, take) { if (name !== 'message') return; let k = 0;"
        f"const states = {json.dumps(states)};"
        "setInterval(() => take({data: JSON.stringify(states[k++ % states.length])}), 16); } };</script>"
    )
    page = tmp_path / "live.html"
    text = _page(SOLES, "Live: test", "token", "N").decode()
    page.write_text(
        text.replace("connect-src 'self'", "connect-src 'none'", 1).replace("</head>", source + "</head>", 1)
    )
    seen = visit(page, PROBE, tmp_path, dark=dark, width=width)
    assert seen.console == []
    assert seen.found["axe"] == []
    assert seen.found["wide"] <= seen.found["inner"]
    assert seen.found["taxel"].startswith("Taxel ")
    assert seen.found["alarm"] == "More than 100 N on the left and the right sole"
    assert seen.found["rows"] >= 5
    assert seen.found["ready"] == "true"
    assert seen.found["colours"] > 20
