"""Where a sole lies in the file or link that it was made from."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.arguments import instance
from plantar.common.arrays import array, numbers, own
from plantar.errors import LayoutError

_FARTHEST = 1000.0  # m from a file's origin
_ROUNDING = 1e-6  # of a rotation matrix


@dataclass(frozen=True, eq=False)
class SourcePose:
    """Pose of a sole's frame in the frame of the file or robot link that the sole came from.

    A point p of the sole frame lies at `position + rotation @ p` there.

    Attributes:
        file: Name of the file: mesh, drawing or robot's model.
        body: Body or link of a robot's model; None for a file's own axes.
        position: Sole origin (3,) in m.
        rotation: Rotation (3, 3) from the sole's frame to the source's.

    Raises:
        LayoutError: Invalid field, named in the message.

    Example:
        >>> pose = SourcePose("foot.stl", None, [0.0, 0.0, -0.1], np.eye(3))
        >>> pose.placed([[0.2, 0.0, 0.0]]).tolist()
        [[0.2, 0.0, -0.1]]
    """

    file: str
    body: str | None
    position: NDArray[np.float64]
    rotation: NDArray[np.float64]

    def __post_init__(self) -> None:
        kept = self.__dict__  # past what keeps others from assigning
        instance(self.file, str, "layout field 'pose.file'", LayoutError)
        if self.body is not None:
            instance(self.body, str, "layout field 'pose.body'", LayoutError)
        for name, shape in (("position", (3,)), ("rotation", (3, 3))):
            what = f"layout field 'pose.{name}'"
            kept[name] = own(array(numbers(getattr(self, name), what, LayoutError), what, shape, LayoutError))
            if not (np.abs(kept[name]) < _FARTHEST).all():
                raise LayoutError(f"{what} is not finite, or farther than {_FARTHEST:g} m")
        gram = self.rotation @ self.rotation.T
        if np.abs(gram - np.eye(3)).max() > _ROUNDING or np.linalg.det(self.rotation) < 0.0:
            raise LayoutError("layout field 'pose.rotation' is not a rotation")

    def placed(self, points: Any) -> NDArray[np.float64]:
        """Points (..., 3) of the sole frame in the source's frame, in m."""
        return np.asarray(self.position + np.asarray(points, dtype=np.float64) @ self.rotation.T)

    def lowered(self, height: float) -> "SourcePose":
        """Pose of a frame that lies so far in m below this one."""
        return SourcePose(self.file, self.body, self.position - height * self.rotation[:, 2], self.rotation)

    def as_dict(self) -> dict[str, Any]:
        """Plain JSON values in SI."""
        return {
            "file": self.file,
            "body": self.body,
            "position": self.position.tolist(),
            "rotation_sole_to_source": self.rotation.tolist(),
        }

    @classmethod
    def from_mapping(cls, source: Any, where: str) -> "SourcePose":
        """Pose from the values of `as_dict`.

        Raises:
            LayoutError: If a field is missing or invalid; `where` names the source.
        """
        keys = ("file", "body", "position", "rotation_sole_to_source")
        if not isinstance(source, Mapping):
            raise LayoutError(f"{where}: field 'pose' is not a JSON object")
        missing = [key for key in keys if key not in source]
        if missing:
            raise LayoutError(f"{where}: field 'pose.{missing[0]}' is missing")
        return cls(*(source[key] for key in keys))
