"""The page of `plantar bench all`, for new readers."""

import html
import math
from collections.abc import Mapping, Sequence
from importlib.resources import files
from typing import Any, NamedTuple

from plantar.common.pages.page import Section, figure, number, page, row, table
from plantar.sim.bench.room_times import ROOMS

Row = Mapping[str, Any]

# Kernels that are shown first, in this order
_HEADLINES = (
    "hull + area",
    "concave outline",
    "walking tick",
    "closest point",
    "inner offset",
    "rectangle inside, axis-aligned",
    "rectangle in the outline",
    "hull + area of a recording",
)


def bench_page(result: Mapping[str, Any], figures: Mapping[str, bytes] | None = None) -> str:
    """Returns HTML without references to other files.

    `result` has "kernels", "contact", "skip", "scenes" and "papers", each optional; its "made" has date, version,
    machine and whether the run was quick. `figures` are PNG files by part.
    """
    parts = (  # of the page and of the result, what of it has to be there, name, and content
        ("kernels", "kernels", "results", "Kernels compared with libraries", _kernels),
        ("papers", "papers", "experiments", "Walks compared with the papers", _papers),
        ("contact", "contact", "models", "Contact models", _contact),
        ("scenes", "scenes", "rows", "Scenes: run time against error", _scenes),
        ("time", "skip", "scenes", "Where the time goes", _time),
    )
    sections = []
    for key, part, needed, name, content in parts:
        found = result.get(part, {})
        drawn = (figures or {}).get(key)
        if found.get(needed):
            sections.append(Section(key, name, content(found) + ("" if drawn is None else figure(drawn, name))))
    style = files("plantar.sim.bench.page").joinpath("bench.css").read_text(encoding="utf-8")
    return page("Plantar, measured", _lead(result), sections, style=style)


def _lead(result: Mapping[str, Any]) -> str:
    made = result.get("made", {})
    quick = ", a quick run" if made.get("quick") else ""
    about = (
        '<p class="lead">Skin under a robot\'s feet: what reading it costs, how right that is, and what walking on it '
        "comes to in simulation.</p>"
    )
    tiles = "".join(f"<div><dt>{name}</dt><dd>{figure}</dd></div>" for name, figure in _tiles(result))
    about_run = ", ".join(html.escape(str(made[key])) for key in ("version", "date", "machine") if made.get(key))
    note = f"{about_run}{quick}. Times belong to one machine and what else it did: trust ratios."
    return f'{about}<dl class="tiles">{tiles}</dl><p class="about">{note}</p>'


def _tiles(result: Mapping[str, Any]) -> list[tuple[str, str]]:
    tiles = []
    rivals = {r.kernel: r for r in _fastest(result.get("kernels", {}).get("results", ()))}
    for kernel, name in (("hull + area", "Support polygon"), ("walking tick", "All a walking tick asks of both feet")):
        if kernel in rivals:
            one = rivals[kernel]
            tiles.append((name, f"{number(one.ratio, 2)} × faster than {html.escape(one.rival.partition(',')[0])}"))
    targets = result.get("kernels", {}).get("targets", ())
    if targets:
        tiles.append(("Wanted of the kernels, and met", f"{sum(t['met'] for t in targets)} of {len(targets)}"))
    skip = result.get("skip", {}).get("scenes", ())
    if skip:
        factors = [f"{x:.1f}" for x in sorted(r["sim_s"] / r["run_s"] for r in skip)]
        between = factors[0] if factors[0] == factors[-1] else f"{factors[0]} to {factors[-1]}"
        tiles.append(("A whole walk, one core", f"{between} × real time"))
    papers = result.get("papers", {}).get("experiments", ())
    if papers:
        tiles.append(("The papers' experiments, walked", f"{sum(r['completed'] for r in papers)} of {len(papers)}"))
    return tiles


class _Headline(NamedTuple):
    """A kernel and the fastest other route; times in us."""

    kernel: str
    size: str
    ours: float
    ratio: float
    rival: str
    error: float | None
    rival_error: float | None


def _fastest(results: Sequence[Row]) -> list[_Headline]:
    found = []
    for kernel in dict.fromkeys(r["kernel"] for r in results):
        rows = []
        for size in dict.fromkeys(r["size"] for r in results if r["kernel"] == kernel):
            here = [r for r in results if (r["kernel"], r["size"]) == (kernel, size) and not r["approximate"]]
            ours = next((r for r in here if r["ours"]), None)
            odd = ("copy", "float32")  # moves memory alone, or is less exact
            rivals = [r for r in here if not r["ours"] and not any(word in r["route"] for word in odd)]
            if ours is not None and rivals:
                rival = min(rivals, key=lambda r: r["ratio"])
                figures = (ours["median_us"], rival["ratio"], rival["route"], ours["error"], rival["error"])
                rows.append(_Headline(kernel, size, *figures))
        if rows:
            found.append(min(rows, key=lambda r: r.ratio))
    order = {kernel: i for i, kernel in enumerate(_HEADLINES)}
    return sorted(found, key=lambda r: order.get(r.kernel, len(order)))


def _kernels(found: Mapping[str, Any]) -> str:
    fastest = _fastest(found["results"])
    longest = max(r.ratio for r in fastest)
    lines = [
        _bars_row(
            f"{html.escape(r.kernel)}, {html.escape(r.size)}",
            [f"{number(r.ratio, 2)} ×", number(r.ours), html.escape(r.rival), _error(r.error), _error(r.rival_error)],
            [(abs(math.log(r.ratio)) / math.log(max(longest, 1.1)), "ours" if r.ratio >= 1.0 else "other")],
        )
        for r in fastest
    ]
    head = ("kernel, size", "faster by", "ours, µs", "fastest other way", "our error", "its error", "as a bar")
    parts = [
        "<p>Each kernel and the fastest other way to compute the same (a library, numpy or plain Python), at the "
        "size where that does best. Bars are logarithmic; blue where ours is faster. Errors are relative, against "
        "exact integers or fractions.</p>",
        table(
            "kernels compared with libraries",
            "Time of a call, median; size: active taxels, or frames and taxels",
            head,
            lines,
            ("fastest other way", "as a bar"),
        ),
    ]
    missed = [t for t in found.get("targets", ()) if not t["met"]]
    if missed:
        items = "".join(
            f"<li>{html.escape(t['what'])}: {number(t['figure'])} {html.escape(t['unit'])}, wanted "
            f"{'at least' if t['at_least'] else 'at most'} {t['wanted']:g} ({html.escape(str(t['where']))})</li>"
            for t in missed
        )
        parts.append(f"<h3>Wanted and not met</h3><ul>{items}</ul>")
    return "".join(parts)


def _error(value: float | None) -> str:
    if value is None:
        return "–"
    return "0" if value == 0.0 else f"{value:.0e}"


def _bars_row(name: str, cells: Sequence[str], bars: Sequence[tuple[float, str]]) -> str:
    drawn = "".join(
        f'<span class="bar {kind}" style="width:{100 * min(max(share, 0.005), 1.0):.1f}%" aria-hidden="true"></span>'
        for share, kind in bars
    )
    return row(name, cells).replace("</tr>", f'<td class="bars">{drawn}</td></tr>')


_UNITS = {"steps": "", "largest difference": "\u00a0mm"}


def _papers(found: Mapping[str, Any]) -> str:
    lines = []
    for one in found["experiments"]:
        for name, printed in one["printed"].items():
            ours = one["ours"][name]
            unit = _UNITS.get(name, "\u00a0N")
            most = max(printed, ours or 0.0) or 1.0
            lost = "fell" if one["fell"] else "" if one["completed"] else "not completed"
            ends = ["fell" if one["printed_fell"] else "", lost]
            figures = [
                f"{'–' if value is None else (f'{value:.0f}' if value % 1 == 0 else number(value)) + unit}"
                f"{f', {end}' if end else ''}"
                for value, end in zip((printed, ours), ends, strict=True)
            ]
            cells = [*figures, html.escape(one["source"].replace(" ", "\u00a0"))]
            bars = [(printed / most, "other"), ((ours or 0.0) / most, "ours")]
            lines.append(_bars_row(html.escape(f"{one['what']}, {one['robot']}: {name}"), cells, bars))
    head = ("experiment", "paper", "here", "where", "paper, here")
    return (
        "<p>The papers' experiments, each run once here on a seed that nothing was tuned on. The papers' figures are "
        "of real robots, measured by their ankles; ours are of a simulation, and the true ground forces within 50 ms "
        "of a touchdown. They show that the same is done and what comes out, not that a simulated robot is better than "
        "a real one. Counts over 30 seeds are in the project's benchmarks folder.</p>"
        + table("walks compared with the papers", "T: the thesis on plantar robot skin", head, lines, head[3:])
    )


def _contact(found: Mapping[str, Any]) -> str:
    return (
        "<p>Ways to simulate a sole and what its taxels measure, compared with the simulator's own contact wrench. "
        f"Chosen: <b>{html.escape(found['chosen'])}</b>.</p>"
    )


def _scenes(found: Mapping[str, Any]) -> str:
    parts = [
        "<p>The same walk, computed more finely or more coarsely, or with another skin. Error: distance of the true "
        "center of mass from that of a fine reference (root mean square, without sensor noise). Errors below the "
        "dashed line are smaller than what sensor noise does to the walk.</p>"
    ]
    fallen = [f"{r['scene']}, {r['robot']}: {r['setting']}" for r in found["rows"] if not r["walked"]]
    if fallen:
        parts.append(f"<p>Not walked with: {html.escape('; '.join(fallen))}.</p>")
    lines = [
        row(
            html.escape(f"{v['scene']}, {v['robot']}: {v['knob']}"),
            ["kept" if v["stays"] else "<b>a better one</b>", html.escape(v["reason"])],
        )
        for v in found.get("verdicts", ())
    ]
    if lines:
        head = ("scene and knob", "default", "reason")
        parts.append(table("defaults", "The scenes' own settings, judged", head, lines, head[1:]))
    return "".join(parts)


def _time(found: Mapping[str, Any]) -> str:
    lines = []
    for r in found["scenes"]:
        factor = f"{r['sim_s'] / r['run_s']:.1f} ×"
        most = sorted(((share, room) for room, share in r["shares"].items() if room in ROOMS), reverse=True)[:4]
        largest = ", ".join(f"{html.escape(room)} {100 * share:.0f} %" for share, room in most)
        same = "yes" if r["same_motion"] else "<b>no</b>"
        cells = [factor, f"{r['factor']:.1f}", f"{r['saved']:.1f} ×", same, largest]
        lines.append(row(html.escape(f"{r['scene']}, {r['robot']}"), cells))
    head = ("scene", "real time", "all but physics, over physics", "saved by skipping", "same motion", "largest parts")
    return (
        "<p>What a run costs on one core. A scene computes what it needs; “saved” is how much longer all but the "
        "physics takes when everything is computed, with the same motion to the last bit.</p>"
        + table("time of the scenes", "CPU time, medians", head, lines, head[4:])
    )
