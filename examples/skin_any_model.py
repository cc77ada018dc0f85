"""A plantar skin on any body of any MuJoCo model: its taxels add up to MuJoCo's contact force.

    python examples/skin_any_model.py                      a box, with its load off the middle
    python examples/skin_any_model.py robot.xml BODY       your own model, on a floor if it has none

Needs: pip install '.[sim]'
"""

import sys

import mujoco
import numpy as np

from plantar import Percept
from plantar.mujoco import Skin

BOX = """<mujoco><worldbody><geom type="plane" size="1 1 1"/><body name="foot" pos="0 0 .03"><freejoint/>
  <geom type="box" size=".12 .05 .03" mass="6"/><geom type="sphere" size=".03" pos=".06 .01 .1" mass="4"/>
</body></worldbody></mujoco>"""


def main(arguments: list[str]) -> None:
    """Let it settle for a second and print what the skin reads."""
    spec = mujoco.MjSpec.from_file(arguments[0]) if arguments else mujoco.MjSpec.from_string(BOX)
    if not any(g.type in (mujoco.mjtGeom.mjGEOM_PLANE, mujoco.mjtGeom.mjGEOM_HFIELD) for g in spec.geoms):
        spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[5.0, 5.0, 1.0])

    skin = Skin(body=arguments[1] if arguments else "foot")
    skin.edit(spec)
    model = spec.compile()
    feel = skin.bind(model)

    data = mujoco.MjData(model)
    if model.nkey:
        mujoco.mj_resetDataKeyframe(model, data, 0)
    while data.time < 1.0:
        mujoco.mj_step(model, data)
    reading = feel(data)
    percept = Percept(feel.layout, reading)
    print(f"{len(feel)} taxels, {np.count_nonzero(reading.force)} of them loaded")
    with np.printoptions(precision=3, suppress=True):
        print(f"sum of the taxels {reading.vectors.sum(axis=0)} N, contacts {reading.wrench[:3]} N")
    print(f"centre of pressure {reading.position_cop_in_sole} m, carried by the taxels: {reading.carried}")
    print(f"support polygon {1e4 * percept.support_area:.0f} cm^2")


if __name__ == "__main__":
    main(sys.argv[1:])
