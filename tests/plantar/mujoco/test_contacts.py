"""The reader of contacts against one that looks anew each time, while their number changes."""

import mujoco
import numpy as np

from plantar.mujoco.contacts import ContactReader
from plantar.sim.model.contact_truth import feet_contacts

FEET = """<mujoco><option timestep='0.001' cone='{cone}'/><worldbody>
    <geom name='floor' type='plane' size='2 2 0.1'/>
    <body pos='0 0 0.05'><freejoint/><geom name='left' type='box' size='0.1 0.05 0.01' mass='3'/></body>
    <body pos='0 0.3 0.08' euler='0 5 3'><freejoint/>
        <geom name='right' type='box' size='0.1 0.05 0.01' mass='3'/></body>
    </worldbody></mujoco>"""


def test_what_was_shown_before_stays_where_mujoco_counts_on():
    for cone in ("elliptic", "pyramidal"):
        model = mujoco.MjModel.from_xml_string(FEET.format(cone=cone))
        data = mujoco.MjData(model)
        feet = [{model.geom(name).id} for name in ("left", "right")]
        reader, numbers = ContactReader(model, data, feet), set()
        for _ in range(300):
            mujoco.mj_step(model, data)
            numbers.add(data.ncon)
            for found, anew in zip(reader.read(), feet_contacts(model, data, feet), strict=True):
                assert found.size == anew.size
                vectors = np.asarray(found.vectors)[: 3 * found.size]
                assert np.array_equal(vectors[::3], anew.positions)
                assert np.array_equal(vectors[1::3], anew.forces)
                assert np.array_equal(np.asarray(found.gaps)[: found.size], anew.distances)
        assert {0, 4, 8} <= numbers  # in the air, on one foot, on both
        mujoco.mj_resetData(model, data)
        mujoco.mj_forward(model, data)
        assert all(found.size == 0 for found in reader.read())
