"""Skin on a body's links: taxels, and wrenches of their readings."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.common.arrays import array
from plantar.errors import InputError, LayoutError
from plantar.sensing.body_skin import skin_wrench


@dataclass(frozen=True)
class SkinPatch:
    """Taxels on one link (T 3.14-3.15), z into the body.

    `positions`: taxel positions (t, 3) in link's frame in m; `rotations`: rotations (t, 3, 3) from each taxel's to
    link's frame; `areas`: area (t,) of each taxel in m^2; `force_threshold`: epsilon_f of T 3.23 in N;
    `proximity_range`: d_range of T 3.30 in m; 0 for none; `neighbours`: indices of taxels beside each, if known.
    """

    name: str
    link: str
    positions: NDArray[np.float64]
    rotations: NDArray[np.float64]
    areas: NDArray[np.float64]
    force_threshold: float = 0.15  # chosen: above the drift of a cell, below the touch of a finger
    proximity_range: float = 0.05  # nature: T 4.2.1
    neighbours: tuple[tuple[int, ...], ...] = ()

    def __post_init__(self) -> None:
        where = f"patch '{self.name}'"
        positions = array(self.positions, f"{where}: positions", ("t", 3), LayoutError, finite=True)
        count = len(positions)
        rotations = array(self.rotations, f"{where}: rotations", (count, 3, 3), LayoutError, finite=True)
        areas = array(self.areas, f"{where}: areas", (count,), LayoutError, finite=True)
        if count == 0:
            raise LayoutError(f"{where} has no taxels; it needs one at least")
        if not (areas > 0.0).all():
            raise LayoutError(f"{where}: an area is {areas.min():g} m^2; allowed: above 0")
        # nature: floating point of single precision, in which a file may hold a rotation
        if not np.allclose(rotations @ rotations.transpose(0, 2, 1), np.eye(3), atol=1e-6):
            raise LayoutError(f"{where}: a rotation is not orthonormal")
        for label, value, unit in (
            ("force threshold", self.force_threshold, "N"),
            ("proximity range", self.proximity_range, "m"),
        ):
            if not (np.isfinite(value) and value >= 0.0):
                raise LayoutError(f"{where}: {label} is {value} {unit}; allowed: 0 or more")
        if self.neighbours and (
            len(self.neighbours) != count or not all(0 <= i < count for near in self.neighbours for i in near)
        ):
            raise LayoutError(
                f"{where}: neighbours name no taxel or are not one row a taxel; allowed: 0 to {count - 1}"
            )
        for name, checked in (("positions", positions), ("rotations", rotations), ("areas", areas)):
            object.__setattr__(self, name, checked)

    def __len__(self) -> int:
        return len(self.positions)

    def named(self, name: str) -> "SkinPatch":
        """The same patch by another name."""
        return replace(self, name=name)

    @property
    def is_flat(self) -> bool:
        """Whether every taxel's axes are those of the link."""
        return bool((self.rotations == np.eye(3)).all())

    @property
    def from_middle(self) -> NDArray[np.int64]:
        """Indices (t,) of the taxels, nearest to the patch's middle first."""
        return np.asarray(np.argsort(np.linalg.norm(self.positions - self.positions.mean(axis=0), axis=1)))


class BodySkin:
    """All taxels of a body, link by link: a link's taxels are one slice.

    `patches`: patches, any number a link; LayoutError for none, or two of one name.

    Attributes:
        patches: Patches, sorted by link.
        link_of: Index (N,) of each taxel's link in `links`.
        positions: Taxel positions (N, 3) in their link's frame in m.
        normals: Direction (N, 3) into body in link's frame.
        areas: Taxel areas (N,) in m^2.
        thresholds: Force threshold (N,) in N.
        ranges: Proximity range (N,) in m.
        unit_wrenches: Wrench (N, 6) about link's origin of 1 N on each taxel (T 3.16), in link's frame.
    """

    def __init__(self, patches: Sequence[SkinPatch]) -> None:
        if not patches:
            raise LayoutError("a skin has no patches; it needs one at least")
        self.patches = tuple(sorted(patches, key=lambda p: p.link))
        names = [p.name for p in self.patches]
        for name in names:
            if names.count(name) > 1:
                raise LayoutError(f"two patches are called '{name}'; each needs a name of its own")
        self.links = tuple(dict.fromkeys(p.link for p in self.patches))
        counts = [len(p) for p in self.patches]
        self.link_of = np.repeat([self.links.index(p.link) for p in self.patches], counts)
        ends = np.cumsum(counts).tolist()
        self.slices = {
            p.name: slice(end - count, end) for p, end, count in zip(self.patches, ends, counts, strict=True)
        }
        self.positions = np.vstack([p.positions for p in self.patches])
        rotations = np.vstack([p.rotations for p in self.patches])
        self.normals = np.ascontiguousarray(rotations[:, :, 2])
        self.areas = np.hstack([p.areas for p in self.patches])
        self.thresholds = np.repeat([p.force_threshold for p in self.patches], counts)
        self.ranges = np.repeat([p.proximity_range for p in self.patches], counts)
        self.unit_wrenches = skin_wrench(self.positions, rotations, np.eye(len(self.positions)))

    def __len__(self) -> int:
        return len(self.positions)

    def patch(self, name: str) -> SkinPatch:
        """Patch of a name; InputError without."""
        found = next((p for p in self.patches if p.name == name), None)
        if found is None:
            raise InputError(f"no patch is called '{name}'; allowed: {', '.join(self.slices)}")
        return found

    def taxels_of(self, patches: Sequence[str] | None) -> NDArray[np.bool_]:
        """Mask (N,) of some patches' taxels; all if None; InputError for unknown names."""
        if patches is None:
            return np.ones(len(self), dtype=bool)
        found = np.zeros(len(self), dtype=bool)
        for name in patches:
            found[self.slices[self.patch(name).name]] = True
        return found


class LinkWrench(NamedTuple):
    """Wrench (6,) of a link's active taxels, about its origin in its frame, by the world on the robot."""

    link: str
    wrench: NDArray[np.float64]
    taxels: NDArray[np.int64]


def link_wrenches(skin: BodySkin, signal: NDArray[np.float64], active: NDArray[np.bool_]) -> list[LinkWrench]:
    """Sum active taxels' signals, a wrench a link (T 3.16-3.18); links without any are left out (T 3.23-3.24).

    `signal`: force (N,) along each taxel's z in N, measured or virtual; `active`: mask (N,) of taxels that count.
    Returns wrenches, in order of `skin.links`.
    """
    taxels = active.nonzero()[0]
    if not len(taxels):
        return []
    owners = skin.link_of[taxels]
    ends = [*((owners[1:] != owners[:-1]).nonzero()[0] + 1).tolist(), len(taxels)]
    found = []
    for begin, end in zip([0, *ends], ends, strict=False):
        own = taxels[begin:end]
        found.append(LinkWrench(skin.links[owners[begin]], signal[own] @ skin.unit_wrenches[own], own))
    return found
