"""A foot from dimensions, an outline, a mesh or a robot: how many taxels of 691 mm^2 fit under each.

python examples/shoe_from_any_foot.py
"""

import math
from pathlib import Path
from tempfile import TemporaryDirectory

import trimesh
from shapely import Polygon

from plantar.shoes import fit_taxels, foot_from_dimensions, foot_from_mesh, foot_from_outline
from plantar.shoes.foot.source import foot_of_robot

box = foot_from_dimensions("a box", length=0.25, width=0.10, corner_radius=0.02)

angles = [2.0 * math.pi * k / 60 for k in range(60)]  # an ellipse, in mm as all inside `shoes`
ellipse = foot_from_outline("an ellipse", Polygon([(130.0 * math.cos(a), 55.0 * math.sin(a)) for a in angles]))

with TemporaryDirectory() as folder:
    path = Path(folder) / "foot.stl"
    trimesh.creation.box(extents=(0.22, 0.09, 0.06)).export(path)  # the unit is found from the size
    mesh = foot_from_mesh(path)

robot, taxels = foot_of_robot("h1")

for foot in (box, ellipse, mesh, robot):
    fit = fit_taxels(foot.sole, border=2.0)
    print(f"{foot.name}: sole of {foot.sole.area / 100:.0f} cm^2, {len(fit.cells)} whole taxels")
    for note in foot.notes:
        print(f"    {note}")
print(f"the H1's own shoe has {taxels}: with --taxels cells may reach beyond the sole, or are cut")
