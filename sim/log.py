"""What a run records: the topics of its MCAP file."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gait.controller import Command, Sensors
from plantar.layout import Side
from plantar.reading import Reading
from plantar.recorder import Recorder
from sim.contact_truth import GroundTruth
from sim.world import World

__all__ = ["RunLog"]

_SIDES: tuple[Side, Side] = ("left", "right")
_NAN2 = np.full(2, np.nan)


class RunLog:
    """Writes a run's recording. Use as a context manager.

    Args:
        path: MCAP file to write.
        world: The world.
        metadata: What identifies the run.
    """

    def __init__(self, path: Path, world: World, metadata: Mapping[str, object]) -> None:
        k = len(world.servos)
        self._world = world
        self._recorder = Recorder(path, metadata, {s: world.robot.layouts[s] for s in _SIDES})
        channel = self._recorder.channel
        self._skin = {s: channel(f"/skin/{s}", [("force", len(world.robot.layouts[s]))]) for s in _SIDES}
        self._joints = channel("/joints", [("position", k), ("command", k), ("torque", k)])
        self._estimate = channel("/estimate", [("com", 3), ("com_velocity", 3), ("dcm", 2), ("zmp", 2)])
        self._reference = channel(
            "/reference", [("com", 3), ("dcm", 2), ("zmp", 2), ("zmp_desired", 2), ("phase", 1), ("step", 1)]
        )
        self._truth = {
            s: channel(f"/truth/{s}", [("normal_force", 1), ("position", 3), ("rotation", 9)]) for s in _SIDES
        }
        self._body = channel("/truth/body", [("com", 3), ("zmp", 2), ("zmp_margin", 1), ("rotation", 9), ("wrench", 6)])

    def __enter__(self) -> RunLog:
        self._recorder.__enter__()
        return self

    def __exit__(self, *error: Any) -> None:
        self._recorder.__exit__(*error)

    def skin(self, readings: Mapping[Side, Reading]) -> None:
        """Record the soles' latest readings at the time of their samples."""
        for side, channel in self._skin.items():
            channel.write(readings[side].time, readings[side].force)

    def tick(self, sensors: Sensors, command: Command, joints: NDArray[np.float64], truth: GroundTruth) -> None:
        """Record one control tick."""
        w, time = self._world, sensors.time
        data, state, reference = w.data, command.state, command.reference
        self._joints.write(time, np.concatenate([sensors.joint_positions, joints, data.actuator_force[w.servos]]))
        zmp = _NAN2 if state.zmp is None else state.zmp
        self._estimate.write(time, np.concatenate([state.com, state.com_velocity, command.dcm, zmp]))
        self._reference.write(
            time,
            np.concatenate(
                [
                    command.com,
                    reference.dcm,
                    reference.vrp,
                    command.zmp_desired,
                    (float(command.phase.kind), float(command.phase.step)),
                ]
            ),
        )
        for side, channel in self._truth.items():
            site = w.sole_sites[side]
            channel.write(
                time,
                np.concatenate(
                    [data.sensordata[w.touch[side] : w.touch[side] + 1], data.site_xpos[site], data.site_xmat[site]]
                ),
            )
        self._body.write(
            time,
            np.concatenate(
                [
                    data.subtree_com[w.torso],
                    _NAN2 if truth.zmp is None else truth.zmp,
                    (np.nan if truth.margin is None else truth.margin,),
                    data.xmat[w.torso],
                    truth.wrench,
                ]
            ),
        )
