"""Ways to simulate a sole's contact and its taxels: `python benchmarks/contact_models.py [LAYOUT] [-o DIR]`.

Writes contact_models.md, contact_models.png, contact.csv and contact_parameters.csv. Exit code 1 if the chosen model is
off by more than 2 mm in the centre of pressure or 1 mm in the tip-over edge.
"""

import argparse
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from contact_comparison import INNER, ContactRow, compare_contact_models
from contact_parameters import ParameterRow, study_contact_parameters
from contact_soles import CANDIDATES, MASS, Contact

from plantar.bench.tables import Mark, draw_errors, made_on, markdown_table, plain_row, write_rows
from plantar.common.atomic import write_text
from plantar.common.console.progress import part_of
from plantar.layouts.layout import SoleLayout
from plantar.layouts.layout_file import read_layout
from plantar.layouts.tiling import hex_layout
from plantar.plotting import COLOURS, new_figure, save_figure

COP_LIMIT_MM = 2.0
EDGE_LIMIT_MM = 1.0
"""What is required of the chosen model: largest error of the centre of pressure in full-sole stance, and largest
distance of the tip-over edge from the sole's edge."""

# The sole that is measured where none is given: 250 x 155 mm, in m
_SOLE = ((-0.125, -0.0775), (0.125, -0.0775), (0.125, 0.0775), (-0.125, 0.0775))

_LEAST = 1e-2
_MOST = 150.0
"""Errors in mm that are drawn: smaller and larger ones are drawn there."""


def holds(row: ContactRow) -> bool:
    """Whether a contact model meets the requirements."""
    return row.cop_max_mm < COP_LIMIT_MM and max(abs(row.edge_x_mm), abs(row.edge_y_mm)) < EDGE_LIMIT_MM


def measure_contact(folder: Path, layout: Path | None, progress: Callable[[float, str], None]) -> dict[str, Any]:
    """Compare contact models and parameters, and write the report into an existing `folder`.

    `layout` is a file, None 250 x 155 mm with taxels of 691 mm^2; `progress` gets fraction and text. Returns the
    chosen model's name, whether it meets the requirements, rows of models and parameters, file names; a LayoutError if
    the file is invalid.
    """
    sole = hex_layout(_SOLE) if layout is None else read_layout(layout)
    rows = compare_contact_models(sole, progress=part_of(progress, 0.0, 0.9))
    parameters = study_contact_parameters(sole, part_of(progress, 0.9, 0.1))
    return {
        "chosen": rows[0].name,
        "holds": holds(rows[0]),
        "models": [plain_row(r) for r in rows],
        "parameters": [asdict(p) for p in parameters],
        "files": write_contact_report(folder, sole, rows, parameters),
    }


def contact_text(result: Mapping[str, Any]) -> str:
    """The comparison's main figures."""
    lines = [f"{'contact model':24}{'CoP max mm':>12}{'edge mm':>10}{'step us':>10}{'read us':>10}"]
    for row in result["models"]:
        x = row["edge_x_mm"]
        y = row["edge_y_mm"]
        edge = "-" if None in (x, y) else f"{round(x if abs(x) >= abs(y) else y, 2) + 0.0:.2f}"
        cop = "-" if row["cop_max_mm"] is None else f"{row['cop_max_mm']:.2f}"
        lines.append(f"{row['name']:24}{cop:>12}{edge:>10}{row['step_us']:>10.1f}{row['read_us']:>10.1f}")
    lines.append(f"chosen: {result['chosen']}, {'holds' if result['holds'] else 'DOES NOT HOLD'} what is required")
    return "\n".join(lines)


def write_contact_report(
    folder: Path, layout: SoleLayout, rows: Sequence[ContactRow], parameters: Sequence[ParameterRow]
) -> list[str]:
    """Write contact.csv, contact_parameters.csv, contact_models.md and contact_models.png into an existing `folder`.

    Returns their names; `rows` of models on `layout` have the chosen one first, then rows of `parameters`.
    """
    write_rows(folder / "contact.csv", [plain_row(r) for r in rows])
    write_rows(folder / "contact_parameters.csv", [asdict(r) for r in parameters])
    write_text(folder / "contact_models.md", _page(layout, rows, parameters))
    _draw(folder / "contact_models.png", rows)
    return ["contact.csv", "contact_parameters.csv", "contact_models.md", "contact_models.png"]


_HEAD = """# Contact models of a sole

![Error against run time](contact_models.png)

`python benchmarks/contact_models.py` writes this page ({made}). A free body of {mass:g} kg on one sole of
{length:.0f} x {width:.0f} mm with {taxels} taxels is pushed with known wrenches; the truth is MuJoCo's own contact
wrench of the same step. Chosen: **{chosen}**, which {holds}: largest error of the centre of pressure
under {cop:g} mm, tip-over edge within {edge:g} mm of the true one.

{models}

## Standing on the whole sole

The center of pressure is moved over the inner {inner:.0f} % of the sole with 200 to 844 N, tangential loads up to 0.3
of that and a twist up to 5 N m. The last column is a physics step and a quarter of a reading against the chosen
model.

{stance}

Springs under the corners of a box answer an eccentric load with a third of the tilt of a foundation under the whole
face, so a tactile sensor that is scaled to fz alone shows a third of the way. Spheres and prisms are off by the
distance from a support point to the middle of its taxel.

## Tip-over edge and beams

Edge: true center of pressure at which the sole tips, less the true edge; negative tips early. Seen: what the taxels
report then, which ends at the middle of the outermost taxels. Beams of 12 and 6 cm at five offsets: areas over the true
contact area, active cells that do not touch, and silent cells with a quarter of their area on the beam.

{edges}

## Contact parameters of the box

One change at a time. Depth under 844 N; slip under half the friction limit; twist under 5 N m at 422 N; landing: 3 kg
of foot under 40 kg on a servo of 2e5 N/m at 0.15 m/s, and how often it leaves the ground again within 0.3 s.

{parameters}

Recommended for a sole on stiff position servos at 1 ms: `{best}`, cone {cone}, impratio {ratio:g}. `gap` makes MuJoCo
list corners that hover by micrometres, so that the contact patch stays whole.
"""

_STANCE = {
    "cop_median_mm": "CoP median [mm]",
    "cop_max_mm": "CoP max [mm]",
    "force_max_N": "fz max [N]",
    "moment_max_Nm": "tx, ty max [N m]",
    "step_us": "step [us]",
    "read_us": "reading [us]",
}
_EDGES = {
    "edge_x_mm": "edge x [mm]",
    "edge_y_mm": "edge y [mm]",
    "seen_x_mm": "seen x [mm]",
    "seen_y_mm": "seen y [mm]",
    "beam_contact_ratio": "contact area",
    "beam_taxel_ratio": "cells' area",
    "beam_wrong_cells": "wrong cells",
    "beam_silent_cells": "silent cells",
}
_PARAMETERS = {
    "penetration_mm": "depth [mm]",
    "slip_mm_s": "slip [mm/s]",
    "twist_deg_s": "twist [deg/s]",
    "landing_N": "landing [N]",
    "rebounds": "rebounds",
    "ripple_N": "ripple [N]",
    "step_us": "step [us]",
}


def _page(layout: SoleLayout, rows: Sequence[ContactRow], parameters: Sequence[ParameterRow]) -> str:
    length, width = 1e3 * (layout.outline.max(axis=0) - layout.outline.min(axis=0))
    texts = {c.name: c.text for c in CANDIDATES}
    best = Contact()
    ratios = [r.millisecond_us / rows[0].millisecond_us for r in rows]
    stance = [[*cells, ratio] for cells, ratio in zip(_cells(rows, _STANCE), ratios, strict=True)]
    return _HEAD.format(
        made=made_on(),
        mass=MASS,
        length=length,
        width=width,
        taxels=len(layout),
        chosen=rows[0].name,
        holds="holds what is required" if holds(rows[0]) else "DOES NOT HOLD",
        cop=COP_LIMIT_MM,
        edge=EDGE_LIMIT_MM,
        inner=100 * INNER,
        models=markdown_table(
            ("model", "what it is", "contacts"), [(r.name, texts.get(r.name, ""), r.contacts) for r in rows]
        ),
        stance=markdown_table(("model", *_STANCE.values(), "a ms, ratio"), stance),
        edges=markdown_table(("model", *_EDGES.values()), _cells(rows, _EDGES)),
        parameters=markdown_table(("parameters", *_PARAMETERS.values()), _cells(parameters, _PARAMETERS)),
        best=best.geom_attributes(),
        cone=best.cone,
        ratio=best.friction_ratio,
    )


def _cells(rows: Sequence[Any], names: Mapping[str, str]) -> list[list[Any]]:
    return [[row.name, *(getattr(row, name) for name in names)] for row in rows]


def _draw(path: Path, rows: Sequence[ContactRow]) -> None:
    figure, axes = new_figure(11.0, 4.6, 1, 2)
    cop = [r.cop_max_mm for r in rows]
    edge = [max(abs(r.edge_x_mm), abs(r.edge_y_mm)) for r in rows]
    for axis, errors, limit, title in (
        (axes[0], cop, COP_LIMIT_MM, "largest CoP error in full-sole stance"),
        (axes[1], edge, EDGE_LIMIT_MM, "tip-over edge off the true edge"),
    ):
        marks = [
            Mark(row.millisecond_us, min(error, _MOST), f"{i}  {row.name}", i == 1, text=str(i))
            for i, (row, error) in enumerate(zip(rows, errors, strict=True), 1)
        ]
        draw_errors(axis, marks, (title, "time of a simulated ms: step + 1/4 reading [us]", "error [mm]"), _LEAST)
        axis.axhline(limit, ls="--", color=COLOURS["reference"], lw=1)
        axis.set(ylim=(0.6 * _LEAST, 200.0))
        axis.yaxis.set_major_formatter("{x:g}")
        axis.set_xticks([20, 50, 100, 200], ["20", "50", "100", "200"])
    axes[1].legend(
        loc="upper left", bbox_to_anchor=(1.02, 1.0), fontsize=8.5, title=f"under {_LEAST:g} mm: drawn there"
    )
    save_figure(figure, path)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("layout", nargs="?", type=Path, help="layout file of a sole, instead of 250 x 155 mm")
    parser.add_argument("-o", "--output", type=Path, default=Path(__file__).parent)
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    result = measure_contact(options.output, options.layout, lambda share, text: print(text, file=sys.stderr))
    print(contact_text(result))
    sys.exit(not result["holds"])


if __name__ == "__main__":
    main()
