"""What a part of your own imports: settings that check themselves, and a command with its ending.

The class that each kind of part derives from lies in its room (`docs/tutorials/part.md`).

    Settings                     a table of settings: derive, and make its fields by the functions below
    Part                         settings of a part of the controller, with the switch that puts it in use
    number, whole, choice, switch, text, tables
                                 one field: default, unit, range or choices
    Command, Json, end_command   a command of `plantar`
"""

from plantar.common.console.command import Command, Json, end_command
from plantar.common.settings.part import Part
from plantar.common.settings.schema import Settings, choice, number, switch, tables, text, whole

__all__ = [
    "Command",
    "Json",
    "Part",
    "Settings",
    "choice",
    "end_command",
    "number",
    "switch",
    "tables",
    "text",
    "whole",
]
