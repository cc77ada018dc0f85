"""The page of the comparison as text: what was measured, in tables, and what it means."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from plantar.layouts.layout import SoleLayout
from plantar.sim.contact_models.candidate import CANDIDATES, Contact
from plantar.sim.contact_models.comparison import INNER, MASS, ContactRow
from plantar.sim.contact_models.parameters import ParameterRow

__all__ = ["COP_LIMIT_MM", "EDGE_LIMIT_MM", "contact_page", "holds"]

COP_LIMIT_MM = 2.0
"""What is required of the chosen model: largest error of the centre of pressure in full-sole stance."""

EDGE_LIMIT_MM = 1.0
"""What is required of the chosen model: largest distance of the tip-over edge from the sole's edge."""


def holds(row: ContactRow) -> bool:
    """Whether a contact model keeps what is required of the simulator's own."""
    return row.cop_max_mm < COP_LIMIT_MM and max(abs(row.edge_x_mm), abs(row.edge_y_mm)) < EDGE_LIMIT_MM


def contact_page(layout: SoleLayout, rows: Sequence[ContactRow], parameters: Sequence[ParameterRow]) -> str:
    """The page.

    Args:
        layout: The sole that was measured.
        rows: Contact models, the chosen one first.
        parameters: Contact parameters.

    Returns:
        Markdown.
    """
    return _models(layout, rows) + _stance(rows) + _edges(rows) + _parameters(parameters)


def _models(layout: SoleLayout, rows: Sequence[ContactRow]) -> str:
    """What was measured, and which model was chosen."""
    size = 1e3 * (layout.outline.max(axis=0) - layout.outline.min(axis=0))
    chosen = rows[0]
    texts = {c.name: c.text for c in CANDIDATES}
    models = _table(
        ["model", "what it is", "contacts"],
        [[r.name, texts.get(r.name, ""), r.contacts] for r in rows],
    )
    return f"""# Contact models of a sole

Written by `plantar bench contact -o DIR`; the figures below are one run of it, times depend on the machine.

Rig: a free body of {MASS:g} kg on one sole of {size[0]:.0f} x {size[1]:.0f} mm with {len(layout)} taxels, physics at
1 kHz, pushed with known wrenches. The truth is MuJoCo's own contact wrench of the same step. Chosen: **{chosen.name}**
(largest CoP error {_text(chosen.cop_max_mm)} mm, required under {COP_LIMIT_MM:g}; tip-over edge
{_text(chosen.edge_x_mm)} and {_text(chosen.edge_y_mm)} mm from the true one, required within {EDGE_LIMIT_MM:g}:
{"holds" if holds(chosen) else "DOES NOT HOLD"}).

{models}

"""


def _stance(rows: Sequence[ContactRow]) -> str:
    chosen = rows[0]
    stance = _table(
        ["model", "CoP median mm", "CoP max mm", "fz max N", "tx, ty max N m", "step us", "read us", "a ms, ratio"],
        [
            [
                r.name,
                r.cop_median_mm,
                r.cop_max_mm,
                r.force_max_N,
                r.moment_max_Nm,
                r.step_us,
                r.read_us,
                r.millisecond_us / chosen.millisecond_us,
            ]
            for r in rows
        ],
    )
    return f"""## Full-sole stance

The load's centre of pressure goes over the inner {100 * INNER:.0f} % of the sole in both directions, with 200-844 N,
tangential loads up to 0.3 of that and a twist up to 5 N m. Errors are those of the wrench that the taxels report, each
at its own position. "A ms, ratio" is a physics step and a quarter of a reading (skin at 250 Hz) against the chosen.

{stance}

- The patches are fitted to the exact wrench, so their error is zero as far as the taxels' centres reach; what could go
  wrong is a load beyond that reach, a sole that tips elsewhere or a patch that is not the contact's (below).
- A penetration field cannot give the centre of pressure: the box rests on corners at +-a, whose springs answer an
  eccentric load with a tilt three times smaller than a foundation under the whole face would need (a^2 against
  a^2 / 3), so the tactile sensor scaled to fz alone shows a third of the way. Scaled to the whole wrench it is right.
- Spheres and prisms are physics of their own, with the forces shared by the solver: their error is the lever between
  a support point and its taxel's centre. The patches take the pressure as uniform within a cell; where it varies, as
  the seven spheres let it, cells of this size show the centre of pressure a few mm too far inside.

"""


def _edges(rows: Sequence[ContactRow]) -> str:
    edges = _table(
        [
            "model",
            "edge x mm",
            "edge y mm",
            "seen x mm",
            "seen y mm",
            "contact area",
            "cells' area",
            "wrong cells",
            "silent cells",
        ],
        [
            [
                r.name,
                r.edge_x_mm,
                r.edge_y_mm,
                r.seen_x_mm,
                r.seen_y_mm,
                r.beam_contact_ratio,
                r.beam_taxel_ratio,
                r.beam_wrong_cells,
                r.beam_silent_cells,
            ]
            for r in rows
        ],
    )
    return f"""## Tip-over edge and beams

Edge: the true CoP at which the sole tips, less the true edge (negative: topples early). Seen: what the taxels show
then; no taxel reports beyond its own centre, so this is the layout's reach and not the contact model's error. Beams of
12 and 6 cm across the sole at five offsets each: area of the hull of the contact points, and of the corners of the
active cells, over the true contact area (the latter counts every cell that an edge cuts as a whole: above 1 for a
right skin too); active cells that do not touch the beam; cells with a quarter of their area on it that stay silent.
"-": it toppled before, or did not tip over.

{edges}

- The box tips at its edge; one sphere a taxel topples at the outermost centres, several a little early.
- A tactile sample point at a cell's centre is all or nothing, so cells that a beam's edge cuts off-centre stay silent
  and the polygon of active cells is smaller; the patches load each cell by the area that is covered.

"""


def _parameters(parameters: Sequence[ParameterRow]) -> str:
    values = _table(
        ["parameters", "depth mm", "slip mm/s", "twist deg/s", "landing N", "rebounds", "ripple N", "step us"],
        [
            [
                p.name,
                p.penetration_mm,
                p.slip_mm_s,
                p.twist_deg_s,
                p.landing_N,
                p.rebounds,
                p.ripple_N,
                p.step_us,
            ]
            for p in parameters
        ],
    )
    best = Contact()
    impedance = " ".join(f"{v:g}" for v in best.impedance)
    return f"""## Contact parameters of the box

One change at a time. Depth under 844 N; slip under half the friction limit; twist under 5 N m at 422 N; landing: 3 kg
of foot under 40 kg on a servo of 2e5 N/m at 0.15 m/s, and how often it leaves the ground again in 0.3 s.

{values}

Recommended for a sole on stiff position servos, at 1 ms: `solref="{best.time_constant:g} {best.damping_ratio:g}"
solimp="{impedance}" condim="{best.condim}" gap="{best.gap:g}"`, cone {best.cone}, impratio {best.friction_ratio:g}.

- The landing peak is the leg's, not the contact's: it hardly moves. Harder contacts than these rebound more.
- Creep under a tangential load falls with impratio and with softness; with MuJoCo's defaults the sole drifts by
  millimetres a second. The elliptic cone at impratio {best.friction_ratio:g} costs no time.
- Four corners resist a twist by themselves: condim 4 changes nothing for a box.
- `gap` makes MuJoCo report corners that hover by micrometres under an eccentric load, so that the patch stays whole.
"""


def _table(head: Sequence[str], rows: Sequence[Sequence[Any]]) -> str:
    lines = ["| " + " | ".join(head) + " |", "|---|" + "---:|" * (len(head) - 1)]
    lines += ["| " + " | ".join(_text(v) for v in row) + " |" for row in rows]
    return "\n".join(lines)


def _text(value: Any) -> str:
    if not isinstance(value, float):
        return str(value)
    if not math.isfinite(value):
        return "-"
    return f"{value + 0.0:.0f}" if abs(value) >= 100.0 else f"{round(value, 2) + 0.0:.2f}"
