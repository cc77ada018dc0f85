"""Files of a shoe: STL, STEP, 3MF, layout, pad, papers, and their checks."""

import json
import math
import os
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.atomic import write_text
from plantar.common.optional_library import missing_libraries
from plantar.errors import InputError
from plantar.layouts.layout_file import layout_to_dict
from plantar.shoes.build import Progress, Shoe, ShoeBuild
from plantar.shoes.checks.check import Check, ShoeCheck, check_plan, check_shoe
from plantar.shoes.checks.printability import Weights
from plantar.shoes.foot.mesh_file import read_mesh
from plantar.shoes.geometry.outline import ring
from plantar.shoes.papers.assembly import assembly_page
from plantar.shoes.papers.bill import Part, bill_of_parts, bill_text
from plantar.shoes.papers.drawing import draw_shoe
from plantar.shoes.papers.mesh_files import NamedBody, write_3mf, write_assembly, write_stl
from plantar.shoes.papers.picture import draw_picture
from plantar.shoes.papers.step_assembly import assembly_parts
from plantar.shoes.papers.wiring_files import cells_dxf, wiring_text
from plantar.shoes.solid.pad import mould_surface, pad_surface, taxel_surfaces
from plantar.shoes.solid.step_model import StepSolid, is_valid, read_step, write_step
from plantar.shoes.units import to_m
from plantar.shoes.wiring.lists import harness_text, nets_text
from plantar.shoes.wiring.wired_shoe import WiredShoe, board_checks, wire_shoe, write_wired


@dataclass(frozen=True)
class ShoeReport:
    """Exported and measured, by side.

    Attributes:
        checks: Empty for layouts.
        files: Names in the folder.
        plan_checks: For layouts.
    """

    build: ShoeBuild
    checks: dict[str, ShoeCheck]
    files: tuple[str, ...]
    weights: dict[str, Weights] = field(default_factory=dict)
    bills: dict[str, list[Part]] = field(default_factory=dict)
    plan_checks: dict[str, tuple[Check, ...]] = field(default_factory=dict)

    @property
    def holds(self) -> bool:
        plans = all(c.holds for checks in self.plan_checks.values() for c in checks)
        return plans and all(c.holds for c in self.checks.values())

    def as_dict(self) -> dict[str, Any]:
        """Plain JSON values; a pair's top level holds the worse figure, `sides` each shoe's own."""
        build = self.build
        fit = self.build.fit
        first = self.build.shoes[0]
        out: dict[str, Any] = {
            "name": first.layout.name,
            "kind": build.kind,
            "taxels": len(first.layout),
            "whole_taxels": fit.whole,
            "cell_area_mm2": round(fit.cell_area, 3),
            "cell": None if fit.cell is None else fit.cell.as_dict() | {"kind": fit.cell.kind},
            "smallest_cell_share": round(float(fit.shares.min()), 4),
            "patches": len(first.plan.connectors),
            "covered_area_ratio": round(fit.covered_area_ratio, 4),
            "sole_area_mm2": round(build.foot.sole.area, 1),
            "contact_area_mm2": round(first.plan.contact.area, 1),
            "contact_size_mm": [
                round(float(v), 3) for v in np.ptp(np.reshape(first.plan.contact.bounds, (2, 2)), axis=0)
            ],
            "overhang_mm": round(max(s.plan.overhang for s in build.shoes), 2),
            "blind_rim_mm": round(first.plan.blind_rim, 2),
            "taxel_overhang_mm": round(fit.overhang, 3),
            "thickness_mm": round(build.parameters.thickness, 3),
            "touching": None if build.touching is None else asdict(build.touching),
            "cop": None if build.cop is None else asdict(build.cop),
            "poses": {s.side: None if s.layout.pose is None else s.layout.pose.as_dict() for s in build.shoes},
            "notes": list(build.notes or build.foot.notes),
        }
        if self.checks:
            all_checks = list(self.checks.values())
            worst = max(self.weights.values(), key=lambda w: w.total)
            out |= {
                "watertight": all(c.watertight for c in all_checks),
                "volume_cm3": max(c.volume_cm3 for c in all_checks),
                "mass_g": max(c.mass_g for c in all_checks),
                "worn_mass_g": round(worst.total, 2),
                "min_wall_mm": min(c.min_wall_mm for c in all_checks),
                "size_mm": list(all_checks[0].size_mm),
                "print_hours": max(c.print_hours for c in all_checks),
                "retention": build.retention.kind if build.retention else "none",
                "holds": self.holds,
                "sides": {side: _plain(c) | {"weights_g": c.weights.as_dict()} for side, c in self.checks.items()},
                "parts": {side: [asdict(part) for part in bill] for side, bill in self.bills.items()},
            }
        if self.plan_checks:
            out |= {
                "holds": self.holds,
                "sides": {s: {"checks": _plain([asdict(c) for c in checks])} for s, checks in self.plan_checks.items()},
            }
        return out | {"parameters": build.parameters.as_dict(), "files": list(self.files)}


def _plain(value: Any) -> Any:
    if isinstance(value, ShoeCheck):
        plain = asdict(value) | {"holds": value.holds}
        del plain["weights"]  # stated with their unit and sum
        return _plain(plain)
    if isinstance(value, dict):
        return {k: _plain(v) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(v) for v in value]
    if isinstance(value, float):
        return round(value, 6) if math.isfinite(value) else None
    return value


def _layout_text(shoe: Shoe, build: ShoeBuild, weights: Weights | None, wired: WiredShoe | None) -> str:
    plan = shoe.plan
    ids = shoe.layout.ids.tolist()
    extra: dict[str, Any] = {
        "thickness": round(to_m(build.parameters.thickness), 6),
        "overhang": round(to_m(plan.overhang), 6),
        "rim_stiffness": round(build.load_share.rim_stiffness, 4),
        "foot_outline": to_m(ring(plan.foot)).round(6).tolist(),
    }
    if weights is not None:
        extra |= {
            "mass": round(1e-3 * weights.total, 6),
            "mass_printed": round(1e-3 * weights.printed, 6),
            "mass_pad": round(1e-3 * weights.pad, 6),
            "mass_skin": round(1e-3 * weights.skin, 6),
        }
    extra |= {
        "connectors": [ids[i] for i in plan.connectors],
        "cable_route": [[ids[i], ids[j]] for i, j in plan.route],
        "cell_shares": build.fit.shares.round(6).tolist(),
    }
    if wired is not None:
        extra |= {"circuit": wired.wiring.circuit, "channels": list(wired.wiring.channels)}
    if plan.lines is not None and plan.crossings is not None:
        extra |= {"rows": plan.lines[:, 0].tolist(), "columns": plan.lines[:, 1].tolist()}
        extra |= {"crossings": to_m(plan.crossings).round(6).tolist()}
    return json.dumps(layout_to_dict(shoe.layout) | {"shoe": extra}, indent=1) + "\n"


@missing_libraries("shoes")
def export_shoe(build: ShoeBuild, folder: str | os.PathLike[str], *, progress: Progress | None = None) -> ShoeReport:
    """Write and check every shoe's files.

    Args:
        build: Shoes; without solids, only layouts are written.
        folder: Existing; equal names are replaced.
        progress: Receives fraction and text.

    Returns:
        Measures, checks, file names.

    Raises:
        InputError: If unwritable.
    """
    target = Path(folder)
    report_progress = progress or (lambda fraction, text: None)
    checks: dict[str, ShoeCheck] = {}
    weights: dict[str, Weights] = {}
    bills: dict[str, list[Part]] = {}
    files: list[str] = []
    wired: dict[str, WiredShoe] = {}
    for i, shoe in enumerate(build.shoes):
        side = shoe.side
        count = len(build.shoes)
        if shoe.surface is not None:
            report_progress(i / count, f"writing the {side} shoe")
            surface, step, names, parts = _write_solids(shoe, build, target)
            report_progress((i + 0.4) / count, f"checking the {side} shoe")
            found = check_shoe(shoe, build, surface=surface, step=step, parts=parts)
            own = wire_shoe(shoe, build.parameters, next(iter(wired.values()), None))
            checks[side] = replace(found, checks=(*found.checks, *board_checks(own, shoe, build.parameters)))
            weights[side] = checks[side].weights
            bills[side] = bill_of_parts(shoe, build, weights[side], None if own is None else own.wiring)
            names += _write_for_cells(shoe, build, target)
            if own is not None:
                wired[side] = own
                names += write_wired(own, shoe, target)
            report_progress((i + 0.6) / count, f"drawing the {side} shoe")
            names += _draw(shoe, build, surface, target)
            files += names
        files.append(
            write_text(
                target / f"layout_{side}.json", _layout_text(shoe, build, weights.get(side), wired.get(side))
            ).name
        )
    if checks:
        write_text(target / "parts.csv", bill_text(bills))
        write_text(target / "wiring.csv", wiring_text(build.shoes, build.parameters))
        write_text(target / "assembly.html", assembly_page(build, checks, bills, wired))
        files += ["parts.csv", "wiring.csv", "assembly.html", "check.json"]
    if wired:
        wirings = {side: own.wiring for side, own in wired.items()}
        write_text(target / "nets.csv", nets_text(wirings))
        write_text(target / "harness.csv", harness_text(wirings))
        files += ["nets.csv", "harness.csv"]
    plans: dict[str, tuple[Check, ...]] = (
        {} if checks else {shoe.side: check_plan(shoe.plan, build) for shoe in build.shoes}
    )
    report = ShoeReport(build, checks, tuple(files), weights, bills, plans)
    if checks:
        write_text(target / "check.json", json.dumps(report.as_dict(), indent=1) + "\n")
    report_progress(1.0, "shoes written")
    return report


def _write_solids(
    shoe: Shoe, build: ShoeBuild, target: Path
) -> tuple[NDArray[np.float64], StepSolid, list[str], dict[str, bool]]:
    """Files of the solids; the print's surface and solid as they are read back, names, and which parts are valid."""
    assert shoe.surface is not None
    side = shoe.side
    p = build.parameters
    names = [f"{build.kind}_{side}.stl", f"{build.kind}_{side}.step", f"{build.kind}_{side}.3mf"]
    names.append(f"assembly_{side}.step")
    title = f"{shoe.layout.name} {build.kind} {side}"
    try:
        write_stl(shoe.surface, target / names[0])
        parts = assembly_parts(shoe, build)
        write_step(parts[:1], target / names[1], title)
        write_3mf(shoe.surface, f"{shoe.layout.name} {side}", target / names[2])
        write_step(parts, target / names[3], f"{title} assembly")
        if p.pad_thickness > 0.0:
            names += [f"pad_{side}.stl", f"mould_{side}.stl"]
            write_stl(pad_surface(shoe.plan, p), target / names[4])
            write_stl(mould_surface(shoe.plan, p), target / names[5])
    except OSError as error:
        raise InputError(f"cannot write the {side} shoe to {target}: {error.strerror}") from None
    valid = {part.name: is_valid(part) for part in parts[1:]}
    return read_mesh(target / names[0])[0], read_step(target / names[1]), names, valid


def _write_for_cells(shoe: Shoe, build: ShoeBuild, target: Path) -> list[str]:
    assert shoe.surface is not None
    side = shoe.side
    p = build.parameters
    names = [f"cells_{side}.dxf", f"assembly_{side}.3mf"]
    bodies = [
        NamedBody(f"{build.kind} {side}", p.material, "#4C72B0", shoe.surface),
        *(
            NamedBody(f"taxel {k}" if shoe.plan.lines is None else "sheet", "skin", "#55A868", surface)
            for k, surface in zip(shoe.layout.ids.tolist(), taxel_surfaces(shoe.plan, p), strict=False)  # or one sheet
        ),
    ]
    if p.pad_thickness > 0.0:
        bodies.append(NamedBody("pad", p.pad_material, "#333333", pad_surface(shoe.plan, p)))
    write_text(target / names[0], cells_dxf(shoe, build))
    write_assembly(bodies, f"{shoe.layout.name} {side}", target / names[1])
    return names


def _draw(shoe: Shoe, build: ShoeBuild, surface: NDArray[np.float64], target: Path) -> list[str]:
    side = shoe.side
    p = build.parameters
    drawn = draw_shoe(shoe, build, surface, [target / f"drawing_{side}.{ending}" for ending in ("pdf", "png")])
    pad = pad_surface(shoe.plan, p) if p.pad_thickness > 0.0 else None
    title = f"{shoe.layout.name}, {side} {build.kind}"
    drawn.append(draw_picture(surface, pad, title, target / f"picture_{side}.png"))
    return [path.name for path in drawn]


def shoe_text(summary: Mapping[str, Any]) -> str:
    """Shoe's figures for people."""
    lines = [f"  {note}" for note in summary["notes"]]
    size = f"{summary['cell_area_mm2']:g} mm^2{' or less' if summary['smallest_cell_share'] < 1.0 else ''}"
    lines.append(
        f"{summary['taxels']} taxels of {size} cover "
        f"{100 * summary['covered_area_ratio']:.0f} % of the sole, blind rim {summary['blind_rim_mm']:.0f} mm; "
        f"overhang {summary['overhang_mm']:g} mm"
    )
    if "mass_g" in summary:
        size = " x ".join(f"{v:.1f}" for v in summary["size_mm"])
        lines.append(
            f"{size} mm, {summary['volume_cm3']:.1f} cm^3, {summary['mass_g']:.0f} g printed, "
            f"{summary['worn_mass_g']:.0f} g worn, {summary['print_hours']:g} h to print, thinnest wall "
            f"{summary['min_wall_mm']:g} mm, {'watertight' if summary['watertight'] else 'NOT watertight'}; "
            f"{'all checks hold' if summary['holds'] else 'A CHECK DOES NOT HOLD'}"
        )
    return "\n".join([*lines, *(f"  {name}" for name in summary["files"])])


def failed_checks(summary: Mapping[str, Any]) -> list[str]:
    """Line for each failed check: side, name, value, allowed."""
    return [
        f"{side}: {check['name']} is {check['value']}, allowed {check['allowed']}"
        for side, shoe in summary.get("sides", {}).items()
        for check in shoe["checks"]
        if not check["holds"]
    ]
