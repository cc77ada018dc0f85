"""Errors of the controller's footholds."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.gait.contact.foot_contacts import FootholdFound
from plantar.geometry.polygon import area, centroid
from plantar.layouts.layout import Side
from plantar.sim.model.world import World
from plantar.sim.terrain import Ground

_LEVEL = 0.01  # leg: faces within this of the sole are under it


class FootholdTruth:
    """Compares found footholds with the level boxes and floor of a `ground` in a `world`."""

    def __init__(self, world: World, ground: Ground) -> None:
        import shapely

        self._world = world
        faces = []
        for solid, ring in zip(ground.solids, ground.seen_from_above(), strict=True):
            level = solid.shape == "box" and solid.rotation[2, 2] > 0.9999 and not solid.motions
            if level:
                faces.append((float(solid.position[2]) + solid.size[2], shapely.Polygon(ring)))
        self._faces = faces
        self._floor = ground.floor
        self._only_level = len(faces) == len(ground.solids)
        self._found: dict[int, tuple[float, float, float]] = {}

    def update(self, footholds: tuple[FootholdFound, ...]) -> None:
        """Compare this tick's footholds; a step's last counts."""
        for foothold in footholds if self._only_level else ():
            true = self._under(foothold.side)
            if len(true) < 3 or len(foothold.polygon) < 3:
                continue
            middle = centroid(true)
            found = centroid(foothold.polygon)
            assert middle is not None
            assert found is not None
            whole = area(self._world.robot.layouts[foothold.side].outline)
            self._found[foothold.step] = (
                float(np.hypot(*(found - middle))),
                area(foothold.polygon) / whole,
                area(true) / whole,
            )

    def summary(self) -> Mapping[str, Any]:
        """Errors of centroids in m, and true and found area shares, per step."""
        rows = [self._found[k] for k in sorted(self._found)]
        if not rows:
            return {}
        errors = np.array([row[0] for row in rows])
        return {
            "centroid_error_m": {
                "median": round(float(np.median(errors)), 4),
                "p95": round(float(np.percentile(errors, 95)), 4),
            },
            "area_ratio_found": [round(row[1], 3) for row in rows],
            "area_ratio_true": [round(row[2], 3) for row in rows],
        }

    def _under(self, side: Side) -> NDArray[np.float64]:
        """True support polygon (k, 2) of a level sole in the world."""
        import shapely

        site = self._world.sole_sites[side]
        data = self._world.data
        place = data.site_xpos[site]
        rotation = data.site_xmat[site].reshape(3, 3)
        ring = self._world.robot.layouts[side].outline @ rotation[:2, :2].T + place[:2]
        sole = shapely.Polygon(ring)
        level = _LEVEL * self._world.body.leg
        if abs(float(place[2]) - self._floor) < level:
            return np.asarray(ring)
        near = [face for height, face in self._faces if abs(float(place[2]) - height) < level]
        part = sole.intersection(shapely.unary_union(near)).convex_hull if near else shapely.Polygon()
        if part.geom_type != "Polygon" or part.is_empty:
            return np.empty((0, 2))
        return np.asarray(shapely.get_coordinates(shapely.orient_polygons(part))[:-1])
