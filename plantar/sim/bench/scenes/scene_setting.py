"""What `plantar bench scenes` changes of a scene, one at a time."""

from dataclasses import dataclass

CONTACT_TIME = 0.005
"""Time constant in s of contacts at the scenes' own physics step of 1 ms."""


@dataclass(frozen=True)
class SceneSetting:
    """One way to run a scene.

    Attributes:
        settings: Of the scene, as `key=value`.
        contact_time: Time constant in s of contacts, or None.
        iterations: Most iterations of MuJoCo's solver, or None.
        cell_ratio: Area of taxels over the robot's own.
        machine: Whether it is another robot (its skin, its clock).
        quick: Whether quick runs have it.
    """

    knob: str
    value: str
    settings: tuple[str, ...] = ()
    contact_time: float | None = None
    iterations: int | None = None
    cell_ratio: float = 1.0
    against: str = "reference"
    machine: bool = False
    quick: bool = False

    @property
    def name(self) -> str:
        """Knob and value: what a row is called."""
        return f"{self.knob}: {self.value}" if self.value else self.knob


def _step(period: float, *, held: bool, quick: bool = False) -> SceneSetting:
    knob = "physics step" if held else "physics step and contact"
    kept = CONTACT_TIME if held else None
    value = f"{1e3 * period:.3g} ms"
    return SceneSetting(knob, value, (f"control.physics_period={period!r}",), contact_time=kept, quick=quick)


def _machine(knob: str, value: str, finest: str, *settings: str, ratio: float = 1.0, quick: bool) -> SceneSetting:
    against = f"{knob}: {finest}"
    return SceneSetting(knob, value, settings, cell_ratio=ratio, against=against, machine=True, quick=quick)


OWN = SceneSetting("scene's own", "", quick=True)
"""The scene as it is."""

REFERENCE = SceneSetting(
    "reference", "", ("control.physics_period=0.0001",), contact_time=CONTACT_TIME, iterations=100, quick=True
)
"""The same robot on the same contact, in steps of 0.1 ms whose contact forces are solved to the end."""

SETTINGS: tuple[SceneSetting, ...] = (
    OWN,
    REFERENCE,
    _step(0.005 / 3, held=True, quick=True),
    _step(0.0005, held=True, quick=True),
    _step(0.00025, held=True),
    _step(0.005 / 3, held=False, quick=True),
    _step(0.0005, held=False),
    SceneSetting("contact time", "2.5 ms", contact_time=0.0025),
    SceneSetting("contact time", "10 ms", contact_time=0.01),
    SceneSetting("contact time", "20 ms", contact_time=0.02, quick=True),
    SceneSetting("solver iterations", "1", iterations=1, quick=True),
    SceneSetting("solver iterations", "2", iterations=2),
    SceneSetting("solver iterations", "5", iterations=5),
    SceneSetting("coarse", "1.67 ms, 2 iterations", _step(0.005 / 3, held=True).settings, CONTACT_TIME, 2, quick=True),
    *(
        _machine("skin rate", f"{rate} Hz", "1000 Hz", f"sensing.skin_rate={rate}", quick=rate in (1000, 125))
        for rate in (1000, 500, 125, 50)
    ),
    *(
        _machine("control rate", f"{rate} Hz", "1000 Hz", f"control.period={1 / rate}", quick=rate in (1000, 100))
        for rate in (1000, 500, 100)
    ),
    *(
        _machine("taxel area", value, "a quarter", ratio=ratio, quick=ratio != 2.0)
        for value, ratio in (("a quarter", 0.25), ("twice", 2.0), ("four times", 4.0))
    ),
    _machine("taxel model", "elastic layer", "elastic layer", "sensing.taxels=elastic", quick=False),
)
"""All of them, the scene's own first. Knobs of the machine are compared with their own finest value."""


def setting_named(name: str) -> SceneSetting:
    """The setting of a name; a KeyError for none.

    Example:
        >>> setting_named("skin rate: 125 Hz").against
        'skin rate: 1000 Hz'
    """
    return {setting.name: setting for setting in SETTINGS}[name]
