"""What the path of a swing foot has to keep."""

import numpy as np

from plantar.gait.feet.swing_kind import Swing, SwingKind, SwingStart

_PERIOD = 0.005  # s of control
_NEAR = 1e-3  # m that begin and end may be off their places
_FASTEST = 20.0  # mean speeds of the swing, which no smooth path of a step exceeds in a control period
_RISEN = 1e-6  # share by which rounding may lower what has risen


def check_swing(kind: SwingKind) -> list[str]:
    """What a kind of swing lacks, a sentence each; empty if nothing.

    Args:
        kind: An instance of its class, with its settings.

    Returns:
        The sentences.
    """
    name = type(kind).__name__
    lacks = [] if kind.table else [f"{name} states no table: class {name}(SwingKind, table='x')"]
    if "control.swing_shape" not in kind.needs:
        lacks.append("needs does not state control.swing_shape, by which scenes choose it")
    for height, duration, length in ((0.05, 0.9, 0.2), (0.1, 0.35, 0.5), (0.02, 1.4, 0.0)):
        start = SwingStart(
            position=np.array([0.0, 0.1, 0.0]),
            yaw=0.0,
            end=np.array([length, 0.1, 0.01]),
            yaw_end=0.1,
            height=height,
            duration=duration,
            period=_PERIOD,
            least_time=0.1,
        )
        where = f"with {length:g} m in {duration:g} s"
        lacks += [f"{where}: {text}" for text in _lacks_of_path(kind.begin(start), start)]
    return lacks


def _lacks_of_path(swing: Swing, start: SwingStart) -> list[str]:
    times = np.arange(0.0, start.duration + 0.5 * _PERIOD, _PERIOD)
    places = [swing.at(float(time))[0] for time in times]
    risen = np.array([swing.risen(float(time)) for time in times])
    path = np.array(places, dtype=float)
    if path.shape != (len(times), 3) or not np.isfinite(path).all():
        return ["at() returns no finite place (3,)"]
    lacks = []
    if np.linalg.norm(path[0] - start.position) > _NEAR:
        lacks.append(f"at(0) is {1e3 * np.linalg.norm(path[0] - start.position):.1f} mm off the place of lift-off")
    if np.linalg.norm(path[-1, :2] - start.end[:2]) > _NEAR:
        lacks.append(f"at its end it is {1e3 * np.linalg.norm(path[-1, :2] - start.end[:2]):.1f} mm beside its target")
    way = np.linalg.norm(start.end - start.position) + 2.0 * start.height
    steps = np.linalg.norm(np.diff(path, axis=0), axis=1)
    if steps.max() > _FASTEST * way * _PERIOD / start.duration:
        at = float(times[int(steps.argmax())])
        lacks.append(f"the foot jumps by {1e3 * steps.max():.0f} mm within a control period at {at:.2f} s")
    if path[:, 2].max() < max(start.position[2], start.end[2]) + 0.5 * start.height:
        lacks.append(f"the foot rises to {1e3 * path[:, 2].max():.0f} mm, less than half of the clearance")
    if not ((risen >= -_RISEN) & (risen <= 1.0 + _RISEN)).all() or (np.diff(risen) < -_RISEN).any():
        lacks.append("risen() leaves 0 to 1, or falls")
    if swing.comes_down(0.0) or not swing.comes_down(start.duration):
        lacks.append("comes_down() is true at lift-off, or false at touchdown")
    return lacks + _lacks_of_aim(swing, start)


def _lacks_of_aim(swing: Swing, start: SwingStart) -> list[str]:
    """A foothold that is found moves the end in the middle of the swing: the foot goes there without a jump."""
    time = 0.5 * start.duration
    place = start.end[:2] + np.array([0.03, -0.02])
    before = swing.at(time)[0]
    aimed = swing.aimed(time, place, start.yaw_end, start.duration + 0.1)
    lacks = []
    jump = float(np.linalg.norm(aimed.at(time)[0] - before))
    if jump > _NEAR:
        lacks.append(f"aimed() makes the foot jump by {1e3 * jump:.0f} mm at the time that it is given")
    if np.linalg.norm(aimed.at(start.duration + 0.1)[0][:2] - place) > _NEAR:
        lacks.append("aimed() does not end at the place that it is given")
    if abs(aimed.duration - start.duration - 0.1) > 1e-9:
        lacks.append("aimed() does not take the duration that it is given")
    return lacks
