"""What skin measures of the same touch by MuJoCo's contacts and as foam.

    python benchmarks/foam_contacts.py

A body slides along z onto a heavy slab or arm with skin and is pressed down by 24 N, damped, for 0.6 s. Taxels are
those that carry more than 0.15 N.
"""

from pathlib import Path
from typing import Any

import mujoco

from plantar.bench.tables import markdown_table
from plantar.mujoco import FoamSkins, Skin, Skins

FORCE = 24.0  # N
PAGE = """# Foam beside contacts

Made by `python benchmarks/foam_contacts.py`. A body of the named mass slides onto a heavy slab or arm
with skin and is pressed down by 24 N for 0.6 s; taxels are those of 691 mm² that carry more than 0.15 N.

"""
WORLD = """<mujoco><option timestep=".001" gravity="0 0 0"/><worldbody>
  <body name="slab" pos="0 0 .4"><freejoint/><geom type="box" size=".11 .23 .1" mass="5000"/></body>
  <body name="arm" pos="2 0 .455"><freejoint/><geom type="capsule" size=".045 .1" euler="0 90 0" mass="5000"/></body>
  <body name="thing" pos="{x} 0 .53"><joint type="slide" axis="0 0 1"/><geom name="thing" {shape} mass="{mass}"/></body>
</worldbody></mujoco>"""
SHAPES = {
    "probe of 10 mm": ('type="cylinder" size=".010 .02"', 0.0),
    "probe of 148 mm": ('type="cylinder" size=".148 .02"', 0.0),
    "palm of 9 x 14 cm": ('type="box" size=".045 .07 .025"', 0.0),
    "palm on an arm": ('type="box" size=".045 .07 .025"', 2.0),
    "ball of 60 mm on an arm": ('type="sphere" size=".06"', 2.0),
}


def pressed(shape: str, x: float, mass: float, foam: bool) -> tuple[int, float, float]:
    """Loaded taxels, force in N, and largest depth in mm."""
    model = mujoco.MjModel.from_xml_string(WORLD.format(shape=shape, x=x, mass=mass))
    data = mujoco.MjData(model)
    body, options = ("slab", {"outward": (0, 0, 1)}) if x == 0.0 else ("arm", {"around": (1, 0, 0)})
    worn = Skins([Skin(body=body, **options).bind(model)])
    skins: Any = FoamSkins(model, worn.body_skin, ["thing"]) if foam else worn
    mujoco.mj_forward(model, data)
    below = mujoco.mj_geomDistance(model, data, model.geom("thing").id, 0 if x == 0.0 else 1, 5.0, None)
    data.qpos[-1] -= below
    for _ in range(600):
        data.qfrc_applied[-1] = -FORCE - 60.0 * data.qvel[-1]
        mujoco.mj_step1(model, data)
        if foam:
            skins.press(data)
        mujoco.mj_step2(model, data)
    (reading,) = skins(data)
    depth = reading.depth.max() if foam else -min((c.dist for c in data.contact), default=0.0)
    return int((reading.force > 0.15).sum()), float(reading.force.sum()), 1e3 * float(depth)


def row(name: str, shape: str, x: float, mass: float) -> list[str]:
    found = [pressed(shape, x, mass, foam) for foam in (False, True)]
    return [name, f"{mass:g}", *(text for n, f, d in found for text in (str(n), f"{f:.1f}", f"{d:.2f}"))]


def main() -> None:
    rows = [row(name, shape, x, 1.7) for name, (shape, x) in SHAPES.items()]
    palm = "palm of 9 x 14 cm"
    rows += [row(palm, *SHAPES[palm], mass) for mass in (0.3, 10.0)]
    head = ["what presses", "kg"]
    head += [f"{what} by {way}" for way in ("contacts", "foam") for what in ("taxels", "N", "depth mm")]
    Path(__file__).with_suffix(".md").write_text(PAGE + markdown_table(head, rows))


if __name__ == "__main__":
    main()
