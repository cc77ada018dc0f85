"""Time a world of reading a skin in many worlds of MuJoCo Warp; on a GPU where there is one.

python benchmarks/warp_skin.py
"""

import time

import mujoco
import mujoco_warp
import warp

from plantar.mujoco import Skin
from plantar.mujoco.warp_skin import WarpSkin

BOX = """<mujoco><worldbody><geom type="plane" size="3 3 1"/><body name="foot" pos="0 0 .02"><freejoint/>
<geom type="box" size=".12 .05 .02" mass="8"/></body></worldbody></mujoco>"""

warp.config.quiet = True
model = mujoco.MjModel.from_xml_string(BOX)
data = mujoco.MjData(model)
mujoco.mj_step(model, data, 200)
mujoco.mj_forward(model, data)
bound = Skin(body="foot").bind(model)
for worlds in (256, 1024, 4096):
    many, state = WarpSkin(bound, worlds), mujoco_warp.put_data(model, data, nworld=worlds)
    rounds = []
    for _ in range(10):
        began = time.perf_counter()
        many.read(state)
        warp.synchronize()
        rounds.append(time.perf_counter() - began)
    print(f"{warp.get_device()}: {worlds} worlds of {len(bound)} taxels, {1e6 * min(rounds) / worlds:.2f} us a world")
