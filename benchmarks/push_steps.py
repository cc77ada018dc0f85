"""Scenes in which hands push or a partner leads: `python benchmarks/outcomes.py MINUTES push_steps`."""

from resumable import Benchmark, Case, failed, fallen, shown

SEEDS = 2
ROBOTS = ("h1", "hrp2kai")
FOLLOWER = ("partner.role=leader", "walk.length=0")
ON_BOTH: list[tuple[str, str, tuple[str, ...]]] = [
    ("steps in place, 16 and 40 N s", "push-step", ()),
    ("0.25 m/s in any direction", "push", ("push.dv=0.25",)),
]
ON_H1: list[tuple[str, str, tuple[str, ...]]] = [
    ("leads a partner, c = 1", "leader-follower", ()),
    ("follows a partner, c = 0", "leader-follower", (*FOLLOWER, "confidence=0")),
    ("box step, 16 pushes of 25 N s", "box-step", ()),
    ("box step, 15 N s", "box-step", ("push.impulse=15",)),
    ("on half a foothold, 10 N s", "push-partial", ()),
    ("the same, as a whole one", "push-partial", ("footholds=off",)),
    ("along a beam, 20 N s", "push-beam", ()),
]
CASES = [
    *(Case(name, scene, robot, more, SEEDS) for name, scene, more in ON_BOTH for robot in ROBOTS),
    *(Case(name, scene, "h1", more, SEEDS) for name, scene, more in ON_H1),
]

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
