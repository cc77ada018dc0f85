"""Gymnasium environments with plantar skin: `gymnasium.make("plantar.sim.environments:PlantarWalk-v0", robot="h1")`.

Gymnasium 1.0 and newer load no entry points: an id is known once this module is imported, which the part before the
colon does.
"""

from importlib.util import find_spec

from plantar.common.optional_library import need_libraries

__all__ = ["ENVIRONMENTS", "FOOTHOLDS", "register"]

ENVIRONMENTS = {
    "PlantarStand-v0": "stand",
    "PlantarStep-v0": "step",
    "PlantarWalk-v0": "walk",
    "PlantarBoard-v0": "board",
}
"""Id and task of each environment."""

FOOTHOLDS = "PlantarFootholds-v0"
"""Id of the trials of `plantar bench footholds`."""

_STEPS = 500  # of 20 ms: episodes of 10 s


def register() -> None:
    """Add the environments to Gymnasium's registry, once."""
    need_libraries("gym", "gymnasium", "mujoco")
    import gymnasium

    for name, task in ENVIRONMENTS.items():
        if name not in gymnasium.registry:
            gymnasium.register(
                name,
                "plantar.sim.environments.walker:PlantarEnv",
                max_episode_steps=_STEPS,
                kwargs={"task": task},
            )
    if FOOTHOLDS not in gymnasium.registry:
        gymnasium.register(FOOTHOLDS, "plantar.sim.bench.footholds.environment:FootholdEnv")


if find_spec("gymnasium") and find_spec("mujoco"):
    register()
