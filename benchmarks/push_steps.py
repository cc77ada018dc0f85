"""Scenes in which hands push or a partner leads: `python benchmarks/outcomes.py MINUTES push_steps`.

Each ablation changes one thing, on the first eight of the seeds.
"""

from introduced_robots import robot_file
from resumable import Benchmark, Case, failed, fallen, shown

SEEDS, FEW = 20, 8
FOLLOWER = ("partner.role=leader", "walk.length=0")
ANKLES = ("control.step_adjustment=false", "lean=true")
ANY = ("push.dv=0.25",)
LINES: list[tuple[str, str, tuple[str, ...], bool]] = [
    ("steps in place, 16 and 40 N s", "push-step", (), False),
    ("the same, no step moves", "push-step", ANKLES, True),
    ("the same, measured by the skin", "push-step", ("control.push_estimate=skin",), True),
    ("the same, push not estimated", "push-step", ("control.push_estimate=off",), True),
    ("at the shoulders", "push-height", (), False),
    ("at the CoM", "push-height", ("push.place=com",), False),
    ("at the hips", "push-height", ("push.place=hip",), False),
    ("leads a partner, c = 1", "leader-follower", (), False),
    ("follows a partner, c = 0", "leader-follower", (*FOLLOWER, "confidence=0"), False),
    *(
        (f"follows, c = {c / 10:g}", "leader-follower", (*FOLLOWER, f"confidence={c / 10:g}"), True)
        for c in range(1, 11)
    ),
    ("box step, 16 pushes of 25 N s", "box-step", (), False),
    *((f"box step, {v} N s", "box-step", (f"push.impulse={v}",), True) for v in (10, 15, 25, 30)),
    ("on half a foothold, 10 N s", "push-partial", (), False),
    ("the same, as a whole one", "push-partial", ("footholds=off",), True),
    ("along a beam, 20 N s", "push-beam", (), False),
]
CASES = [
    Case(name, scene, robot, settings, FEW if aside else SEEDS, aside)
    for name, scene, settings, aside in LINES
    for robot in ("h1", "hrp2kai")
]
for _name, _file in (("hrp2kai", ""), *((n, str(robot_file(n))) for n in ("JVRC-1", "OP3"))):
    CASES.append(Case(f"{_name}, 0.25 m/s in any direction", "push", _name, ANY, SEEDS, file=_file))
    CASES.append(Case(f"{_name}, the same, no step moves", "push", _name, (*ANY, *ANKLES), FEW, True, _file))

BENCHMARK = Benchmark(
    "push_steps",
    {
        "fell": "fell",
        "impulse_Ns": "push.impulse_Ns",
        "largest_change_m": lambda simulation, out: max(out.get("push", {}).get("step_changes_m", []), default=""),
        "partner_moved_m": "partner.moved_m",
        "robot_moved_m": "partner.robot_moved_m",
        "largest_force_N": "partner.largest_force_N",
        "ratio": lambda simulation, out: ([""] + [p["ratio"] for p in out.get("push", {}).get("pushes", [])])[-1],
    },
    CASES,
    {
        "fell": fallen,
        "failed criteria": failed,
        "largest change of a step [m]": shown("largest_change_m"),
        "robot moved [m]": shown("robot_moved_m"),
        "partner moved [m]": shown("partner_moved_m"),
        "force [N]": shown("largest_force_N"),
        "CoM against prediction": shown("ratio"),
    },
    "Medians.",
)
