"""Runs in which a hand leads h1 by its arm: `python benchmarks/outcomes.py MINUTES guide`."""

from resumable import SPREAD, Benchmark, Case, failed, fallen, shown

HEADS = {
    "moved_m": "hand moved [m]",
    "arm_yielded_m": "arm yielded [m]",
    "arm_turned_deg": "joint turned [deg]",
    "feet_followed_m": "feet followed [m]",
    "feet_astray_m": "to a side [m]",
    "largest_force_N": "largest force [N]",
}
STIFF = ("arm.spring=8", "arm.damper=0.15", "arm.gain=0")
LINES: dict[str, tuple[str, ...]] = {
    "led by its arm": (),
    "an arm that does not give way": STIFF,
    "skin not read": ("sensing.body_skin=false",),
    "measured, but the steps stay": ("confidence=1", "yielding=0"),
}
BENCHMARK = Benchmark(
    "guide",
    {
        **{name: name for name in ("fell", "steps_taken", "steps_planned")},
        "toward": "guide.direction",
        "set_out_s": "guide.set_out_s",
        **{name: f"guide.{name}" for name in HEADS},
    },
    [Case(name, "guide", "h1", more, 4) for name, more in LINES.items()],
    {"fell": fallen, "failed criteria": failed, **{head: shown(name, SPREAD) for name, head in HEADS.items()}},
    "Medians, with the least and the most.",
)
