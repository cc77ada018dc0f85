"""Draw what plantar perception sees: figures after Fig. 37, 38, 39 and 40 of T, from simulated soles.

    python examples/gallery.py docs/images

The H1's soles stand and swing over made-up terrain. Forces are spread over the taxels by the simulator's
`SolePressure`, distances are measured along the taxels' axes to the terrain, and both get noise.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from PIL import Image

from plantar import FeetPercept, Percept, Reading, SolePose, fit_ground_plane, read_layout, robots
from plantar.geometry.inscribed import inscribed_rectangle
from plantar.geometry.outline import concave_outline
from plantar.geometry.polygon import area
from plantar.plotting import COLOURS, new_figure, save_figure
from plantar.sim.sensing.sole_pressure import SolePressure

FORCE, TOUCH = COLOURS["left"], COLOURS["right"]  # Fig. 40: force in blue, pre-touch in red
NEAR = 0.015  # m: what counts as pre-touch in these pictures
H1 = Path(robots.__file__).parent / "h1"
LAYOUTS = {
    side: replace(layout, thresholds={**layout.thresholds, "proximity": NEAR})
    for side in ("left", "right")
    for layout in [read_layout(H1 / f"layout_{side}.json")]
}
STONE = np.array([[-0.015, 0.035], [0.03, -0.045], [0.09, -0.05], [0.118, 0.005], [0.085, 0.06], [0.03, 0.075]])


def percept_of(side, patch, load, cop, distance):
    """Percept of a sole that carries a load on a patch and measures distances, both with noise."""
    layout, rng = LAYOUTS[side], np.random.default_rng(0)
    force = SolePressure(layout).spread([tuple(p) for p in patch], load, cop) if len(patch) else np.zeros(len(layout))
    force = np.clip(force + rng.normal(0.0, 0.3, len(layout)), 0.0, None)
    seen = np.where(distance < 0.05, np.clip(distance + rng.normal(0.0, 4e-4, len(layout)), 0.0, None), np.inf)
    return Percept(layout, Reading(0.0, force, proximity=seen))


def distance_to_polygon(points, ring):
    """Distance (n,) in m of points to a convex polygon, 0 inside."""
    out = np.full(len(points), np.inf)
    inside = np.ones(len(points), dtype=bool)
    for a, b in zip(ring, np.roll(ring, -1, axis=0), strict=True):
        along = b - a
        t = np.clip((points - a) @ along / (along @ along), 0.0, 1.0)
        out = np.minimum(out, np.linalg.norm(points - a - t[:, None] * along, axis=1))
        inside &= along[0] * (points - a)[:, 1] - along[1] * (points - a)[:, 0] >= 0.0
    return np.where(inside, 0.0, out)


def on_stone(side="left"):
    """A foot on a flat-topped stone under its ball; the flanks fall off at 35 degrees to the ground, 4 cm below."""
    xy = LAYOUTS[side].positions[:, :2]
    stone = STONE if side == "left" else STONE[::-1] * [1.0, -1.0]
    distance = np.minimum(0.7 * distance_to_polygon(xy, stone), 0.04)
    return percept_of(side, stone, 420.0, tuple(stone.mean(axis=0)), distance), stone


def top(points):
    """Points as seen from above with the toes up: to the right is -y."""
    return np.column_stack([-np.asarray(points)[..., 1], np.asarray(points)[..., 0]]) * 1e3


def ring(axes, polygon, colour, style="-", width=1.8, label=None, fill=0.0):
    """Draw a closed polygon."""
    if len(polygon):
        closed = top(np.vstack([polygon, polygon[:1]]))
        axes.plot(*closed.T, style, color=colour, lw=width, label=label, solid_joinstyle="round")
        if fill:
            axes.fill(*closed.T, color=colour, alpha=fill, lw=0)


def cells(axes, layout, colours=None, pose=None, edge="#adb5bd"):
    """Draw the cells of a sole; a colour each, None for an empty one."""
    for i in range(len(layout)):
        corner = layout.cell_polygon(i)
        corner = corner if pose is None else pose.polygon_to_world(corner)
        colour = None if colours is None else colours[i]
        axes.fill(*top(corner).T, fc="white" if colour is None else colour, ec=edge, lw=0.6)


def finish(axes, title, frame="sole"):
    """Equal axes in mm with the title above."""
    axes.set_aspect("equal")
    axes.set_title(title, fontsize=9, loc="left")
    axes.set_xlabel(f"−y in {frame} [mm]", fontsize=8)
    axes.set_ylabel(f"x in {frame} [mm]", fontsize=8)
    axes.tick_params(labelsize=7)
    axes.spines[["top", "right"]].set_visible(False)


def save_small(figure, path):
    """Save with a palette of 200 colours: a third of the size."""
    with Image.open(save_figure(figure, path)) as picture:
        small = picture.convert("RGB").quantize(200)
    small.save(path, optimize=True)


def polygons_of_a_sole(path):
    """Fig. 37: from the sole to the composite polygons."""
    figure, grid = new_figure(12.5, 8.2, 2, 4)
    percept, _ = on_stone()
    layout, axes = percept.layout, grid.ravel()
    shade = [FORCE if a else None for a in percept.active]
    cells(axes[0], layout)
    finish(axes[0], f"a) sole with {len(layout)} taxels")
    cells(axes[1], layout, shade)
    finish(axes[1], "b) active taxels, f > 1.5 N")
    cells(axes[2], layout, edge="#e9ecef")
    used = np.concatenate([layout.cell_polygon(i) for i in np.flatnonzero(percept.active)])
    axes[2].plot(*top(used).T, ".", color=COLOURS["truth"], ms=4)
    finish(axes[2], "c) corners of the active taxels")
    cells(axes[3], layout, edge="#e9ecef")
    axes[3].plot(*top(used).T, ".", color=COLOURS["truth"], ms=2)
    ring(axes[3], percept.support_polygon_in_sole, FORCE, fill=0.15)
    finish(axes[3], "d) supporting polygon (convex hull)")
    cells(axes[4], layout, shade, edge="#dee2e6")
    ring(axes[4], percept.preemptive_polygon_in_sole, TOUCH, "--", label="pre-touch polygon, d < 15 mm")
    ring(axes[4], percept.support_polygon_in_sole, FORCE, label="force polygon")
    finish(axes[4], "e) force and pre-touch")
    axes[4].legend(fontsize=7, loc="lower center", frameon=False, bbox_to_anchor=(0.5, -0.27))

    other, _ = on_stone("right")
    feet = FeetPercept([percept, other], [SolePose.flat(0.08, 0.11, yaw=0.1), SolePose.flat(-0.08, -0.11, yaw=-0.15)])
    for index, title in ((5, "f) polygons of both feet"), (6, "g) composite polygons")):
        for sole, pose in zip(feet.percepts, feet.poses, strict=True):
            cells(axes[index], sole.layout, [FORCE if a else None for a in sole.active], pose, edge="#dee2e6")
            if index == 5:
                ring(axes[index], pose.polygon_to_world(sole.preemptive_polygon_in_sole), TOUCH, "--")
                ring(axes[index], pose.polygon_to_world(sole.support_polygon_in_sole), FORCE)
        finish(axes[index], title, "world")
    ring(axes[6], feet.preemptive_polygon_in_world, TOUCH, "--", label="pre-touch")
    ring(axes[6], feet.support_polygon_in_world, FORCE, fill=0.12, label="force")
    axes[6].plot(*top(feet.position_zmp_in_world[None]).T, "o", color=COLOURS["truth"], ms=6, label="ZMP")
    axes[6].legend(fontsize=7, loc="lower center", ncols=3, frameon=False, bbox_to_anchor=(0.5, -0.32))
    axes[7].axis("off")
    lines = [
        f"load {percept.vertical_force:.0f} N on {percept.contact_area * 1e4:.0f} cm²",
        f"supporting polygon / sole: {percept.area_ratio:.2f}",
        f"virtual force of proximity {percept.virtual_wrench_in_sole[2]:.0f} N",
        f"composite polygon {feet.support_area * 1e4:.0f} cm²",
    ]
    axes[7].text(0.0, 0.9, "left sole and both feet:\n\n" + "\n".join(lines), fontsize=8.5, va="top")
    save_small(figure, path)


def contact_and_its_models(path):
    """Fig. 38: the real contact, the cells' cluster, its hull and a rectangle for the wrench cone."""
    percept, stone = on_stone()
    layout = percept.layout
    figure, axes = new_figure(7.8, 5.4)
    cells(axes, layout, ["#f8d9b6" if a else None for a in percept.active], edge="#dee2e6")
    ring(axes, stone, COLOURS["truth"], width=2.4, label=f"real contact, {area(stone) * 1e4:.0f} cm²")
    outline = concave_outline(layout, percept.active)
    for contour in outline.rings:
        ring(axes, contour, COLOURS["active"], label=f"cluster of the active taxels, {outline.area * 1e4:.0f} cm²")
        axes.plot(*top(contour).T, "o", color=COLOURS["active"], ms=4)
    hull = percept.support_polygon_in_sole
    ring(axes, hull, COLOURS["polygon"], label=f"convex hull, {area(hull) * 1e4:.0f} cm²", fill=0.08)
    inner = inscribed_rectangle(hull)
    ring(axes, inner, TOUCH, "--", label=f"inscribed rectangle, {area(inner) * 1e4:.0f} cm²")
    cop = percept.position_cop_in_sole
    axes.plot(*top(cop[None]).T, "X", color=COLOURS["cop"], ms=9, mec="white", label="CoP")
    finish(axes, "the contact and what stands for it")
    axes.legend(fontsize=8, loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    save_small(figure, path)


def height_contours_of_an_obstacle(path):
    """Fig. 39: a swinging sole over an obstacle, its rays, and the contours of height."""
    layout = LAYOUTS["left"]
    xy = layout.positions[:, :2]

    def ground(x, y):  # under the sole frame: a rounded stone on a gentle slope
        bump = 0.034 * np.exp(-(((x - 0.06) / 0.05) ** 2) - ((y - 0.02) / 0.045) ** 2)
        return -0.044 + 0.06 * x + bump

    percept = percept_of("left", [], 0.0, (0.0, 0.0), -ground(*xy.T))
    figure, (side, above) = new_figure(11.0, 4.8, 1, 2, width_ratios=[1.25, 1.0])
    x = np.linspace(-0.12, 0.17, 300)
    row = np.abs(xy[:, 1] - 0.02) < 0.012
    side.fill_between(x * 1e3, ground(x, 0.02) * 1e3, -62, color="#d8cfc4", lw=0, label="ground at y = 20 mm")
    side.fill_between([-90.35, 140.35], 0.0, 9.0, color="#ced4da", lw=0, label="sole")
    seen = percept.reading.proximity
    for i in np.flatnonzero(row):
        if np.isfinite(seen[i]):
            side.annotate(
                "",
                (xy[i, 0] * 1e3, -seen[i] * 1e3),
                (xy[i, 0] * 1e3, 0.0),
                arrowprops={"arrowstyle": "->", "color": TOUCH, "lw": 1.2},
            )
    plane = fit_ground_plane(layout, seen)
    side.plot(
        x * 1e3,
        (-plane.height + plane.slope[0] * x + plane.slope[1] * 0.02) * 1e3,
        "--",
        color=COLOURS["polygon"],
        lw=1.4,
        label="fitted ground plane",
    )
    heights = percept.height_contours_in_sole
    colours = ["#7f0000", "#c9302c", "#e8792b", "#f2b84b", "#f7e3a1"]
    for contour, colour in zip(heights, colours, strict=True):
        side.axhline(-contour.height * 1e3, color=colour, lw=0.9, ls=":")
    side.set_xlabel("x in sole [mm]", fontsize=8)
    side.set_ylabel("z in sole [mm]", fontsize=8)
    side.set_ylim(-62, 22)
    wrench = percept.virtual_wrench_in_sole
    side.set_title(
        f"a) rays to the ground; virtual wrench: f_p = {wrench[2]:.0f} N, η_p = ({wrench[3]:.1f}, {wrench[4]:.1f}) N m",
        fontsize=9,
        loc="left",
    )
    side.legend(fontsize=8, loc="upper center", ncols=3, frameon=False)
    side.tick_params(labelsize=7)
    level = np.full(len(layout), -1)
    for k, contour in reversed(list(enumerate(heights))):
        level[contour.taxels] = k
    cells(above, layout, [None if k < 0 else colours[k] for k in level], edge="white")
    for contour, colour in reversed(list(zip(heights, colours, strict=True))):
        ring(above, contour.polygon_in_sole, colour, width=2.2, label=f"d < {contour.height * 1e3:.0f} mm")
    ring(above, layout.outline, COLOURS["edge"], width=1.0)
    finish(above, "b) taxels and convex contours by distance")
    above.legend(fontsize=8, loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    save_small(figure, path)


def from_raw_data_to_the_picture(path):
    """Fig. 40: raw data of both soles, CoPs, and the final representation; the right foot lands on its heel."""
    left = LAYOUTS["left"]
    flat = percept_of("left", left.outline[::4], 560.0, (0.03, 0.0), np.zeros(len(left)))
    right = LAYOUTS["right"]
    heel = right.positions[:, 0] < -0.05
    lifted = np.tan(np.radians(9.0)) * (right.positions[:, 0] + 0.05)
    patch = right.outline[right.outline[:, 0] < -0.05]
    landing = percept_of("right", patch, 240.0, (-0.07, 0.0), np.where(heel, 0.0, np.maximum(lifted, 0.0)))
    poses = [SolePose.flat(0.0, 0.1), SolePose.flat(0.16, -0.1)]
    feet = FeetPercept([flat, landing], poses)
    figure, axes = new_figure(12.0, 5.0, 1, 3)
    for k, (panel, title) in enumerate(
        zip(axes, ("a) raw data", "b) CoPs and polygons", "c) representation"), strict=True)
    ):
        for percept, pose in zip(feet.percepts, poses, strict=True):
            force, near = percept.reading.force, percept.near
            colours = [
                (FORCE, 0.25 + 0.75 * min(1.0, f / force.max())) if a else (TOUCH, 0.45) if n else None
                for f, a, n in zip(force, percept.active, near, strict=True)
            ]
            cells(panel, percept.layout, colours if k < 2 else None, pose, edge="#dee2e6")
            if k:
                touch = pose.polygon_to_world(percept.preemptive_polygon_in_sole)
                ring(panel, touch, TOUCH, "--", 1.4)
                ring(panel, pose.polygon_to_world(percept.support_polygon_in_sole), FORCE, width=1.6)
        if k:
            cops = np.array([c[:2] for c in feet.positions_cop_in_world])
            panel.plot(*top(cops).T, "o", color=COLOURS["cop"], ms=7, mec="white", ls="", label="left and right CoP")
            zmp = feet.position_zmp_in_world[None]
            panel.plot(*top(zmp).T, "X", color=COLOURS["truth"], ms=10, mec="white", ls="", label="composite ZMP")
        if k == 2:
            ring(panel, feet.preemptive_polygon_in_world, TOUCH, ":", 2.4)
            ring(panel, feet.support_polygon_in_world, FORCE, width=2.6, fill=0.1)
        finish(panel, title, "world")
    handles = [
        axes[0].fill([], [], color=FORCE, label="contact force (darker: more)")[0],
        axes[0].fill([], [], color=TOUCH, alpha=0.45, label="pre-touch, d < 15 mm")[0],
        axes[0].plot([], [], color=FORCE, lw=1.6, label="supporting polygon")[0],
        axes[0].plot([], [], "--", color=TOUCH, lw=1.4, label="pre-touch polygon")[0],
        axes[0].plot([], [], color=FORCE, lw=2.6, label="composite supporting polygon")[0],
        axes[0].plot([], [], ":", color=TOUCH, lw=2.4, label="composite pre-touch polygon")[0],
        *axes[1].get_legend_handles_labels()[0],
    ]
    figure.legend(handles=handles, fontsize=8, ncols=4, loc="outside lower center", frameon=False)
    save_small(figure, path)


def main() -> None:
    """Draw all figures into the folder that the command line names."""
    if len(sys.argv) != 2:
        sys.exit("usage: python examples/gallery.py FOLDER")
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    polygons_of_a_sole(folder / "gallery_polygons.png")
    contact_and_its_models(folder / "gallery_contact.png")
    height_contours_of_an_obstacle(folder / "gallery_contours.png")
    from_raw_data_to_the_picture(folder / "gallery_feet.png")


if __name__ == "__main__":
    main()
