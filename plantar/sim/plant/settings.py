"""In what the true plant differs from the controller's model, as a scene's `[plant]` table gives it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, Self

from plantar.errors import InputError, PlantarError
from plantar.settings.schema import Settings, choice, number, tables

__all__ = ["EVERYTHING", "RANDOM", "Plant"]

RANDOM = "random"
"""The word in place of a number that the seed draws."""

EVERYTHING = "everything"
"""What draws all items, those of wear and of poor ground, too."""

_LAST_OF_CARE = "actuation_delay"
"""The last of the items that a robot has that was built and calibrated with care; wear and poor ground follow."""

_WORDS = (RANDOM,)
_LARGEST = {"gyro_bias": ("rad/s", 1.0), "com_offset": ("m", 0.5)}
"""Unit and largest size of a component of each list of three."""


class Plant(Settings):
    """In what the true plant differs from the model that the controller has of it; by default not at all.

    Each may be a number, or "random": then the seed draws it from a range that grows with `level`
    (`plantar.sim.plant.draw.RANGES`). Robot, sensors and ground are made so; the controller gets none of it.

    Attributes:
        draw: With "random" what a robot has that was built and calibrated with care is drawn, as far as the table does
            not state it (all down to `actuation_delay`): `plant = "random"` in a scene, `--set plant=random`. With
            "everything" all items are, those of wear and of poor ground, too. It stands for "random" at each of these,
            and settings that are made of it say so there.
        level: How much what is drawn may differ, in proportion: 2 is a robot that was built and calibrated with
            ordinary care, 1 half of that, 3 half more; 0 is nominal.
        gyro_bias: What the gyro reads too much about each of its axes, [x, y, z] in rad/s.
        com_offset: By how much the centre of mass of the upper body (all that is fixed to the torso) is elsewhere,
            [forward, left, up] in the torso's frame in m.
        mass_ratio: True mass over the model's, of each link; inertias go with it.
        encoder_offset: Error of the joints' zeros: each joint's is drawn up to this, either way. Its servo goes by the
            same encoder.
        stiffness_ratio: True stiffness of the servos over the model's; their damping is the model's.
        friction_ratio: True coefficient of friction of the ground over the scene's.
        softness: Time constant in s with which the ground yields, in series with that of the contact.
        taxel_gain: Standard deviation of the taxels' gains about 1; each one's is drawn, at most 0.9 either way.
        crosstalk: Share of each taxel's force that its neighbours read instead, each as much; the sum stays.
        sensor_delay: Time in s from when encoders, IMU, ankles and soles are read until the controller has it, up to
            the next control tick; it comes on top of `sensing.delay_periods`.
        actuation_delay: Time in s from a set-point until its servo follows it, to the next physics step.
        joint_friction: Dry friction of each leg joint in N m, added to the model's.
        backlash: Play of each leg joint's gear: so far it moves from one flank to the other while no torque passes.
        torque_ripple: Share by which a servo's torque swings as its joint turns, with the teeth of its gear.
        hysteresis: Share by which a taxel reads too little while its load comes on, and too much while it goes off.
        taxel_drift: Standard deviation in N of what the taxels' zeros wander off to as they become warm, within
            minutes; each one's is drawn.
        dropout: Share of the time for which each connector of the soles has no contact, a tenth of a second at a time:
            its taxels are silent.
        rubber: Thickness in m of a layer of foam that each sole ends in, within the height that it has: it yields, and
            what presses on an edge or a point spreads over that much more.
        patchiness: Share by which friction and softness of the ground may be less from one of its pieces (floor, stone,
            beam) to the next; each one's is drawn.
        reflectance: Share by which patches of the ground may be lighter or darker than what the proximity sensors were
            calibrated on; each one's is drawn. What is dark seems farther away.
    """

    draw: str = choice("nominal", RANDOM, EVERYTHING)
    level: float = number(2.0, "1", 0, 3)
    gyro_bias: tuple[float, ...] | str = tables("a list [x, y, z] of -1 to 1 rad/s", _WORDS)
    com_offset: tuple[float | str, ...] | str = tables("a list [forward, left, up] of -0.5 to 0.5 m", _WORDS)
    mass_ratio: float | str = number(1.0, "1", 0.5, 2.0, _WORDS)
    encoder_offset: float | str = number(0.0, "deg", 0, 10, _WORDS)
    stiffness_ratio: float | str = number(1.0, "1", 0.05, 5, _WORDS)
    friction_ratio: float | str = number(1.0, "1", 0.01, 5, _WORDS)
    softness: float | str = number(0.0, "s", 0, 0.2, _WORDS)
    taxel_gain: float | str = number(0.0, "1", 0, 1, _WORDS)
    crosstalk: float | str = number(0.0, "1", 0, 0.9, _WORDS)
    sensor_delay: float | str = number(0.0, "s", 0, 0.1, _WORDS)
    actuation_delay: float | str = number(0.0, "s", 0, 0.1, _WORDS)
    joint_friction: float | str = number(0.0, "N m", 0, 100, _WORDS)
    backlash: float | str = number(0.0, "deg", 0, 5, _WORDS)
    torque_ripple: float | str = number(0.0, "1", 0, 0.9, _WORDS)
    hysteresis: float | str = number(0.0, "1", 0, 0.9, _WORDS)
    taxel_drift: float | str = number(0.0, "N", 0, 100, _WORDS)
    dropout: float | str = number(0.0, "1", 0, 0.5, _WORDS)
    rubber: float | str = number(0.0, "m", 0, 0.05, _WORDS)
    patchiness: float | str = number(0.0, "1", 0, 0.95, _WORDS)
    reflectance: float | str = number(0.0, "1", 0, 0.95, _WORDS)

    def __post_init__(self) -> None:
        super().__post_init__()
        for name in _LARGEST:
            self.vector(name)
        for name in self._drawn_by(self.draw):
            if getattr(self, name) == self.__dataclass_fields__[name].default:
                object.__setattr__(self, name, RANDOM)
        object.__setattr__(self, "draw", "nominal")

    @classmethod
    def _drawn_by(cls, draw: Any) -> tuple[str, ...]:
        """Names of what a value of `draw` draws."""
        if draw == EVERYTHING:
            return cls.items()
        return cls.items()[: cls.items().index(_LAST_OF_CARE) + 1] if draw == RANDOM else ()

    @classmethod
    def items(cls) -> tuple[str, ...]:
        """Names of what may differ."""
        return cls.names()[2:]

    @classmethod
    def from_table(cls, table: Any, where: str, error: type[PlantarError] = InputError, note: str = "") -> Self:
        """Make the settings from a table; where `draw` draws the rest, what it states stays as stated, also if nominal.

        Args:
            table: Values by name.
            where: Name of the table, for messages.
            error: What is raised.
            note: On what it depends which keys are allowed, for messages.

        Returns:
            The settings.

        Raises:
            PlantarError: Of the class `error`: a key is unknown or a value not allowed; the message names it.
        """
        if isinstance(table, Mapping) and (drawn := cls._drawn_by(table.get("draw"))):
            table = {**dict.fromkeys(drawn, RANDOM), **table, "draw": "nominal"}
        return super().from_table(table, where, error, note)

    def vector(self, name: str) -> tuple[float, ...]:
        """A list of three numbers in SI for the body that the settings count for.

        Args:
            name: Name of the setting, which is not "random".

        Returns:
            The numbers; zeros where none are given, and where the seed draws them.

        Raises:
            InputError: If there are not three of them, or one is not a number in its range.
        """
        values, (unit, most) = getattr(self, name), _LARGEST[name]
        if not values or values == RANDOM:
            return (0.0, 0.0, 0.0)
        found = [self.in_si(value, unit, f"setting '{name}'") for value in values]
        good = len(found) == 3 and all(_is_number(value) and abs(value) <= most for value in found)
        if not good:
            allowed = f'three numbers of -{most:g} to {most:g} {unit}, or "random"'
            raise InputError(f"setting '{name}' is {list(values)!r}; allowed: {allowed}")
        return tuple(float(value) for value in found)


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
