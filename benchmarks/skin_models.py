"""Skin on models of many kinds next to MuJoCo's own sensors: error of the sum and of the centre of pressure, and time.

    python benchmarks/skin_models.py

Truth is the sum of MuJoCo's contact forces (`mj_contactForce`). Compared are `plantar.mujoco.Skin`; a grid of MuJoCo's
touch sensors, a box-shaped site a taxel; and the lit taxels of MuJoCo's tactile sensor, which measures depths, on a
flat mesh with a vertex a taxel.
"""

import argparse
import runpy
import time
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from plantar.mujoco import Skin

ROOT = Path(__file__).resolve().parents[1]
STEPS = 300


def with_sensors(text: str, touch: bool, tactile: bool) -> tuple[Any, Any, int]:
    """The model with a skin's sites and sensors, the skin on it, and the number of taxels."""
    spec = mujoco.MjSpec.from_string(text)
    plain = Skin(body="foot").bind(spec.copy().compile())
    body = next(b for b in spec.bodies if b.name == "foot")
    places = plain.layout.positions @ plain.rotation_to_body.T + plain.position_in_body
    quat = np.empty(4)
    mujoco.mju_mat2Quat(quat, np.ascontiguousarray(plain.rotation_to_body).ravel())
    half = 0.5 * float(np.sqrt(plain.layout.areas.mean()))
    if touch:
        for i, place in enumerate(places):
            body.add_site(name=f"t{i}", type=mujoco.mjtGeom.mjGEOM_BOX, pos=place, quat=quat, size=[half, half, 0.01])
            spec.add_sensor(
                name=f"t{i}", type=mujoco.mjtSensor.mjSENS_TOUCH, objtype=mujoco.mjtObj.mjOBJ_SITE, objname=f"t{i}"
            )
    if tactile:
        from scipy.spatial import Delaunay

        faces = Delaunay(plain.layout.positions[:, :2]).simplices
        mesh = spec.add_mesh(name="cells", uservert=plain.layout.positions.ravel(), userface=faces.ravel())
        mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL
        geom = body.add_geom(
            name="pad", type=mujoco.mjtGeom.mjGEOM_MESH, meshname="cells", pos=plain.position_in_body, quat=quat,
            contype=0, conaffinity=0, mass=0.0,
        )  # fmt: skip
        own = next(g for g in body.geoms if g.name != "pad")
        own.name = own.name or "own"
        spec.add_sensor(
            name="tactile", type=mujoco.mjtSensor.mjSENS_TACTILE, objtype=mujoco.mjtObj.mjOBJ_MESH, objname="cells",
            reftype=mujoco.mjtObj.mjOBJ_GEOM, refname=geom.name,
        )  # fmt: skip
    model = spec.compile()
    return model, Skin(body="foot").bind(model), len(plain)


def microseconds(call: Any) -> float:
    """Least time of a call in us, over many short rounds."""
    rounds = []
    for _ in range(60):
        began = time.perf_counter()
        for _ in range(40):
            call()
        rounds.append((time.perf_counter() - began) / 40)
    return 1e6 * min(rounds)


def row(name: str, text: str, truth: Any) -> list[str]:
    model, bound, count = with_sensors(text, True, False)
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, STEPS)
    mujoco.mj_forward(model, data)
    wrench, reading = truth(bound, data), bound(data)
    load = np.linalg.norm(wrench[:3])
    cop = np.array([-wrench[4], wrench[3]]) / wrench[2] if wrench[2] > 0.0 else np.full(2, np.nan)
    places = bound.layout.positions[:, :2]

    def center(force: np.ndarray) -> float:
        return float(np.hypot(*(force @ places / force.sum() - cop))) if force.sum() > 0.0 else np.nan

    touched = np.array(data.sensordata[:count])
    ours = [np.linalg.norm(reading.vectors.sum(axis=0) - wrench[:3]) / load, center(reading.vectors[:, 2])]
    theirs = [abs(touched.sum() - wrench[2]) / load, center(touched)]
    bare, _, _ = with_sensors(text, False, False)
    plain = mujoco.MjData(bare)
    mujoco.mj_step(bare, plain, STEPS)
    step, skin = microseconds(lambda: mujoco.mj_forward(bare, plain)), microseconds(lambda: bound(data))
    grid = microseconds(lambda: mujoco.mj_forward(model, data)) - step
    lit, tactile = "-", "-"
    try:
        third, _, _ = with_sensors(text, False, True)
        own = mujoco.MjData(third)
        mujoco.mj_step(third, own, STEPS)
        mujoco.mj_forward(third, own)
        lit = f"{int((own.sensordata[:count] > 0.0).sum())} of {count}"
        tactile = f"{microseconds(lambda: mujoco.mj_forward(third, own)) - step:.1f}"
    except (ValueError, mujoco.FatalError) as problem:
        lit = str(problem).splitlines()[0][:60]
    return [
        name, str(count), f"{ours[0]:.0e}", f"{1e3 * ours[1]:.4f}", "yes" if reading.carried else "no", f"{skin:.1f}",
        f"{100 * theirs[0]:.1f} %", f"{1e3 * theirs[1]:.2f}", f"{grid:.1f}", f"{int((reading.depth > 0).sum())}", lit,
        tactile, f"{step:.1f}",
    ]  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", type=Path, default=Path(__file__).with_suffix(".md"))
    options = parser.parse_args()
    models = runpy.run_path(str(ROOT / "tests/plantar/mujoco/conftest.py"))
    truth = models["contact_wrench"].__wrapped__ if hasattr(models["contact_wrench"], "__wrapped__") else None
    truth = (truth or models["contact_wrench"]._get_wrapped_function())()
    head = [
        "model", "taxels", "skin: force, relative", "skin: CoP mm", "carried", "skin us", "touch grid: force",
        "touch grid: CoP mm", "touch grid us", "skin: deep taxels", "tactile: lit", "tactile us", "mj_forward us",
    ]  # fmt: skip
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    for name, text in models["KINDS"].items():
        lines.append("| " + " | ".join(row(name, text, truth)) + " |")
        print(lines[-1], flush=True)
    text = "# Skin next to MuJoCo's own sensors\n\nMade by `python benchmarks/skin_models.py`.\n\n"
    text += (
        "After 300 steps of each model. Times are the least of 60 rounds; a sensor's is what it adds to `mj_forward`. "
        + ("Where `carried` is no, the centre of pressure lies beyond the outermost taxels.\n\n")
    )
    options.output.write_text(text + "\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
