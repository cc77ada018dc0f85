"""Differences of the true plant from the controller's model, as a scene's `[plant]` table gives them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Self

from plantar.errors import InputError, PlantarError
from plantar.settings.schema import Settings, choice, number, tables

__all__ = ["EVERYTHING", "RANDOM", "STATED", "Plant"]

RANDOM = "random"
"""The word in place of a number that the seed draws."""

EVERYTHING = "everything"
"""What draws all items, those of wear and of poor ground, too."""

_LAST_OF_CARE = "actuation_delay"
"""The last of the items that a robot has that was built and calibrated with care; wear and poor ground follow."""

STATED = ("joint_damping", "corner_speed")
"""Items that no seed draws."""

_WORDS = (RANDOM,)
_LARGEST = {"gyro_bias": ("rad/s", 1.0), "com_offset": ("m", 0.5)}
"""Unit and largest size of a component of each list of three."""


class Plant(Settings):
    """Differences of the true plant from the controller's model; none by default.

    Each may be a number, or "random": then the seed draws it from a range that grows with `level`
    (`plantar.sim.plant.draw.RANGES`). They apply to robot, sensors and ground; the controller does not receive them.

    Attributes:
        draw: "random" draws what a carefully built and calibrated robot has (all down to `actuation_delay`), as far as
            the table does not state it: `plant = "random"` in a scene, `--set plant=random`. "everything" also draws
            wear and poor ground.
        level: Size of what is drawn, in proportion: 2 is a robot built and calibrated with ordinary care, 1 half of
            that; 0 is nominal.
        gyro_bias: Offset of the gyro about each of its axes, [x, y, z] in rad/s.
        com_offset: Offset of the upper body's centre of mass (all that is fixed to the torso), [forward, left, up] in
            the torso's frame in m.
        mass_ratio: True mass over the model's, of each link; inertias scale with it.
        encoder_offset: Error of the joints' zeros: each joint's is drawn up to this, either way. Its servo follows the
            same encoder.
        stiffness_ratio: True stiffness of the servos over the model's; their damping is the model's.
        friction_ratio: True coefficient of friction of the ground over the scene's.
        softness: Time constant in s with which the ground yields, in series with that of the contact.
        taxel_gain: Standard deviation of the taxels' gains about 1, drawn for each, at most 0.9 either way.
        crosstalk: Share of each taxel's force that its neighbours read instead, in equal parts; the sum stays.
        sensor_delay: Time in s from a reading of encoders, IMU, ankles and soles until the controller has it, rounded
            up to a control tick; added to `sensing.delay_periods`.
        actuation_delay: Time in s from a set-point until its servo follows it, rounded up to a physics step.
        joint_friction: Dry friction of each leg joint in N m, added to the model's.
        backlash: Play of each leg joint's gear, in which it passes no torque.
        torque_ripple: Share by which a servo's torque varies as its joint turns, with the teeth of its gear.
        hysteresis: Share by which a taxel reads too little under rising load, and too much under falling load.
        taxel_drift: Standard deviation in N of the taxels' drifts as they warm up, within minutes; drawn for each.
        dropout: Share of the time for which each connector of the soles has no contact, a tenth of a second at a time:
            its taxels are silent.
        rubber: Thickness in m of a layer of foam at the bottom of each sole, within its height: it yields, and spreads
            the pressure at edges and points by as much.
        patchiness: Share by which friction and softness of the ground may be lower from one of its pieces (floor,
            stone, beam) to the next; drawn for each.
        reflectance: Share by which patches of the ground may be lighter or darker than in the proximity sensors'
            calibration; drawn for each. Dark ground appears farther away.
        joint_damping: Viscous friction of each leg joint's gear, added to the model's; stated only.
        corner_speed: Share of a joint's speed limit up to which its motor has its full torque, which falls to zero at
            the limit; 1 for full torque at any speed. Stated only, for robots whose files give both limits.
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

    joint_damping: float = number(0.0, "N m s/rad", 0, 100)
    corner_speed: float = number(1.0, "1", 0, 1)

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
        if draw == EVERYTHING:
            return cls.items()
        return cls.items()[: cls.items().index(_LAST_OF_CARE) + 1] if draw == RANDOM else ()

    @classmethod
    def items(cls) -> tuple[str, ...]:
        """Names of the items that a seed may draw."""
        return tuple(name for name in cls.names()[2:] if name not in STATED)

    @classmethod
    def from_table(cls, table: Any, where: str, error: type[PlantarError] = InputError, note: str = "") -> Self:
        """Make the settings from a table; stated values stay as stated, also if nominal, where `draw` draws the rest.

        Args:
            table: Values by name.
            where: Name of the table, for messages.
            error: Error class to raise.
            note: What decides on the allowed keys, for messages.

        Returns:
            The settings.

        Raises:
            PlantarError: Of the class `error`: a key is unknown or a value not allowed; the message names it.
        """
        if isinstance(table, Mapping) and (drawn := cls._drawn_by(table.get("draw"))):
            table = {**dict.fromkeys(drawn, RANDOM), **table, "draw": "nominal"}
        return super().from_table(table, where, error, note)

    def vector(self, name: str) -> tuple[float, ...]:
        """Three numbers in SI for the body that the settings apply to.

        Args:
            name: Name of the setting, which is not "random".

        Returns:
            The numbers; zeros where none are given, or the seed draws them.

        Raises:
            InputError: If there are not three of them, or one is not a number in its range.
        """
        values, (unit, most) = getattr(self, name), _LARGEST[name]
        if not values or values == RANDOM:
            return (0.0, 0.0, 0.0)
        found = [self.in_si(value, unit, f"setting '{name}'") for value in values]
        numbers = [v for v in found if isinstance(v, int | float) and not isinstance(v, bool) and abs(v) <= most]
        if not len(numbers) == len(found) == 3:
            allowed = f'three numbers of -{most:g} to {most:g} {unit}, or "random"'
            raise InputError(f"setting '{name}' is {list(values)!r}; allowed: {allowed}")
        return tuple(map(float, numbers))
