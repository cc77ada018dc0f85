"""A foot from the outline of its sole (SVG, DXF, GeoJSON) and from a robot's model: the same sole of each.

python examples/shoe_from_files.py
"""

import json
from pathlib import Path
from tempfile import TemporaryDirectory

from ezdxf.filemanagement import new

from plantar.shoes import fit_taxels
from plantar.shoes.foot.source import read_foot
from plantar.shoes.order import FootSource

corners = [(-100, -40), (120, -40), (120, 40), (-100, 40)]  # mm; x to the toes, y to the left
MODEL = """<mujoco><worldbody><body name="pelvis" pos="0 0 0.5"><geom size="0.05"/>
  <body name="left_foot" pos="0 0.1 -0.45"><joint name="ankle" axis="0 1 0"/>
    <geom type="box" size="0.11 0.04 0.02" pos="0.01 0 -0.03" mass="0.5"/></body></body></worldbody></mujoco>"""

with TemporaryDirectory() as name:
    folder = Path(name)
    points = " ".join(f"{x + 100},{40 - y}" for x, y in corners)  # y of a picture points down
    size = 'width="220mm" height="80mm" viewBox="0 0 220 80"'
    (folder / "sole.svg").write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" {size}><polygon points="{points}"/></svg>'
    )
    drawing = new(units=4)  # mm
    drawing.modelspace().add_lwpolyline(corners, close=True)
    drawing.saveas(folder / "sole.dxf")
    ring = [[x / 1000, y / 1000] for x, y in [*corners, corners[0]]]
    (folder / "sole.geojson").write_text(json.dumps({"type": "Polygon", "coordinates": [ring]}))
    (folder / "robot.xml").write_text(MODEL)

    sources = [
        FootSource(file=folder / "sole.svg"),
        FootSource(file=folder / "sole.dxf"),
        FootSource(file=folder / "sole.geojson", unit="m"),
        FootSource(file=folder / "robot.xml", body="left_foot"),
    ]
    for source in sources:
        foot, _ = read_foot(source, sole_band=5.0)
        fit = fit_taxels(foot.sole, border=2.0)
        print(f"{source.file.name}: sole of {foot.sole.area / 100:.0f} cm^2, {len(fit.cells)} whole taxels")
