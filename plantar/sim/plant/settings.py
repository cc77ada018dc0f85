"""A scene's `[plant]` table: differences of the true plant from the controller's model."""

from collections.abc import Mapping
from typing import Any, Self

from plantar.common.settings.schema import Settings, choice, number, tables
from plantar.errors import InputError, PlantarError

RANDOM = "random"
"""The word in place of a number that the seed draws."""

EVERYTHING = "everything"
"""What draws all items, those of wear and of poor ground, too."""

# The last of the items that a robot has that was built and calibrated with care; wear and poor ground follow
_LAST_OF_CARE = "actuation_delay"

STATED = ("joint_damping", "corner_speed", "load", "load_place")
"""Items that no seed draws."""

_WORDS = (RANDOM,)
# Unit and largest size of a component of each list of three
_LARGEST = {"gyro_bias": ("rad/s", 1.0), "com_offset": ("m", 0.5), "load_place": ("m", 1.0)}


class Plant(Settings):
    """Differences of the true plant; none by default.

    Each is a number, or "random": drawn from a range that grows with `level` (`plantar.sim.plant.draw.RANGES`). The
    controller does not receive them.

    Attributes:
        draw: "random" draws what the table does not state, down to `actuation_delay`, as of a calibrated robot (`--set
            plant=random`); "everything" also wear and poor ground.
        level: Size of what is drawn: 2 for ordinary care, 1 half of that, 0 nominal.
        gyro_bias: Offset [x, y, z] in rad/s.
        com_offset: Offset of the upper body's CoM, [forward, left, up] in the torso's frame in m.
        mass_ratio: True over model mass of each link; inertias scale alike.
        encoder_offset: Largest zero error of each joint, either way; its servo follows that encoder.
        stiffness_ratio: True over model stiffness of the servos, at the same damping.
        friction_ratio: True over scene's ground friction.
        softness: Ground's time constant in s, in series with the contact's.
        taxel_gain: Standard deviation about 1 of each taxel's gain, at most 0.9 either way.
        crosstalk: Share of a taxel's force that its neighbours read in equal parts.
        sensor_delay: Time in s from any reading to the controller, rounded up to a control tick; added to
            `sensing.delay_periods`.
        actuation_delay: Time in s from set-point to servo, rounded up to a physics step.
        joint_friction: Added dry friction of each leg joint in N m.
        backlash: Torque-free play of each leg gear.
        torque_ripple: Share by which servo torque varies with the gear's teeth.
        hysteresis: Share that taxels read too little under rising load, too much under falling.
        taxel_drift: Standard deviation in N of each taxel's warm-up drift, within minutes.
        dropout: Share of time without contact at each sole connector, 0.1 s at a time: its taxels are silent.
        rubber: Thickness in m of foam within each sole's height: it yields, and spreads pressure at edges by as much.
        patchiness: Share by which ground pieces (floor, stone, beam) may be lower in friction and softness.
        reflectance: Share by which ground patches may be lighter, or darker (appearing farther), than in calibration.
        joint_damping: Added viscous friction of each leg gear; stated only.
        corner_speed: Share of a speed limit up to which torque is full, falling to zero at the limit; 1: always full.
            Stated only, for robots with both limits.
        load: Share of the robot's mass that the torso carries besides; stated only.
        load_place: Its [forward, left, up] in m from the torso's CoM.
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
    load: float = number(0.0, "1", 0, 0.5)
    load_place: tuple[float | str, ...] = tables("a list [forward, left, up] of -1 to 1 m")

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
        """Items that a seed may draw."""
        return tuple(name for name in cls.names()[2:] if name not in STATED)

    @classmethod
    def from_table(cls, table: Any, where: str, error: type[PlantarError] = InputError, note: str = "") -> Self:
        """Returns the settings of a `table`; `draw` draws only what is not stated.

        Raises `error` for an invalid key or value, with the table's name, `where`, and a `note` on what decides on
        keys.
        """
        if isinstance(table, Mapping) and (drawn := cls._drawn_by(table.get("draw"))):
            table = {**dict.fromkeys(drawn, RANDOM), **table, "draw": "nominal"}
        return super().from_table(table, where, error, note)

    def vector(self, name: str) -> tuple[float, ...]:
        """Three numbers in SI for the settings' body.

        `name`: setting that is not "random". Returns the numbers; zeros where not given or drawn.
        """
        values = getattr(self, name)
        unit, most = _LARGEST[name]
        if not values or values == RANDOM:
            return (0.0, 0.0, 0.0)
        found = [self.in_si(value, unit, f"setting '{name}'") for value in values]
        numbers = [v for v in found if isinstance(v, int | float) and not isinstance(v, bool) and abs(v) <= most]
        if not len(numbers) == len(found) == 3:
            allowed = f'three numbers of -{most:g} to {most:g} {unit}, or "random"'
            raise InputError(f"setting '{name}' is {list(values)!r}; allowed: {allowed}")
        return tuple(map(float, numbers))
