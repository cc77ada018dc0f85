"""Skin in many worlds of MuJoCo Warp, on a GPU where there is one: error against `BoundSkin`, and time a world.

    python benchmarks/warp_skin.py                      the box and the built-in h1
    python benchmarks/warp_skin.py MODEL BODY           a model of your own

Rows of other devices stay in the page. A CPU's times are processor time, a GPU's are of captured graphs.
"""

import argparse
import platform
import runpy
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import mujoco
import mujoco_warp
import numpy as np
import warp

from plantar.mujoco import Skin
from plantar.mujoco.warp_skin import WarpSkin

ROOT = Path(__file__).resolve().parents[1]
KINDS = runpy.run_path(str(ROOT / "tests/plantar/mujoco/conftest.py"))["KINDS"]
WORLDS, ROUNDS = {"cpu": (256, 1024, 4096), "cuda": (256, 1024, 4096, 16384, 65536)}, 15
HEAD = "| device | model | taxels | worlds | skin us | step us | skin / (skin + step) | pressed | carried | worst sum |"
TITLE = """# Skin in many worlds of MuJoCo Warp

Made by `python benchmarks/warp_skin.py`. Times are us a world and step. Worlds start with other velocities each and
are measured after 50 steps: in so many the foot is pressed, of these so many are carried by the taxels; the sum is
that of the taxels' forces and moments against MuJoCo Warp's contacts, relative to the load.
"""


def largest_error() -> float:
    """Largest difference from `BoundSkin` of a taxel's force or the wrench, over all kinds of models, by the load."""
    worst = 0.0
    for text in KINDS.values():
        model = mujoco.MjModel.from_xml_string(text)
        data, feel = mujoco.MjData(model), Skin(body="foot").bind(model)
        many = WarpSkin(feel, 2)
        for _ in range(3):
            mujoco.mj_step(model, data, 60)
            mujoco.mj_forward(model, data)
            many.read(mujoco_warp.put_data(model, data, nworld=2))
            vectors, wrench, carried = many.numpy()
            reading = feel(data)
            load = max(float(np.linalg.norm(reading.wrench[:3])), 1.0)
            assert (carried == reading.carried).all()
            worst = max(worst, np.abs(vectors - reading.vectors).max() / load)
            worst = max(worst, np.abs(wrench - reading.wrench).max() / load)
    return worst


def started(model: Any) -> Any:
    """Data of a model at its first keyframe, or in its reference pose."""
    data = mujoco.MjData(model)
    if model.nkey:
        mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    return data


def h1() -> tuple[Any, Any, Skin]:
    """The built-in h1 that stands on flat ground, and its left sole."""
    from plantar.sim.environments.walker import PlantarEnv

    env = PlantarEnv("stand")
    mujoco.mj_step(env.model, env.data, 200)
    env.model.opt.disableflags = 0  # MuJoCo Warp knows no midphase
    return env.model, env.data, Skin(body=env.robot.legs["left"].foot_body)


def microseconds(call: Callable[[], Any], worlds: int) -> float:
    """Time of a call in us a world: median of many on a GPU, least on a CPU."""
    call()
    rounds = []
    if warp.get_device().is_cpu:
        for _ in range(ROUNDS):
            began = time.process_time()
            call()
            rounds.append(time.process_time() - began)
        return 1e6 * min(rounds) / worlds
    with warp.ScopedCapture() as capture:
        call()
    for _ in range(ROUNDS + 5):
        before, after = warp.Event(enable_timing=True), warp.Event(enable_timing=True)
        warp.record_event(before)
        warp.capture_launch(capture.graph)
        warp.record_event(after)
        rounds.append(1e-3 * warp.get_event_elapsed_time(before, after))
    return 1e6 * float(np.median(rounds[5:])) / worlds


def row(device: str, name: str, model: Any, data: Any, skin: Skin, worlds: int) -> str:
    """A line of the table, of worlds whose velocities differ, after 50 steps."""
    feel = skin.bind(model)
    stepped, state = mujoco_warp.put_model(model), mujoco_warp.put_data(model, data, nworld=worlds)
    speeds = np.random.default_rng(0).normal(0.0, 0.03, (worlds, model.nv))
    state.qvel.assign(speeds.astype(np.float32))
    many = WarpSkin(feel, worlds)
    for _ in range(50):
        mujoco_warp.step(stepped, state)
    many.read(state)
    vectors, wrench, carried = many.numpy()
    moments = np.cross(feel.layout.positions, vectors).sum(axis=1)
    sums = np.hstack([vectors.sum(axis=1), np.where(carried[:, None], moments, wrench[:, 3:])])
    pressed = wrench[:, 2] > 0.0
    off = np.abs(sums - wrench).max(axis=1)[pressed] / wrench[pressed, 2]
    skin = microseconds(lambda: many.read(state), worlds)
    step = microseconds(lambda: mujoco_warp.step(stepped, state), worlds)
    figures = (f"{skin:.3g}", f"{step:.3g}", f"{100 * skin / (skin + step):.0f} %")
    shares = (f"{100 * pressed.mean():.0f} %", f"{100 * carried[pressed].mean():.0f} %", f"{off.max(initial=0.0):.0e}")
    return f"| {device} | {name} | {len(feel)} | {worlds} | " + " | ".join(figures + shares) + " |"


def measure(cases: dict[str, tuple[Any, Any, Skin]], output: Path, most: int) -> None:
    """Write the page with all rows of this device."""
    warp.config.quiet = True
    device = warp.get_device()
    name = f"CPU, one core ({platform.machine()})" if device.is_cpu else device.name
    kept = output.read_text().splitlines() if output.exists() else []
    own = tuple(f"| {name} | {case} |" for case in cases)
    lines = [line for line in kept if line.startswith("| ") and not line.startswith((HEAD[:9], *own))]
    notes = [line for line in kept if line.startswith("- ") and not line.startswith(f"- {name}:")]
    versions = f"MuJoCo {mujoco.__version__}, MuJoCo Warp {mujoco_warp.__version__}, Warp {warp.__version__}"
    error = f"{largest_error():.0e} of the load"
    notes.append(f"- {name}: {versions}; largest difference from `BoundSkin` on {len(KINDS)} kinds of models {error}")
    print(notes[-1], flush=True)
    for case, (model, data, skin) in cases.items():
        for worlds in [n for n in WORLDS["cpu" if device.is_cpu else "cuda"] if n <= most]:
            lines.append(row(name, case, model, data, skin, worlds))
            print(lines[-1], flush=True)
            text = "\n".join(sorted(notes)) + f"\n\n{HEAD}\n{'|---' * 10}|\n" + "\n".join(lines) + "\n"
            output.write_text(f"{TITLE}\n{text}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("model", nargs="*", help="MODEL BODY, or none")
    parser.add_argument("--only", nargs="+", metavar="CASE", help="some of box, box's lower face, h1; other rows stay")
    parser.add_argument("--worlds", type=int, default=65536, help="at most so many")
    parser.add_argument("-o", "--output", type=Path, default=Path(__file__).with_suffix(".md"))
    options = parser.parse_args()
    box = mujoco.MjModel.from_xml_string(KINDS["box"])
    face = Skin(body="foot", outward=(0, 0, -1))
    cases = {
        "box": (box, started(box), Skin(body="foot")),
        "box's lower face": (box, started(box), face),  # a patch that wraps
    }
    if options.model:
        path, body = options.model
        own = mujoco.MjModel.from_xml_path(path)
        cases[Path(path).stem] = (own, started(own), Skin(body=body))
    elif options.only is None or "h1" in options.only:
        cases["h1"] = h1()
    chosen = cases if options.only is None else {name: cases[name] for name in options.only}
    measure(chosen, options.output, options.worlds)


if __name__ == "__main__":
    main()
