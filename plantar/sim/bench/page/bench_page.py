"""The page of `plantar bench all`: what the benchmarks found, for somebody who has never seen the project."""

from __future__ import annotations

import html
import math
from collections.abc import Mapping, Sequence
from importlib.resources import files
from typing import Any, NamedTuple

from plantar.pages.page import Section, number, page, row, table
from plantar.sim.bench.page.charts import Point, bar, scatter
from plantar.sim.bench.room_times import ROOMS
from plantar.sim.bench.scenes.scene_row import NOISE
from plantar.sim.bench.scenes.scene_setting import OWN

__all__ = ["bench_page"]

Row = Mapping[str, Any]

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
"""Kernels that are shown first, in this order."""

_CHARTED = ("hull + area", "concave outline", "inner offset", "rectangle inside, axis-aligned", "circle inside")


def bench_page(result: Mapping[str, Any]) -> str:
    """The page.

    Args:
        result: What the parts of `plantar bench` gave, by name: "kernels", "contact", "skip", "scenes" and "papers",
            each of which may be missing; "made" has date, version, machine and whether the run was quick.

    Returns:
        HTML that refers to no other file and no network.
    """
    sections = [
        Section(key, name, content)
        for key, name, content in (
            ("kernels", "Kernels beside libraries", _kernels(result.get("kernels", {}))),
            ("papers", "Walks beside the papers", _papers(result.get("papers", {}))),
            ("contact", "Contact models", _contact(result.get("contact", {}))),
            ("scenes", "Scenes: run time against error", _scenes(result.get("scenes", {}))),
            ("time", "Where the time goes", _time(result.get("skip", {}))),
        )
        if content
    ]
    return page("Plantar, measured", _lead(result), sections, style=_style())


def _style() -> str:
    return files("plantar.sim.bench.page").joinpath("bench.css").read_text(encoding="utf-8")


def _lead(result: Mapping[str, Any]) -> str:
    made = result.get("made", {})
    quick = ", a quick run" if made.get("quick") else ""
    about = (
        '<p class="lead">Skin under a robot\'s feet: what reading it costs, how right that is, and what walking on it '
        "comes to in simulation.</p>"
    )
    tiles = "".join(f"<div><dt>{name}</dt><dd>{figure}</dd></div>" for name, figure in _tiles(result))
    told = ", ".join(html.escape(str(made[key])) for key in ("version", "date", "machine") if made.get(key))
    note = f"{told}{quick}. Times belong to one machine and what else it did: trust ratios."
    return f'{about}<dl class="tiles">{tiles}</dl><p class="about">{note}</p>'


def _tiles(result: Mapping[str, Any]) -> list[tuple[str, str]]:
    tiles = []
    rivals = {r.kernel: r for r in _fastest(result.get("kernels", {}).get("results", ()))}
    for kernel, name in (("hull + area", "Support polygon"), ("walking tick", "All a walking tick asks of both feet")):
        if kernel in rivals:
            one = rivals[kernel]
            tiles.append((name, f"{number(one.ratio, 2)} × faster than {html.escape(_short(one.rival))}"))
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
    """A kernel beside the fastest route of others, at the size where that does best; times in us."""

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
            rivals = [r for r in here if not r["ours"] and not r["route"].startswith("copy")]
            if ours is not None and rivals:
                rival = min(rivals, key=lambda r: r["ratio"])
                figures = (ours["median_us"], rival["ratio"], rival["route"], ours["error"], rival["error"])
                rows.append(_Headline(kernel, size, *figures))
        if rows:
            found.append(min(rows, key=lambda r: r.ratio))
    order = {kernel: i for i, kernel in enumerate(_HEADLINES)}
    return sorted(found, key=lambda r: order.get(r.kernel, len(order)))


def _short(route: str) -> str:
    return route.partition(",")[0]


def _kernels(told: Mapping[str, Any]) -> str:
    results = told.get("results", ())
    if not results:
        return ""
    fastest = _fastest(results)
    longest = max(r.ratio for r in fastest)
    lines = [
        _bars_row(
            f"{html.escape(r.kernel)}, {html.escape(r.size)}",
            [f"{number(r.ratio, 2)} ×", number(r.ours), html.escape(r.rival), _error(r.error), _error(r.rival_error)],
            [(_log_share(r.ratio, longest), "ours" if r.ratio >= 1.0 else "other")],
        )
        for r in fastest
    ]
    head = ("kernel, size", "faster by", "ours, µs", "fastest other way", "our error", "its error", "as a bar")
    parts = [
        "<p>Each kernel beside the fastest other way to compute the same (a library, numpy or plain Python), at the "
        "size where that does best. Bars are logarithmic; blue where ours is faster. Errors are relative, against "
        "exact integers or fractions.</p>",
        table(
            "kernels beside libraries",
            "Time of a call, median; size: active taxels, or frames and taxels",
            head,
            lines,
            ("fastest other way", "as a bar"),
        ),
    ]
    points = [
        Point(
            r["median_us"],
            max(r["error"], 1e-17),
            r["kernel"],
            f"{r['route']}, {r['size']}",
            r["ours"],
        )
        for r in results
        if r["kernel"] in _CHARTED and r["error"] is not None and r["size"] in ("20", "5", "51")
    ]
    label = "Kernels: time of a call against relative error; filled points are ours"
    chart = scatter(label, ("time of a call, µs", "relative error (0 is drawn at 1e-17)"), points)
    if chart:
        parts.append(
            "<h3>Run time against error</h3><p>Filled: ours. Hollow: others and approximations. Lower left is better."
            f"</p>{chart}"
        )
    missed = [t for t in told.get("targets", ()) if not t["met"]]
    if missed:
        items = "".join(
            f"<li>{html.escape(t['what'])}: {number(t['figure'])} {html.escape(t['unit'])}, wanted "
            f"{'at least' if t['at_least'] else 'at most'} {t['wanted']:g} ({html.escape(str(t['where']))})</li>"
            for t in missed
        )
        parts.append(f"<h3>Wanted and not met</h3><ul>{items}</ul>")
    return "".join(parts)


def _log_share(ratio: float, longest: float) -> float:

    return math.log(max(ratio, 1.0 / ratio)) / math.log(max(longest, 1.1))


def _error(value: float | None) -> str:
    if value is None:
        return "–"
    return "0" if value == 0.0 else f"{value:.0e}"


def _bars_row(name: str, cells: Sequence[str], bars: Sequence[tuple[float, str]]) -> str:
    """A row whose last cell has bars, one below the other."""
    drawn = "".join(bar(share, kind) for share, kind in bars)
    return row(name, cells).replace("</tr>", f'<td class="bars">{drawn}</td></tr>')


_UNITS = {"steps": "", "largest difference": "\u00a0mm"}


def _figure(value: float) -> str:
    return f"{value:.0f}" if value == round(value) else number(value)


def _papers(told: Mapping[str, Any]) -> str:
    rows = told.get("experiments", ())
    if not rows:
        return ""
    lines = []
    for one in rows:
        for name, printed in one["printed"].items():
            ours, unit = one["ours"][name], _UNITS.get(name, "\u00a0N")
            most = max(printed, ours or 0.0) or 1.0
            lost = "fell" if one["fell"] else "" if one["completed"] else "not completed"
            ends = ["fell" if one["printed_fell"] else "", lost]
            figures = [
                f"{'–' if value is None else _figure(value) + unit}{f', {end}' if end else ''}"
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
        + table("walks beside the papers", "T: the thesis on plantar robot skin", head, lines, head[3:])
    )


def _contact(told: Mapping[str, Any]) -> str:
    models = told.get("models", ())
    points = [
        Point(
            m["step_us"] + 0.25 * m["read_us"],
            max(m["cop_max_mm"], 1e-3),
            m["name"],
            m["name"],
            m["name"] == told["chosen"],
        )
        for m in models
        if m["cop_max_mm"] is not None
    ]
    label = "Contact models of a sole: cost of a simulated millisecond against error of the centre of pressure"
    axes = ("physics step and a quarter of a skin reading, µs", "largest CoP error, mm (less: 0.001)")
    chart = scatter(label, axes, points)
    if not chart:
        return ""
    return (
        f"<p>Ways to simulate a sole and what its taxels feel, against the simulator's own contact wrench. Chosen: "
        f"<b>{html.escape(told['chosen'])}</b>, filled.</p>{chart}"
    )


def _scenes(told: Mapping[str, Any]) -> str:
    rows = told.get("rows", ())
    if not rows:
        return ""
    parts = [
        "<p>The same walk, computed more finely or more coarsely, or with another skin. Error: how far the true centre "
        "of mass is from that of a fine reference (root mean square, without sensor noise, as long as the walks stay "
        "together). The dashed line is what the sensors' noise does to the same walk: below it, an error is none that "
        "anybody would see.</p>"
    ]
    for scene, robot in dict.fromkeys((r["scene"], r["robot"]) for r in rows):
        mine = [r for r in rows if (r["scene"], r["robot"]) == (scene, robot) and r["com_mm"] is not None]
        noise = next((r["com_mm"] for r in mine if r["setting"] == NOISE), None)
        points = [
            Point(
                r["ratio"] or 0.0,
                r["com_mm"],
                "as it is" if r["setting"] == OWN.name else r["knob"],
                r["setting"],
                r["setting"] == OWN.name,
                r["value"],
            )
            for r in mine
            if r["setting"] not in (r["against"], NOISE)
            and r["walked"]
            and (r["setting"] != OWN.name or r["against"] == "reference")
        ]
        label = f"{scene}, {robot}: run time against error of the centre of mass"
        axes = ("CPU time, times that of the scene as it is", "error of the centre of mass, mm")
        chart = scatter(label, axes, points, None if noise is None else (noise, "sensor noise"))
        fallen = [r["setting"] for r in mine if not r["walked"]]
        lost = f"<p>Not walked with: {html.escape(', '.join(fallen))}.</p>" if fallen else ""
        parts.append(f"<h3>{html.escape(scene)}, {html.escape(robot)}</h3>{chart}{lost}")
    lines = [
        row(
            html.escape(f"{v['scene']}, {v['robot']}: {v['knob']}"),
            ["kept" if v["stays"] else "<b>a better one</b>", html.escape(v["reason"])],
        )
        for v in told.get("verdicts", ())
    ]
    if lines:
        head = ("scene and knob", "default", "reason")
        parts.append(table("defaults", "The scenes' own settings, judged", head, lines, head[1:]))
    return "".join(parts)


def _time(told: Mapping[str, Any]) -> str:
    rows = told.get("scenes", ())
    if not rows:
        return ""
    lines = []
    for r in rows:
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
