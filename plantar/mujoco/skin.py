"""A plantar skin for a body of a MuJoCo model, and its checks."""

import math
import os
import re
from collections.abc import Sequence
from typing import Any

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.arguments import instance, integer, items, number, positive
from plantar.common.gravity import GRAVITY
from plantar.common.sides import SIDES, Side, other_side
from plantar.errors import InputError, LayoutError, RobotError
from plantar.layouts.layout import SoleLayout, mirrored
from plantar.layouts.layout_file import read_layout
from plantar.layouts.source_pose import SourcePose
from plantar.mujoco.bound_skin import BoundSkin
from plantar.mujoco.contacts import REACH
from plantar.mujoco.geom_surface import body_surfaces
from plantar.mujoco.layer import ElasticLayer
from plantar.mujoco.mirrored_body import left_body
from plantar.mujoco.named_id import named_id
from plantar.mujoco.quaternions import quaternion_of
from plantar.mujoco.sole_shape import SoleShape, rigid_geoms, sole_shape, unit_vector
from plantar.mujoco.wrapped_skin import WrappedSkin, fitted_cell_area, flat_layout, wrapped_skin
from plantar.sensing.taxel_faults import TaxelFaults

_ACTIVE = 0.073  # of its robot's weight over its taxels: 0.15 kg of the papers' 86 kg over 42
_RIM = 0.005  # m: a shoe's sole may be so much wider than the shapes that collide
_OUTSIDE = 0.1  # of a layout's cells: more than this beside the body's sole is a wrong layout or frame
_COVERED = 0.3  # of the body's sole: a layout that covers less is too small to be of it
_BETTER = 0.03  # of the sole: a layout that fits so much better turned or mirrored is so
_LEVEL = math.cos(math.radians(3.0))
_ALIKE = 1e-4  # m, or of a direction: soles of mirrored feet in one pose; other poses differ by more
_NEAR = 0.004  # m: how far a site may be from the face


class Skin:
    """A skin for a body of any MuJoCo model: a sole, or a patch that wraps.

    Without a direction or region it is a sole: the lowest face of the body's collision shapes in the reference pose
    (first keyframe, or `qpos0`). Its origin and axes are those of the pose that the layout states in this body's frame;
    else its origin lies below the body's, and x is the body's own axis that is nearest the world's. It reads all
    contacts of the body.

    With `outward`, `around`, `region` or `polygon`, and no layout or site, it is a patch on the surface of the body's
    geoms: the part of which all given conditions hold. Each contact goes to the cells about its own point; what does
    not touch the patch is not read.

    Args:
        layout: Layout, or path of its file; None fits hexagons to the body.
        body: Name of body, for example "left_ankle_roll_link".
        geoms: Names of geoms that can touch; None for all colliding ones of body and fixed parts.
        site: Site that is the sole frame; checked against shapes.
        outward: Direction (3,) of sole, body frame; None for down in reference pose. Of a patch: its normals turn from
            it by at most `within`; its frame's z is into the body.
        forward: Forward (3,), body frame; None for the body's own axis (of a sole: that is nearest the world's x).
        within: Largest angle in degrees of a patch's normals to `outward`.
        around: Axis (3,), body frame, that a patch goes round: its normals are 45 degrees or more from it.
        region: Low and high corner (2, 3) in m of a box in the body's frame, that a patch lies in.
        polygon: Drawn outline (m, 2) in m of a patch as seen along `outward`, in its frame's x and y about the body's
            origin.
        cell_area: Of a fitted cell in m^2; None for 691 mm^2, or a thirtieth of a small sole or patch.
        partial: Whether a layout may cover a small part.
        proximity: Range in m of proximity sensors; None for none.
        reach: Gap in m up to which an unloaded contact counts as near.
        slip: Whether readings have taxels' velocity along what they touch.
        layer: Elastic layer over the cells, which then share what presses near them; None for none.
        faults: Of the taxels: `force` of a reading is what they read, and `vectors` what is on them; None for none.
        seed: Of the faults' draws.

    Raises:
        InputError, LayoutError: If an argument is invalid.
    """

    def __init__(
        self,
        layout: SoleLayout | str | os.PathLike[str] | None = None,
        body: str = "",
        *,
        geoms: Sequence[str] | None = None,
        site: str | None = None,
        outward: ArrayLike | None = None,
        forward: ArrayLike | None = None,
        within: float = 60.0,
        around: ArrayLike | None = None,
        region: ArrayLike | None = None,
        polygon: ArrayLike | None = None,
        cell_area: float | None = None,
        partial: bool = False,
        proximity: float | None = None,
        reach: float = REACH,
        slip: bool = False,
        layer: ElasticLayer | None = None,
        faults: TaxelFaults | None = None,
        seed: int = 0,
    ) -> None:
        self.layout = layout if layout is None or isinstance(layout, SoleLayout) else read_layout(layout)
        if self.layout is not None and not (self.layout.rotations[:, 2, 2] > 0.1).all():
            raise LayoutError("layout field 'rotations' holds a taxel that does not face the ground")
        if not isinstance(body, str) or not body:
            raise InputError("a skin needs the name of its body: Skin(body='left_ankle_roll_link')")
        if isinstance(geoms, str):
            raise InputError(f"geoms is {geoms!r}; expected a list of names")
        self.body = body
        self.geoms = None if geoms is None else tuple(str(name) for name in items(geoms, "geoms"))
        if self.geoms == ():
            raise InputError("geoms are empty; allowed: names of one geom or more, or None for all of the body")
        self.site = site
        self.outward = outward
        self.forward = forward
        self.within = number(within, "within", finite=True)
        self.around = around
        self.region = region
        self.polygon = polygon
        self._check_patch()
        self.partial = partial
        self.cell_area = None if cell_area is None else number(cell_area, "cell area", finite=True)
        if isinstance(proximity, bool):  # a number elsewhere, where it would be a range of one metre
            raise InputError(f"proximity is {proximity}; allowed: the sensors' range in m, or None")
        self.proximity = None if proximity is None else positive(proximity, "proximity range", "m")
        self.slip = bool(slip)
        self.layer = None if layer is None else instance(layer, ElasticLayer, "layer")
        self.faults = None if faults is None else instance(faults, TaxelFaults, "faults")
        self.seed = integer(seed, "seed", 0)
        self.reach = number(reach, "reach", finite=True)
        if self.reach < 0.0:
            raise InputError(f"reach is {reach} m; allowed: 0 or more")

    @property
    def wraps(self) -> bool:
        """Whether it is a patch on the body's surface, not a sole."""
        chosen = self.outward is not None and self.layout is None and self.site is None
        return chosen or any(v is not None for v in (self.around, self.region, self.polygon))

    def _check_patch(self) -> None:
        given = [n for n in ("around", "region", "polygon") if getattr(self, n) is not None]
        fixed = [n for n in ("layout", "site") if getattr(self, n) is not None]
        if given and fixed:
            raise InputError(f"a skin with {fixed[0]} is a sole, which has no {given[0]}; allowed: one of the two")
        if self.polygon is not None and self.outward is None:
            raise InputError("a drawn polygon needs outward=(x, y, z), the direction that it is drawn against")
        if not 0.0 < self.within <= 180.0:
            raise InputError(f"within is {self.within:g} deg; allowed: above 0 and up to 180")

    def edit(self, spec: Any) -> None:
        """Add a site "BODY_skin" at the sole frame to an uncompiled `mujoco.MjSpec`; of a second skin "BODY_skin_2".

        Patches that wrap share the site of a frame: all round a limb have the limb's.

        Raises:
            InputError: If that is no `MjSpec`.
            RobotError: As `bind`, or if it has that site of a sole.
        """
        model = instance(spec, mujoco.MjSpec, "spec").copy().compile()
        position, rotation = self._frame(model)
        quaternion = quaternion_of(rotation)
        name = f"{self.body}_skin"
        count = 1
        while (site := mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_SITE, name)) >= 0:
            turned = min(np.abs(model.site_quat[site] - s * quaternion).max() for s in (1.0, -1.0))
            if max(np.abs(model.site_pos[site] - position).max(), turned) < 1e-9:
                if self.wraps:
                    return
                raise RobotError(f"the model has a site '{name}' there already; edit it once")
            count += 1
            name = f"{self.body}_skin_{count}"
        body = next(b for b in spec.bodies if b.name == self.body)
        site = body.add_site(
            name=name,
            pos=position,
            quat=quaternion,
            size=[0.005] * 3,
            group=4,
        )
        site.alt.type = mujoco.mjtOrientation.mjORIENTATION_QUAT  # whatever the model's default for sites is

    def bind(self, model: Any) -> BoundSkin:
        """Place the skin in a compiled MjModel.

        Returns:
            The reader: call it with an `MjData` after `mj_step` or `mj_forward`.

        Raises:
            RobotError: If body, geom, site or shape is missing, or layout or site does not fit: turned, tilted, upside
                down, scaled, mirrored, another body's.
        """
        if self.wraps:
            return self._bind_patch(model)
        geoms, shape = self._place(model)
        body = named_id(model, "body", self.body)
        if self.layout is None:
            layout, shape = self._fitted(model, body, geoms, shape)
        else:
            layout = self.layout
            self._check(layout, shape)
        return BoundSkin(model, layout, body, geoms, shape.position, shape.rotation, **self._sensing())

    def show(self, model: Any, path: str | os.PathLike[str] | None = None) -> Any:
        """Draw the body's shapes and the skin's cells from two sides; also shapes of a skin that `bind` refuses.

        Args:
            model: The compiled MjModel.
            path: File to save (png, pdf, svg); None saves none.

        Returns:
            Matplotlib figure, whose title counts the cells, or is the line of the refusal.

        Raises:
            RobotError: If the body or its geoms are missing.
        """
        from plantar.mujoco.skin_picture import draw_patch
        from plantar.plotting import save_figure

        geoms = self._touching(model)
        surfaces = body_surfaces(model, named_id(model, "body", self.body), geoms)
        rings: list[NDArray[np.float64]] = []
        normals = np.zeros((0, 3))
        toward = None if self.outward is None else unit_vector(self.outward, "outward")
        try:
            feel = self.bind(model)
        except (RobotError, LayoutError) as problem:
            title = f"refused: {problem}"
        else:
            turn = feel.rotation_to_body
            rings = [ring @ turn.T + feel.position_in_body for ring in feel.rings]
            normals = -feel.layout.rotations[:, :, 2] @ turn.T
            kind = "patch" if feel.is_patch else "sole"
            title = f"body '{self.body}': {kind} of {len(feel)} taxels, {1e4 * feel.layout.areas.sum():.3g} cm$^2$"
            if not feel.is_patch:
                toward = -turn[:, 2]
        figure = draw_patch(surfaces, rings, normals, title, toward)
        if path is not None:
            save_figure(figure, path)
        return figure

    def _sensing(self) -> dict[str, Any]:
        """What a bound skin reads besides contacts."""
        names = ("reach", "proximity", "slip", "layer", "faults", "seed")
        return {name: getattr(self, name) for name in names}

    def _frame(self, model: Any) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Origin (3,) and rotation (3, 3) of the skin's frame in the body's."""
        if self.wraps:
            patch = self._wrapped(model, self._touching(model))
            return patch.position, patch.rotation
        _, shape = self._place(model)
        return shape.position, shape.rotation

    def _bind_patch(self, model: Any) -> BoundSkin:
        geoms = self._touching(model)
        body = named_id(model, "body", self.body)
        patch = self._wrapped(model, geoms)
        return BoundSkin(
            model, patch.layout, body, geoms, patch.position, patch.rotation,
            wraps=patch.kernel, rings=patch.rings, **self._sensing(),
        )  # fmt: skip

    def _wrapped(self, model: Any, geoms: list[int]) -> WrappedSkin:
        body = named_id(model, "body", self.body)
        return wrapped_skin(
            model, body, geoms, side=_side_in(self.body), cell_area=self.cell_area, least_level=_active(model, body),
            outward=self.outward, within=self.within, around=self.around, region=self.region, polygon=self.polygon,
            forward=self.forward,
        )  # fmt: skip

    def _place(self, model: Any) -> tuple[list[int], SoleShape]:
        geoms = self._touching(model)
        body = named_id(model, "body", self.body)
        shape = sole_shape(model, body, geoms, self.outward, self.forward)
        if self.site is not None:
            return geoms, self._at_site(model, body, shape)
        pose = None if self.layout is None else self.layout.pose
        stated = pose is not None and pose.body == self.body and self.outward is None and self.forward is None
        return geoms, self._at_pose(pose, shape) if pose is not None and stated else shape

    def _touching(self, model: Any) -> list[int]:
        """Ids of the geoms that can touch."""
        if not isinstance(model, mujoco.MjModel):
            raise InputError(f"a skin is bound to a mujoco.MjModel; got a {type(model).__name__}")
        if model.opt.enableflags & mujoco.mjtEnableBit.mjENBL_SLEEP:
            raise RobotError(
                "the model lets bodies sleep, which have no contacts then; allowed: no <flag sleep='enable'/>"
            )
        body = named_id(model, "body", self.body)
        if body == 0 or (int(model.body_weldid[body]) == 0 and model.body_mocapid[body] < 0):
            raise RobotError(f"body '{self.body}' is fixed to the world; a skin needs a body that moves")
        geoms = rigid_geoms(model, body)
        if self.geoms is not None:
            named = [named_id(model, "geom", name) for name in self.geoms]
            for name, geom in zip(self.geoms, named, strict=True):
                if geom not in geoms:
                    owner = model.body(int(model.geom_bodyid[geom])).name
                    why = f"is on body '{owner}'" if int(model.geom_bodyid[geom]) != body else "collides with nothing"
                    raise RobotError(f"geom '{name}' {why}; allowed: colliding geoms of '{self.body}' or fixed to it")
            geoms = named
        if not geoms:
            touching = (model.geom_contype | model.geom_conaffinity) != 0
            able = sorted({model.body(int(b)).name for b in model.geom_bodyid[touching] if b})
            listed = ", ".join(able) or "none"
            raise RobotError(f"body '{self.body}' has no geom that collides; bodies that have: {listed}")
        return geoms

    def _at_pose(self, pose: SourcePose, shape: SoleShape) -> SoleShape:
        """The sole in the frame that the layout states, on the face of the shapes: models wear shoes or none."""
        self._check_level(f"the pose that the layout has from {pose.file}", pose.rotation, shape)
        normal = pose.rotation[:, 2]
        height = float((shape.position - pose.position) @ normal)
        return _in_frame(shape, pose.position + height * normal, pose.rotation)

    def _check_level(self, what: str, rotation: NDArray[np.float64], shape: SoleShape) -> None:
        """Refuse a frame whose z is not that of the sole."""
        up = float(rotation[:, 2] @ shape.rotation[:, 2])
        if up < -_LEVEL:
            raise RobotError(f"{what} is upside down: its z points out of the body; it should point into it")
        if up < _LEVEL:
            angle = math.degrees(math.acos(max(-1.0, min(1.0, up))))
            raise RobotError(f"{what} is tilted by {angle:.0f} deg from the sole of '{self.body}'")

    def _at_site(self, model: Any, body: int, shape: SoleShape) -> SoleShape:
        """The sole with a site as its frame."""
        site = named_id(model, "site", str(self.site))
        owner = int(model.site_bodyid[site])
        if model.body_weldid[owner] != model.body_weldid[body]:
            raise RobotError(f"site '{self.site}' is on body '{model.body(owner).name}'; the skin's is '{self.body}'")
        data = mujoco.MjData(model)
        mujoco.mj_kinematics(model, data)
        turn = data.xmat[body].reshape(3, 3).T
        rotation = turn @ data.site_xmat[site].reshape(3, 3)
        position = turn @ (data.site_xpos[site] - data.xpos[body])
        self._check_level(f"site '{self.site}'", rotation, shape)
        height = float((position - shape.position) @ shape.rotation[:, 2])
        if abs(height) > _NEAR:
            raise RobotError(f"site '{self.site}' is {1e3 * height:.0f} mm above the sole's face; allowed: on it")
        return _in_frame(shape, position, rotation)

    def _fitted(self, model: Any, body: int, geoms: list[int], shape: SoleShape) -> tuple[SoleLayout, SoleShape]:
        """Cells on a sole, and the sole: of a right foot the left one's, mirrored, if the feet are."""
        left = left_body(model, body, body_surfaces(model, body, geoms)) if self.site is None else None
        if left is not None:
            out = None if self.outward is None else left.way @ unit_vector(self.outward, "outward")
            ahead = None if self.forward is None else left.way @ unit_vector(self.forward, "forward")
            its = sole_shape(model, left.body, left.geoms, out, ahead)
            seen = its._replace(
                position=left.way.T @ its.position,
                rotation=left.way.T @ its.rotation * np.array([1.0, -1.0, 1.0]),
                outline=(its.outline * np.array([1.0, -1.0]))[::-1],
                side=shape.side,
            )
            off = max(np.abs(seen.position - shape.position).max(), np.abs(seen.rotation - shape.rotation).max())
            if off < _ALIKE:
                shape = seen
        import shapely

        area = self.cell_area
        if area is None:
            area = fitted_cell_area(shapely.Polygon(shape.outline).area)
        side = _side_in(self.body) or shape.side
        return flat_layout(self.body, side, shape.outline, area, _active(model, body)), shape

    def _check(self, layout: SoleLayout, shape: SoleShape) -> None:
        import shapely
        from shapely.affinity import rotate

        if (side := _side_in(self.body)) == other_side(layout.side):
            raise RobotError(
                f"layout '{layout.name}' is of the {layout.side} foot; body '{self.body}' is the {side} one"
            )
        sole = shapely.Polygon(shape.outline)
        span, extent = (float(np.hypot(*np.ptp(p[:, :2], axis=0))) for p in (layout.positions, shape.outline))
        cells = _cells(layout)
        other = _cells(mirrored(layout))
        best = ""
        fit = _fit(cells, sole)
        for turn in range(4):
            for name, way in (("", cells), ("mirrored", other)):
                value = _fit(rotate(way, 90 * turn, (0, 0)), sole)
                if value > fit + _BETTER:
                    turned = f"turned by {90 * turn} deg" if turn else ""
                    best = " and ".join(filter(None, (name, turned)))
                    fit = value
        outside = 1.0 - cells.intersection(sole.buffer(_RIM)).area / cells.area
        covered = cells.intersection(sole).area / sole.area
        where = f"layout '{layout.name}' on body '{self.body}'"
        if not 0.15 <= span / extent <= 3.0:
            raise RobotError(f"{where}: it is {span:.3g} m long and the sole {extent:.3g} m; is its unit right?")
        if best:
            raise RobotError(
                f"{where} would fit {best} (it covers {100 * covered:.0f} % of the sole as it is); "
                "turn it with forward=(x, y, z), or take the layout of the other foot"
            )
        if outside > _OUTSIDE:
            raise RobotError(
                f"{where}: {100 * outside:.0f} % of its cells lie beside the sole, which is "
                f"{1e3 * np.ptp(shape.outline[:, 0]):.0f} x {1e3 * np.ptp(shape.outline[:, 1]):.0f} mm; "
                f"allowed: {100 * _OUTSIDE:.0f} %. Is it another body's, or its frame elsewhere?"
            )
        if covered < _COVERED and not self.partial:
            raise RobotError(
                f"{where} covers {100 * covered:.0f} % of the sole; allowed: {100 * _COVERED:.0f} % or more, "
                "or partial=True"
            )


def _in_frame(shape: SoleShape, position: NDArray[np.float64], rotation: NDArray[np.float64]) -> SoleShape:
    """The same sole in another frame on its face, of origin (3,) and rotation (3, 3) to the body's."""
    corners = np.column_stack([shape.outline, np.zeros(len(shape.outline))])
    outline = corners @ shape.rotation.T + shape.position - position
    return shape._replace(position=position, rotation=rotation, outline=(outline @ rotation)[:, :2])


def _cells(layout: SoleLayout) -> Any:
    import shapely

    return shapely.union_all([shapely.Polygon(layout.cell_polygon(i)).buffer(1e-6) for i in range(len(layout))])


def _fit(cells: Any, sole: Any) -> float:
    """Intersection of cells and sole over their union."""
    return float(cells.intersection(sole).area / cells.union(sole).area)


def _active(model: Any, body: int) -> float:
    """Force in N of all taxels of a body's skin from which they are active."""
    return _ACTIVE * GRAVITY * float(model.body_subtreemass[model.body_rootid[body]])


def _side_in(name: str) -> Side | None:
    """The side in a body's name, as a word or else a letter, or None."""
    words = re.split(r"[^a-z]+", re.sub(r"(?<=[a-z])(?=[A-Z])", "_", name).lower())
    sides = {side for side in SIDES if side in words} or {side for side in SIDES if side[0] in words}
    return sides.pop() if len(sides) == 1 else None
