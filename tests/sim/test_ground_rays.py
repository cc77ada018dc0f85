"""Rays against simple solids: to the last bit what MuJoCo's own rays find, and both forms of the kernel agree."""

from typing import Any

import mujoco
import numpy as np
import pytest
from numpy.typing import NDArray

from plantar import hex_layout, kernels
from plantar.kernels.sensors import ground_rays
from plantar.sim.sensing.proximity import SoleProximity
from plantar.sim.terrain import GROUND_GROUP

KINDS = ("plane", "sphere", "ellipsoid", "cylinder", "box")
REACH = 0.07
GROUPS = np.array([1 if i == GROUND_GROUP else 0 for i in range(6)], dtype=np.uint8)


def scattered(rng: np.random.Generator) -> tuple[Any, Any]:
    """A few solids of all kinds, some turned, some far away."""
    geoms = []
    for _ in range(rng.integers(1, 12)):
        kind = str(rng.choice(KINDS))
        size = rng.uniform(0.01, 0.2, 3)
        if kind == "plane" and rng.random() < 0.5:
            size[:2] = 0.0
        quat = np.array([1.0, 0.0, 0.0, 0.0]) if rng.random() < 0.4 else rng.normal(size=4)
        place = rng.uniform(-0.3, 0.3, 3)
        text = [" ".join(map(repr, v.tolist())) for v in (size, place, quat / np.linalg.norm(quat))]
        geoms.append(f"<geom type='{kind}' size='{text[0]}' pos='{text[1]}' quat='{text[2]}' group='{GROUND_GROUP}'/>")
    model = mujoco.MjModel.from_xml_string(f"<mujoco><worldbody>{''.join(geoms)}</worldbody></mujoco>")
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return model, data


def rays(rng: np.random.Generator) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    starts = rng.uniform(-0.12, 0.12, (51, 3)) * [1.0, 0.6, 0.05] + rng.uniform(-0.2, 0.4, 3)
    way = np.array([0.0, 0.0, -1.0]) + 0.1 * rng.normal(size=3) * (rng.random() < 0.7)
    return starts, np.tile(way / np.linalg.norm(way), (51, 1))


def cast(module, model, data, starts, ways):
    lengths = np.empty(len(starts))
    ids, kinds = np.arange(model.ngeom, dtype=np.int32), model.geom_type.astype(np.int32)
    solids = (ids, kinds, model.geom_size, model.geom_rbound, data.geom_xpos, data.geom_xmat)
    module.cast_rays(starts, ways, REACH, *solids, lengths)
    return lengths


def within_reach(lengths: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.where((lengths >= 0.0) & (lengths <= REACH), lengths, np.inf)


def test_rays_are_those_of_mujoco_to_the_last_bit():
    rng = np.random.default_rng(0)
    met = 0
    for _ in range(150):
        model, data = scattered(rng)
        starts, ways = rays(rng)
        geom = np.empty(1, dtype=np.int32)
        wanted = [mujoco.mj_ray(model, data, a, b, GROUPS, 1, -1, geom) for a, b in zip(starts, ways, strict=True)]
        wanted = within_reach(np.array(wanted))
        got = within_reach(cast(ground_rays, model, data, starts, ways))
        assert got.tolist() == wanted.tolist()
        met += int(np.isfinite(wanted).sum())
    assert met > 500


def test_both_forms_agree_to_the_last_bit():
    rng = np.random.default_rng(1)
    python = kernels.python_form("ground_rays")
    for _ in range(20):
        model, data = scattered(rng)
        starts, ways = rays(rng)
        ours, theirs = (cast(module, model, data, starts, ways) for module in (ground_rays, python))
        assert ours.tolist() == theirs.tolist()


@pytest.mark.parametrize("height", [0.03, 0.045])
def test_ground_of_another_kind_is_seen_by_mujocos_rays(height):
    """A capsule is none of the kernel's solids: the sole sees it all the same, and what lies beside it."""
    layout = hex_layout([[-0.1, -0.06], [0.1, -0.06], [0.1, 0.06], [-0.1, 0.06]])
    seen = []
    for kind, size in (("capsule", ".02 .03"), ("sphere", ".02")):
        model = mujoco.MjModel.from_xml_string(
            f"<mujoco><worldbody><geom type='plane' size='1 1 .1' group='{GROUND_GROUP}'/>"
            f"<geom type='{kind}' size='{size}' group='{GROUND_GROUP}' euler='90 0 0'/>"
            f"<site name='left_sole' pos='0 0 {height}'/></worldbody></mujoco>"
        )
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        seen.append(SoleProximity(model, layout, "left_sole").distances(data))
    higher = seen[0] < height - 1e-9
    assert 1 <= (seen[1] < height - 1e-9).sum() < higher.sum()
    assert seen[0][~higher] == pytest.approx(height, abs=1e-12)
