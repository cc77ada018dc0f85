"""Heading of a report: subject, device, file and software."""

from __future__ import annotations

import html
from collections.abc import Iterable, Mapping
from typing import Any

from plantar import __version__
from plantar.gravity import GRAVITY
from plantar.pages.page import number

__all__ = ["facts_of", "facts_of_image"]


def facts_of(metrics: Mapping[str, Any], file: str) -> str:
    """Returns the heading of a recording's report as HTML, from its metrics and the name of its file."""
    robot = metrics["kind"] == "robot"
    length = metrics["subject"]["foot_length_m"]
    facts = [
        ("Robot" if robot else "Participant", _name(metrics)),
        ("Body mass", _mass(metrics)),
        ("Foot length", "" if length is None else f"{1e3 * length:.0f} mm"),
        ("Device", _device(metrics["device"])),
        ("Size", _size(metrics["device"]["feet"])),
        ("Recorded", f"{metrics['duration_s']:.4g} s, {metrics['frames']} frames at {metrics['rate_hz']:.6g} Hz"),
        ("Values", "raw counts: nothing says what force they are" if metrics.get("raw") else ""),
        ("File", file),
        ("Analysed by", f"Plantar {__version__}"),
    ]
    return _listed(facts)


def facts_of_image(metrics: Mapping[str, Any], file: str) -> str:
    """Returns the heading of a footprint image's report as HTML, from its metrics and the name of its file."""
    width, height = metrics["size_px"]
    scale = "" if metrics["mm_per_pixel"] is None else f", {metrics['mm_per_pixel']:.4g} mm a pixel"
    facts = [
        ("Participant", _name(metrics)),
        ("Image", f"{width} x {height} pixels{scale}"),
        ("File", file),
        ("Analysed by", f"Plantar {__version__}"),
    ]
    return _listed(facts)


def _listed(facts: Iterable[tuple[str, str]]) -> str:
    rows = "".join(f"<div><dt>{name}</dt><dd>{html.escape(text)}</dd></div>" for name, text in facts if text)
    return f'<dl class="facts">{rows}</dl>'


def _name(metrics: Mapping[str, Any]) -> str:
    return str(metrics["subject"]["name"]) or "not stated"


def _mass(metrics: Mapping[str, Any]) -> str:
    """The stated mass and that which the forces imply."""
    stated, implied = metrics["subject"]["mass_kg"], metrics["gait"].get("implied_weight_N")
    parts = [] if stated is None else [f"{number(stated)} kg"]
    if implied is not None:
        parts.append(f"the forces imply {number(implied / GRAVITY)} kg")
    return "; ".join(parts) if stated is not None or not parts else f"not stated; {parts[0]}"


def _device(device: Mapping[str, Any]) -> str:
    return ", ".join(str(part) for part in (device["name"], device["sensor"]) if part)


def _size(feet: Mapping[str, Mapping[str, Any]]) -> str:
    """Extent, cells and layout of each foot's sole; listed once where both are the same."""
    said = {
        side: f"{1e3 * foot['length_m']:.0f} x {1e3 * foot['width_m']:.0f} mm, {foot['cells']} cells ({foot['layout']})"
        for side, foot in feet.items()
    }
    if len(set(said.values())) <= 1:
        return next(iter(said.values()), "")
    return "; ".join(f"{side}: {text}" for side, text in said.items())
