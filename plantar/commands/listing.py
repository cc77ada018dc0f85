"""`plantar list`: list robots, scenes, papers, formats, live sources and settings."""

from typing import Annotated

from typer import Argument, Option

from plantar.common.console.command import Command, Json, end_command
from plantar.common.optional_library import need_libraries
from plantar.errors import InputError


def list_(
    what: Annotated[
        str | None,
        Argument(metavar="WHAT", help="robots, scenes, papers, formats, sources or settings.", show_default=False),
    ] = None,
    name: Annotated[
        str | None,
        Argument(help="settings: a table or a setting, such as estimator or balance.dcm_gain; papers, scenes: one."),
    ] = None,
    robot: Annotated[
        str | None, Option(help="settings: the robot whose numbers are shown where a default is a share of its body.")
    ] = None,
    as_json: Json = False,
) -> None:
    """List what there is: robots to walk, scenes to run, recording formats to analyse, settings to change.

    `plantar list scenes NAME` shows what a scene's experiment has to show to be completed.

    Papers are presets: `--set paper=K` sets what a paper states of a scene; `plantar list papers K` lists it.

    Each setting is shown with its default, unit and range; `--set` and `--grid` take its dotted name. A default that
    grows with the robot is shown with its share: "70.02 N = 0.083 weight" for H1, or for `--robot`.

    Example: plantar list formats

    Example: plantar list settings estimator

    Example: plantar list papers K
    """
    if what is None:
        kinds = {
            "robots": "robots to walk, machines with skin",
            "scenes": "scenes to run: plantar sim",
            "papers": "papers whose methods and parameters --set paper=NAME switches on",
            "formats": "formats of recordings to analyse",
            "sources": "live sources of sole readings: plantar live",
            "settings": "settings to change with --set, of robots and scenes",
        }
        _print_names("kinds", kinds, as_json)
        return
    for given, words in ((name, "name"), (robot, "robot")):
        if given is not None and what != "settings" and (what, words) not in (("papers", "name"), ("scenes", "name")):
            raise InputError(f"'list {what}' takes no {words}, got '{given}'; allowed: plantar list settings NAME")
    if what == "settings":
        need_libraries("sim", "mujoco")
        from plantar.common.settings.overrides import setting_rows, setting_text
        from plantar.sim.run.setting_list import settings_of_robot

        found = settings_of_robot(name, robot)
        end_command({what: setting_rows(found)}, as_json, setting_text(found))
        return
    if name is not None and what == "scenes":
        from plantar.sim.run.listing import scene_row, scene_text

        row = scene_row(name)
        end_command({what: [row]}, as_json, scene_text(row))
        return
    if name is not None:
        from plantar.sim.papers.preset import paper_rows, paper_text

        end_command({what: paper_rows(name)}, as_json, paper_text(name))
        return
    from plantar.sim.run.listing import listed, scenes_by_group

    if what == "scenes":
        groups = scenes_by_group()
        rows = [
            {"name": name, "description": text, "group": group}
            for group, own in groups.items()
            for name, text in own.items()
        ]
        width = max(len(row["name"]) for row in rows)
        text = "\n".join(f"{group}\n{_lines(own, width, '  ')}" for group, own in groups.items())
        end_command({what: rows}, as_json, text)
        return
    _print_names(what, listed(what), as_json)


def _print_names(kind: str, found: dict[str, str], as_json: bool) -> None:
    width = max((len(name) for name in found), default=0)
    rows = [{"name": name, "description": text} for name, text in found.items()]
    end_command({kind: rows}, as_json, _lines(found, width))


def _lines(found: dict[str, str], width: int, before: str = "") -> str:
    return "\n".join(f"{before}{name:{width}}  {text}".rstrip() for name, text in found.items())


COMMAND = Command(list_, "List robots, scenes, papers, formats, sources or settings.", 80, name="list")
