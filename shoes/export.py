"""Files of a shoe: STL, STEP, layout, drawing and what was checked on them."""

from __future__ import annotations

import json
import math
import os
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from plantar.atomic import write_text
from plantar.errors import InputError
from plantar.layout_file import write_layout
from shoes.build import Progress, ShoeBuild
from shoes.check import ShoeCheck, check_shoe
from shoes.drawing import draw_shoe
from shoes.stl import read_stl, write_stl
from shoes.tray import read_step, write_step

__all__ = ["ShoeReport", "export_shoe"]


@dataclass(frozen=True)
class ShoeReport:
    """What was exported and measured.

    Attributes:
        build: The shoes.
        checks: Measures of each shoe by side; empty where only layouts were asked for.
        files: Names of the files written, in the folder given.
    """

    build: ShoeBuild
    checks: dict[str, ShoeCheck]
    files: tuple[str, ...]

    @property
    def holds(self) -> bool:
        """Whether every check of every shoe holds."""
        return all(c.holds for c in self.checks.values())

    def as_dict(self) -> dict[str, Any]:
        """Plain JSON values; of a pair the top level holds the worse figure, `sides` each shoe's own."""
        build, first = self.build, self.build.shoes[0]
        out: dict[str, Any] = {
            "name": first.layout.name,
            "taxels": len(first.layout),
            "cell_area_mm2": build.fit.lattice.area,
            "covered_area_ratio": round(build.fit.covered_area_ratio, 4),
            "sole_area_mm2": round(build.foot.sole.area, 1),
            "contact_area_mm2": round(first.plan.contact.area, 1),
            "overhang_mm": round(max(s.plan.overhang for s in build.shoes), 2),
            "taxel_overhang_mm": build.fit.overhang,
            "thickness_mm": build.parameters.plate_thickness,
            "notes": list(build.foot.notes),
        }
        if self.checks:
            all_checks = list(self.checks.values())
            out |= {
                "watertight": all(c.watertight for c in all_checks),
                "volume_cm3": max(c.volume_cm3 for c in all_checks),
                "mass_g": max(c.mass_g for c in all_checks),
                "min_wall_mm": min(c.min_wall_mm for c in all_checks),
                "size_mm": list(all_checks[0].size_mm),
                "holds": self.holds,
                "sides": {side: _plain(c) for side, c in self.checks.items()},
            }
        return out | {"parameters": build.parameters.as_dict(), "files": list(self.files)}


def _plain(check: ShoeCheck) -> dict[str, Any]:
    """One shoe's measures as JSON values; a measure that is not finite becomes null."""
    out = asdict(check) | {"holds": check.holds}
    for one in out["checks"]:
        one["value"] = one["value"] if math.isfinite(one["value"]) else None
    return out


def export_shoe(build: ShoeBuild, folder: str | os.PathLike[str], *, progress: Progress | None = None) -> ShoeReport:
    """Write the files of every shoe and check what was written.

    Args:
        build: The shoes; where they have no solid, only their layouts are written.
        folder: An existing folder; files of the same name are replaced.
        progress: Receives fraction and text.

    Returns:
        Measures, checks and file names.

    Raises:
        InputError: If a file cannot be written.
    """
    target = Path(folder)
    tell = progress or (lambda fraction, text: None)
    checks: dict[str, ShoeCheck] = {}
    files: list[str] = []
    for i, shoe in enumerate(build.shoes):
        side = shoe.side
        tell(i / len(build.shoes), f"writing the {side} shoe")
        files.append(write_layout(shoe.layout, target / f"layout_{side}.json").name)
        if shoe.surface is None:
            continue
        stl, step = target / f"shoe_{side}.stl", target / f"shoe_{side}.step"
        try:
            write_stl(shoe.surface, stl)
            write_step(shoe.solid, str(step))
        except OSError as error:
            raise InputError(f"cannot write the {side} shoe to {target}: {error.strerror}") from None
        tell((i + 0.5) / len(build.shoes), f"checking the {side} shoe")
        surface = read_stl(stl)
        checks[side] = check_shoe(shoe, build.parameters, surface=surface, step=read_step(str(step)))
        picture = draw_shoe(shoe, build, surface, target / f"drawing_{side}.png")
        files += [stl.name, step.name, picture.name]
    if checks:
        files.append("check.json")
    report = ShoeReport(build, checks, tuple(files))
    if checks:
        write_text(target / "check.json", json.dumps(report.as_dict(), indent=1) + "\n")
    tell(1.0, "shoes written")
    return report
