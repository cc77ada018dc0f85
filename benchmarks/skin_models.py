"""Skin on models of many kinds next to MuJoCo's own sensors: error of the sum and of the centre of pressure, and time.

    python benchmarks/skin_models.py
    python benchmarks/skin_models.py robot.xml:BODY       and a body of your own model, on a floor

Truth is the sum of MuJoCo's contact forces (`mj_contactForce`). Compared are `plantar.mujoco.Skin`; a grid of as many
of MuJoCo's touch sensors over the sole's outline, boxes side by side from 1 mm outside it, 20 mm high; and the lit
taxels of MuJoCo's tactile sensor, which measures depths, on a flat mesh with a vertex a taxel.
"""

import argparse
import runpy
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from plantar.bench.tables import markdown_table
from plantar.mujoco import Skin

ROOT = Path(__file__).resolve().parents[1]
STEPS = 200


def with_sensors(spec: Any, skin: Skin, touch: bool, tactile: bool) -> tuple[Any, Any, int]:
    """The model with a skin's sites and sensors, the skin on it, and the number of touch sensors."""
    plain = skin.bind(spec.copy().compile())
    body = next(b for b in spec.bodies if b.name == skin.body)
    quat = np.empty(4)
    mujoco.mju_mat2Quat(quat, np.ascontiguousarray(plain.rotation_to_body).ravel())
    count = 0
    if touch:
        low, high = plain.layout.outline[:, :2].min(axis=0) - 1e-3, plain.layout.outline[:, :2].max(axis=0) + 1e-3
        rows = max(1, round(float(np.sqrt(len(plain) * (high - low)[0] / (high - low)[1]))))
        cells = np.array([rows, max(1, round(len(plain) / rows))])
        half = 0.5 * (high - low) / cells
        for i in np.ndindex(*cells):
            place = plain.rotation_to_body @ [*(low + (2 * np.array(i) + 1) * half), 0.0] + plain.position_in_body
            size = [half[0], half[1], 0.01]
            body.add_site(name=f"t{count}", type=mujoco.mjtGeom.mjGEOM_BOX, pos=place, quat=quat, size=size)
            spec.add_sensor(
                name=f"t{count}", type=mujoco.mjtSensor.mjSENS_TOUCH, objtype=mujoco.mjtObj.mjOBJ_SITE,
                objname=f"t{count}",
            )  # fmt: skip
            count += 1
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
    return model, skin.bind(model), count


def on_floor(path: str) -> Any:
    """A model of a file on a floor."""
    spec = mujoco.MjSpec.from_file(path)
    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[5.0, 5.0, 1.0])
    return spec


def microseconds(call: Any) -> float:
    """Median processor time of a call in us, over many short rounds."""
    rounds = []
    for _ in range(60):
        began = time.process_time()
        for _ in range(40):
            call()
        rounds.append((time.process_time() - began) / 40)
    return 1e6 * float(np.median(rounds))


def row(name: str, spec_of: Callable[[], Any], skin: Skin, truth: Any) -> list[str]:
    model, bound, count = with_sensors(spec_of(), skin, True, False)
    data = mujoco.MjData(model)
    if model.nkey:
        mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_step(model, data, STEPS)
    mujoco.mj_forward(model, data)
    wrench, reading = truth(bound, data), bound(data)
    load = max(np.linalg.norm(wrench[:3]), 1e-9)
    cop = np.array([-wrench[4], wrench[3]]) / wrench[2] if wrench[2] > 0.0 else np.full(2, np.nan)
    boxes = [model.site(f"t{i}").pos for i in range(count)]
    grid = ((np.array(boxes) - bound.position_in_body) @ bound.rotation_to_body)[:, :2]

    def center(force: np.ndarray, places: np.ndarray) -> float:
        return float(np.hypot(*(force @ places / force.sum() - cop))) if force.sum() > 0.0 else np.nan

    first = int(model.sensor("t0").adr[0])
    touched = np.array(data.sensordata[first : first + count])
    total = reading.vectors.sum(axis=0) - wrench[:3]
    ours = [np.linalg.norm(total) / load, center(reading.vectors[:, 2], bound.layout.positions[:, :2])]
    theirs = [abs(touched.sum() - wrench[2]) / load, center(touched, grid)]
    bare, _, _ = with_sensors(spec_of(), skin, False, False)
    plain = mujoco.MjData(bare)
    mujoco.mj_step(bare, plain, STEPS)
    step, read = microseconds(lambda: mujoco.mj_forward(bare, plain)), microseconds(lambda: bound(data))
    sensors = microseconds(lambda: mujoco.mj_forward(model, data)) - step
    lit, tactile = "-", "-"
    try:
        third, _, _ = with_sensors(spec_of(), skin, False, True)
        own = mujoco.MjData(third)
        mujoco.mj_step(third, own, STEPS)
        mujoco.mj_forward(third, own)
        first = int(third.sensor("tactile").adr[0])
        lit = f"{int((own.sensordata[first : first + len(bound)] > 0.0).sum())} of {len(bound)}"
        tactile = f"{microseconds(lambda: mujoco.mj_forward(third, own)) - step:.1f}"
    except (ValueError, mujoco.FatalError) as problem:
        lit = str(problem).splitlines()[0][:60]
    return [
        name, str(len(bound)), f"{ours[0]:.0e}", f"{1e3 * ours[1]:.4f}", "yes" if reading.carried else "no",
        f"{read:.1f}", f"{100 * theirs[0]:.1f} %", f"{1e3 * theirs[1]:.2f}", f"{sensors:.1f}",
        f"{int((reading.depth > 0).sum())}", lit, tactile, f"{step:.1f}",
    ]  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", type=Path, default=Path(__file__).with_suffix(".md"))
    parser.add_argument("own", nargs="*", help="FILE:BODY or FILE:BODY:GEOM of your own models")
    options = parser.parse_args()
    models = runpy.run_path(str(ROOT / "tests/plantar/mujoco/conftest.py"))
    truth = models["contact_wrench"].__wrapped__ if hasattr(models["contact_wrench"], "__wrapped__") else None
    truth = (truth or models["contact_wrench"]._get_wrapped_function())()
    head = [
        "model", "taxels", "skin: force, relative", "skin: CoP mm", "carried", "skin us", "touch grid: force",
        "touch grid: CoP mm", "touch grid us", "skin: deep taxels", "tactile: lit", "tactile us", "mj_forward us",
    ]  # fmt: skip
    rows = []
    cases: dict[str, tuple[Callable[[], Any], Skin]] = {
        name: (partial(mujoco.MjSpec.from_string, text), Skin(body="foot")) for name, text in models["KINDS"].items()
    }
    for path, body, *geoms in [own.split(":") for own in options.own]:
        cases[f"{Path(path).stem}, {body}"] = partial(on_floor, path), Skin(body=body, geoms=geoms or None)
    for name, (spec_of, skin) in cases.items():
        rows.append(row(name, spec_of, skin, truth))
        print(*rows[-1], flush=True)
    text = "# Skin next to MuJoCo's own sensors\n\nMade by `python benchmarks/skin_models.py`.\n\n"
    text += (
        f"After {STEPS} steps of each model. Processor times, medians of 60 rounds; a sensor's is what it adds to "
        "`mj_forward`. Where `carried` is no, the centre of pressure lies beyond the outermost taxels. The touch "
        "grid's cells are as large as taxels, so its centre of pressure is off by a part of a cell.\n\n"
    )
    options.output.write_text(f"{text}{markdown_table(head, rows)}\n")


if __name__ == "__main__":
    main()
