"""A shoe as a solid in cadquery: a hole of your own through its wall, and a STEP file of the result.

python examples/shoe_in_cadquery.py
"""

from pathlib import Path
from tempfile import TemporaryDirectory

import cadquery
import trimesh

from plantar.shoes import build_shoe

with TemporaryDirectory() as folder:
    path = Path(folder) / "foot.stl"
    trimesh.creation.box(extents=(0.16, 0.08, 0.05)).export(path)
    build = build_shoe(path, side="left")

part = build.shoes[0].workplane  # mm, in the sole frame: x forward, y left, z up, the ground at 0
top = build.parameters.rim_top
hole = cadquery.Workplane("YZ", origin=(0.0, 0.0, top - 4.0)).circle(1.6).extrude(200.0)  # through the toes' wall
drilled = part.cut(hole)
taken = part.val().Volume() - drilled.val().Volume()
print(f"{part.val().Volume() / 1000:.1f} cm^3, valid: {drilled.val().isValid()}, the hole takes {taken:.0f} mm^3")
