"""Every dotted setting of scenes, `--set`, sweeps and robot files."""

from difflib import get_close_matches

from plantar.common.settings.body_scale import REFERENCE_BODY, BodyScale
from plantar.common.settings.schema import Setting
from plantar.errors import InputError
from plantar.gait.controller_tables import CONTROLLER_TABLES, controller_settings_described
from plantar.sim.companion.experiment import companion_tables, experiment_names
from plantar.sim.run.scene import SECTIONS
from plantar.sim.terrain import terrain_kinds


def settings_listed(name: str | None = None, body: BodyScale = REFERENCE_BODY) -> dict[str, Setting]:
    """The settings by their dotted names.

    `name`: table such as "estimator" or "terrain.beam", dotted name, or its last part; None: all. Returns descriptions;
    a terrain's under "terrain.KIND." (in a scene `terrain.kind` and the last part), an experiment's under its name.

    Example:
        >>> settings_listed("estimator.gravity")["estimator.gravity"][1:4]
        ('0.2002', '1/s', 'a number 0 to 50')
    """
    tables: dict[str, tuple[Setting, ...]] = {
        section: kind.described(body) for section, kind in SECTIONS.items() if section != "terrain"
    }
    tables |= {f"terrain.{kind}": ground.described(body) for kind, ground in terrain_kinds().items()}
    tables |= {table: controller_settings_described(table, body) for table in CONTROLLER_TABLES}
    for kind in experiment_names():
        tables |= {f"{kind}.{table}": own.described(body) for table, own in companion_tables(kind).items()}
    every = {f"{table}.{setting.name}": setting for table, settings in tables.items() for setting in settings}
    if name is None:
        return every
    found = {
        full: setting
        for full, setting in every.items()
        if full == name or full.startswith(f"{name}.") or full.endswith(f".{name}")
    }
    if not found:
        words = {*tables, *every, *(setting.name for setting in every.values())}
        near = get_close_matches(name, sorted(words), 4)
        hint = f"nearest: {', '.join(near)}; " if near else ""
        raise InputError(f"no setting or table '{name}'; {hint}tables: {', '.join(tables)}")
    return found


def settings_of_robot(name: str | None, robot: str | None) -> dict[str, Setting]:
    """Returns settings of a `name` (`settings_listed`) with numbers of a `robot`, H1's for None."""
    if robot is None:
        return settings_listed(name)
    from plantar.robots import load_robot
    from plantar.robots.kinematics.body import body_of
    from plantar.robots.kinematics.robot_model import build_leg_model

    found = load_robot(robot)
    return settings_listed(name, body_of(found, build_leg_model(found).model))
