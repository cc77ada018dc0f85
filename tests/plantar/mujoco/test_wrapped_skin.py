"""Skin that wraps: 40 constructed set-ups against a count of who touches what that knows nothing of the kernel."""

import mujoco
import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import root

from plantar.errors import InputError, PlantarError, RobotError
from plantar.layouts.layout import SoleLayout
from plantar.mujoco import Skin

PRISM = [
    [0.05 * np.cos(a), 0.05 * np.sin(a), z] for z in (-0.05, 0.05) for a in np.radians(np.arange(0, 360, 45) + 22.5)
]
MESH = f'<mesh name="prism" vertex="{" ".join(f"{c:.9f}" for p in PRISM for c in p)}"/>'
HILLS = '<hfield name="hills" nrow="3" ncol="3" size=".3 .3 .02 .01" elevation="0 .5 0 .5 1 .5 0 .5 0"/>'
KINDS = {
    "box": '<geom type="box" size=".05 .05 .05"/>',
    "sphere": '<geom size=".05"/>',
    "capsule": '<geom type="capsule" size=".05 .05"/>',
    "cylinder": '<geom type="cylinder" size=".05 .05"/>',
    "ellipsoid": '<geom type="ellipsoid" size=".05 .04 .06"/>',
    "mesh": '<geom type="mesh" mesh="prism"/>',
    "two geoms": '<geom type="capsule" size=".04 .05" pos=".01 0 0"/><geom type="box" size=".03 .03 .05"/>',
    "nested": '<body name="shell" pos="0 0 .01" euler="0 0 90"><geom type="cylinder" size=".05 .05"/></body>',
}
PLACES = {
    "in front": (8.0, True),
    "from the side": (45.0, True),
    "beyond": (95.0, False),
    "from behind": (180.0, False),
}
TURNED = "0.3 -0.5 0.7 0.4"


def scene(geoms: str, euler: str = "", ground: str = "", gravity: str = "0 0 0", extra: str = "") -> mujoco.MjModel:
    pose = f'quat="{euler}"' if euler else ""
    return mujoco.MjModel.from_xml_string(f"""<mujoco><option gravity="{gravity}"/>
      <asset>{MESH}{HILLS}</asset><worldbody>{ground}<body name="body" pos="0 0 1" {pose}><freejoint/>{geoms}
      <inertial pos="0 0 0" mass="2" diaginertia=".01 .01 .01"/></body>{extra}</worldbody></mujoco>""")


PROBE = '<body name="probe" pos="9 0 0"><freejoint/><geom name="probe" {}/></body>'
SPHERE = 'size=".02" mass="1"'
BALL = 'type="mesh" mesh="prism" mass="1"'


def touch(model: mujoco.MjModel, degrees: float, height: float) -> mujoco.MjData:
    """Let the probe press on the body from a direction about its z axis, sliding along it."""
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    way = np.array([np.cos(np.radians(degrees)), np.sin(np.radians(degrees)), 0.0])
    turn = data.xmat[1].reshape(3, 3)
    middle = data.xpos[1].copy()
    own = [g for g in range(model.ngeom) if model.body_rootid[model.geom_bodyid[g]] == 1]
    probe = model.geom("probe").id
    near = 0.0
    far = 0.3
    for _ in range(60):  # to an overlap of 0.1 mm
        data.qpos[7:10] = middle + turn @ (0.5 * (near + far) * way + [0.0, 0.0, height])
        mujoco.mj_kinematics(model, data)
        gap = min(mujoco.mj_geomDistance(model, data, g, probe, 1.0, None) for g in own)
        near, far = (near, 0.5 * (near + far)) if gap > -1e-4 else (0.5 * (near + far), far)
    data.qvel[6:9] = turn @ (-0.1 * way + [0.0, 0.0, 0.05])
    mujoco.mj_forward(model, data)
    return data


def counted(feel, data, touches) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Forces (n, 3) on taxels and wrench (6,) in the patch's frame, contact by contact, of those that `touches` names.

    Weights and shares are of the kernel's definition; who touches, forces and frames are MuJoCo's.
    """
    model = feel.model
    pose = feel.pose(data)
    turn = pose.rotation_sole_to_world
    origin = pose.position_in_world
    places = feel.layout.positions @ turn.T + origin
    axes = feel.layout.rotations[:, :, 2] @ turn.T
    forces = np.zeros_like(places)
    wrench = np.zeros(6)
    local = np.zeros(6)
    for i, contact in enumerate(data.contact):
        first, second = contact.geom
        if (first in feel.geom_ids) == (second in feel.geom_ids) or not touches(contact):
            continue
        sign = 1.0 if second in feel.geom_ids else -1.0
        frame = sign * contact.frame.reshape(3, 3)
        mujoco.mj_contactForce(model, data, i, local)
        force = frame.T @ local[:3]
        normal = frame[0]
        wrench += np.concatenate([force, frame.T @ local[3:] + np.cross(contact.pos - origin, force)])
        place = contact.pos + 0.5 * contact.dist * normal
        away = places - place
        weights = feel.layout.areas * (axes @ normal) * (1.0 - (away**2).sum(axis=1) / feel.wraps[3] ** 2)
        weights = np.where(axes @ normal > 0.0, np.maximum(weights, 0.0), 0.0)
        across = np.linalg.svd(normal[None])[2][1:]
        flat = away @ across.T / 0.01
        found = root(
            lambda f, w=weights, p=flat: [
                (w * np.maximum(0.0, f[0] + p @ f[1:])).sum() / w.sum() - 1.0,
                *((w * np.maximum(0.0, f[0] + p @ f[1:])) @ p / w.sum()),
            ],
            [1.0, 0.0, 0.0],
            tol=1e-15,
        )
        share = weights * np.maximum(0.0, found.x[0] + flat @ found.x[1:]) / weights.sum()
        if np.abs(found.fun).max() > 1e-12:  # beyond the outermost cells
            share = weights / weights.sum()
        forces += share[:, None] * force
    return forces @ turn, np.concatenate([wrench[:3] @ turn, wrench[3:] @ turn])


def agree(feel, data, touches, expected: bool) -> None:
    reading = feel(data)
    forces, wrench = counted(feel, data, touches)
    load = max(float(np.linalg.norm(wrench[:3])), 1.0)
    assert bool(np.abs(wrench).max() > 1e-3) == expected
    assert np.abs(reading.vectors - forces).max() <= 1e-9 * load
    assert np.abs(reading.wrench - wrench).max() <= 1e-9 * load
    assert np.abs(reading.vectors.sum(axis=0) - wrench[:3]).max() <= 1e-12 * load
    if not expected:
        assert not reading.vectors.any()
        assert reading.carried


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("kind", KINDS)
def test_a_touch_lights_the_cells_about_its_own_point(kind, place):
    """32 set-ups."""
    degrees, expected = PLACES[place]
    if kind == "box" and degrees == 45.0:
        degrees = 30.0  # 45 is its edge, of which either face may be the one that is touched
    model = scene(KINDS[kind], TURNED, extra=PROBE.format(SPHERE))
    data = touch(model, degrees, 0.01)
    assert data.ncon > 0
    feel = Skin(body="body", outward=(1, 0, 0)).bind(model)
    agree(feel, data, lambda _: expected, expected)
    if expected:
        reading = feel(data)
        pose = feel.pose(data)
        point = (data.contact.pos[0] - pose.position_in_world) @ pose.rotation_sole_to_world
        lit = np.flatnonzero(reading.force > 0.0)
        width = np.sqrt(feel.layout.cell_area * 2.0 / np.sqrt(3.0))
        nearest = int(np.argmin(np.linalg.norm(feel.layout.positions - point, axis=1)))
        assert np.linalg.norm(feel.layout.positions[lit] - point, axis=1).max() < 1.3 * width
        assert np.linalg.norm(feel.layout.positions[reading.force.argmax()] - point) < width
        assert nearest in lit


@pytest.mark.parametrize("kind", ["box", "cylinder"])
def test_what_is_pushed_and_touches_nothing_in_front_reads_nothing(kind):
    """2 set-ups: the friction below it is not in front."""
    model = scene(KINDS[kind], ground='<geom type="plane" size="3 3 1" pos="0 0 .95"/>', gravity="0 0 -9.81")
    data = mujoco.MjData(model)
    data.xfrc_applied[1, 0] = 8.0
    mujoco.mj_step(model, data, 200)
    front, below = (Skin(body="body", outward=way).bind(model) for way in ((1, 0, 0), (0, 0, -1)))
    agree(front, data, lambda _: False, False)
    agree(below, data, lambda _: True, True)
    assert below(data).vectors.sum(axis=0)[2] == pytest.approx(2.0 * 9.81, rel=1e-2)


def test_two_patches_share_no_contact():
    """1 set-up: a probe on each side of a limb, and a patch of each half."""
    model = scene(KINDS["capsule"], TURNED, extra=PROBE.format(SPHERE))
    for degrees in (20.0, 160.0, -30.0, 200.0):
        data = touch(model, degrees, 0.02)
        ahead = np.cos(np.radians(degrees)) > 0.0
        front, back = (Skin(body="body", outward=(x, 0, 0), within=90).bind(model) for x in (1, -1))
        agree(front, data, lambda _, a=ahead: a, ahead)
        agree(back, data, lambda _, a=ahead: not a, not ahead)


def test_a_patch_in_a_region_ends_where_the_region_does():
    """2 set-ups: a touch below and above the region's end."""
    model = scene(KINDS["cylinder"], extra=PROBE.format(SPHERE))
    feel = Skin(body="body", around=(0, 0, 1), region=((-1, -1, -1), (1, 1, 0.015)), cell_area=1e-4).bind(model)
    assert feel.patch.positions[:, 2].max() < 0.015
    for height, expected in ((0.012, True), (0.018, False)):
        agree(feel, touch(model, 140.0, height), lambda _, e=expected: e, expected)


WHOLE_BOX = 'type="box" size=".1 .05 .03"'
ALL_OVER = {"region": ((-1, -1, -1), (1, 1, 1))}


@pytest.mark.parametrize("way", [{"outward": (0, 0, -1)}, {"outward": (1, 0, 0)}, ALL_OVER])
@pytest.mark.parametrize(
    "shapes",
    [  # drawn twice, side by side, over each other
        (WHOLE_BOX, WHOLE_BOX),
        ('type="box" size=".05 .05 .03" pos="-.05 0 0"', 'type="box" size=".05 .05 .03" pos=".05 0 0"'),
        ('type="box" size=".08 .05 .03" pos="-.02 0 0"', 'type="box" size=".07 .05 .03" pos=".03 0 0"'),
    ],
)
def test_shapes_that_share_faces_have_the_surface_of_their_union(shapes, way):
    """All are one box of 20 by 10 by 6 cm, and have its cells."""
    found = []
    for parts in ((WHOLE_BOX,), shapes):
        geoms = "".join(f"<geom {part}/>" for part in parts)
        model = mujoco.MjModel.from_xml_string(
            f"<mujoco><worldbody><body name='b'><freejoint/>{geoms}</body></worldbody></mujoco>"
        )
        feel = Skin(body="b", **way).bind(model)
        found.append(feel.layout.areas.sum())
        if "outward" in way:
            places = feel.layout.positions @ feel.rotation_to_body.T + feel.position_in_body
            out = np.array(way["outward"])
            assert places @ out == pytest.approx(np.abs(out) @ [0.1, 0.05, 0.03], abs=1e-9)
    assert found[1] == pytest.approx(found[0], rel=0.01)


@pytest.mark.parametrize(("probe", "height"), [(BALL, 0.0), (SPHERE, 0.049)])
def test_a_mesh_that_presses_and_a_touch_at_the_rim(probe, height):
    """2 set-ups: several contacts at once; a contact that is beyond the outermost cells."""
    model = scene(KINDS["box"], extra=PROBE.format(probe))
    data = touch(model, 0.0, height)
    agree(Skin(body="body", outward=(1, 0, 0)).bind(model), data, lambda _: True, True)


def test_a_height_field_below_a_box():
    """1 set-up."""
    ground = '<geom type="hfield" hfield="hills" pos="0 0 .935"/>'
    model = scene(KINDS["box"], ground=ground, gravity="0 0 -9.81")
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 20)
    assert data.ncon > 0
    feel = Skin(body="body", outward=(0, 0, -1)).bind(model)
    agree(feel, data, lambda c: abs(c.frame[2]) > 0.71, True)
    assert not Skin(body="body", outward=(0, 0, 1)).bind(model)(data).vectors.any()


def test_a_drawn_polygon_has_its_cells_and_touches_within():
    model = scene(KINDS["box"], extra=PROBE.format(SPHERE))
    drawn = [(-0.02, -0.03), (0.03, -0.03), (0.03, 0.03)]  # x is along the body's z, as its x points outward
    feel = Skin(body="body", outward=(1, 0, 0), polygon=drawn, cell_area=5e-6).bind(model)
    assert isinstance(feel.layout, SoleLayout)
    assert feel.layout.areas.sum() == pytest.approx(0.5 * 0.05 * 0.06, rel=0.1)
    for height, expected in ((0.02, True), (-0.015, False)):
        data = touch(model, 0.0, height)
        agree(feel, data, lambda _, e=expected: e, expected)


def halves(sign: int) -> tuple[str, str]:
    """The mesh and the body of one hand, the right one mirrored in y."""
    points = np.random.default_rng(3).normal(size=(20, 3)) * 0.03 * [1, sign, 1]
    quat = np.array([0.9, 0.1, 0.3, -0.2]) * [1, sign, 1, sign]
    turn = f'quat="{" ".join(f"{q:.17g}" for q in quat)}"'
    name = "left_hand" if sign > 0 else "right_hand"
    mesh = f'<mesh name="{name}" vertex="{" ".join(f"{c:.17g}" for p in points for c in p)}"/>'
    return (
        mesh,
        f"""<body name="{name}" pos="0 {0.2 * sign} 1"><joint/>
      <geom type="capsule" size=".03 .08" pos=".01 {0.02 * sign} 0" {turn}/>
      <geom type="box" size=".03 .02 .04" pos=".05 {0.03 * sign} .02" {turn}/>
      <geom type="ellipsoid" size=".03 .02 .05" pos="-.05 {-0.01 * sign} .03" {turn}/>
      <geom type="cylinder" size=".03 .05" pos="0 {0.05 * sign} -.04" {turn}/>
      <geom type="mesh" mesh="{name}" pos="0 0 .1"/></body>""",
    )


@pytest.mark.parametrize("way", [{"around": (0, 0, 1)}, {"outward": (1, 0.5, 0)}, {"outward": (0, 0, 1), "within": 90}])
def test_mirrored_bodies_have_mirrored_cells(way):
    (mesh, left) = halves(1)
    (other, right) = halves(-1)
    model = mujoco.MjModel.from_xml_string(f"""<mujoco><asset>{mesh}{other}</asset><worldbody><body name="torso"
      pos="0 0 1"><freejoint/><geom size=".01"/>{left}{right}</body></worldbody></mujoco>""")
    flip = np.array([1.0, -1.0, 1.0])
    mirrored = {k: v if k == "within" else np.array(v) * flip for k, v in way.items()}
    one = Skin(body="left_hand", **way).bind(model).patch
    two = Skin(body="right_hand", **mirrored).bind(model).patch
    assert np.allclose(one.positions * flip, two.positions, rtol=0.0, atol=1e-12)
    assert np.allclose(one.areas, two.areas, rtol=0.0, atol=1e-12)
    assert np.allclose(one.rotations * np.outer(flip, flip), two.rotations, rtol=0.0, atol=1e-12)


def test_mirrored_feet_have_mirrored_soles():
    corners = np.random.default_rng(5).uniform(-1, 1, (12, 2)) * [0.12, 0.05]

    def foot(sign):
        name = "left" if sign > 0 else "right"
        order = slice(None, None, sign)  # of another mesh file
        points = [f"{x} {sign * y} {z}" for x, y in corners[order] for z in (-0.03, 0.0)]
        return f'<mesh name="{name}" vertex="{" ".join(points)}"/>', (
            f'<body name="{name}_foot" pos="0 {0.1 * sign} .03"><freejoint/><geom type="mesh" mesh="{name}"/></body>'
        )

    (mesh, left) = foot(1)
    (other, right) = foot(-1)
    model = mujoco.MjModel.from_xml_string(
        f"<mujoco><asset>{mesh}{other}</asset><worldbody>{left}{right}</worldbody></mujoco>"
    )
    one, two = (Skin(body=f"{name}_foot").bind(model).patch for name in ("left", "right"))
    assert len(one) == len(two)
    assert np.abs(one.positions * [1, -1, 1] - two.positions).max() < 1e-12


TURNS = {"x": [-1, 1, 1], "z": [1, 1, -1], "all": [-1, -1, -1]}


@pytest.mark.parametrize("turn", TURNS)
@pytest.mark.parametrize("axes", [(0, 1, 2), (2, 0, 1)])
def test_a_body_mirrored_in_other_axes_has_mirrored_cells(axes, turn):
    """Frames of a right hand may be turned, and its mesh rounded elsewhere."""
    rng = np.random.default_rng(7)
    way = np.diag(np.array(TURNS[turn], dtype=float))[:, axes]
    if np.linalg.det(way) > 0.0:
        way[:, 0] *= -1.0
    points = rng.normal(size=(20, 3)) * [0.03, 0.02, 0.05]
    others = points @ way + 1e-7 * rng.normal(size=points.shape)

    def hand(name, corners):
        mesh = f'<mesh name="{name}" vertex="{" ".join(f"{c:.17g}" for p in corners for c in p)}"/>'
        return mesh, f'<body name="{name}"><joint/><geom type="mesh" mesh="{name}"/></body>'

    meshes, bodies = zip(hand("left_hand", points), hand("right_hand", others[::-1]), strict=True)
    text = f"<mujoco><asset>{''.join(meshes)}</asset><worldbody>{''.join(bodies)}</worldbody></mujoco>"
    model = mujoco.MjModel.from_xml_string(text)
    half = np.array([[-1.0, -1.0, 0.0], [1.0, 1.0, 1.0]])
    ends = np.sort(half @ way, axis=0)
    pairs = [
        ({"outward": (1, 0.5, 0.2)}, {"outward": np.array([1, 0.5, 0.2]) @ way}),
        ({"around": (0, 0, 1)}, {"around": np.array([0, 0, 1]) @ way}),
        ({"region": half}, {"region": ends}),
    ]
    for left, right in pairs:
        one, two = Skin(body="left_hand", **left).bind(model), Skin(body="right_hand", **right).bind(model)
        assert np.abs(one.patch.positions @ way - two.patch.positions).max() < 1e-12
        assert np.abs(one.patch.rotations[:, :, 2] @ way - two.patch.rotations[:, :, 2]).max() < 1e-12
        assert np.array_equal(one.patch.areas, two.patch.areas)
        assert two.layout.name == "right_hand"


def test_a_right_body_that_is_not_the_left_one_mirrored_has_cells_of_its_own():
    bodies = "".join(
        f'<body name="{name}"><joint/><geom type="box" size=".05 .02 {z}"/></body>'
        for name, z in (("left_hand", 0.03), ("right_hand", 0.0301))
    )
    model = mujoco.MjModel.from_xml_string(f"<mujoco><worldbody>{bodies}</worldbody></mujoco>")
    assert Skin(body="right_hand", outward=(0, 0, 1)).bind(model).position_in_body[2] == pytest.approx(0.0301)


@pytest.mark.parametrize("yaw", [0, 30, -30])
def test_a_yawed_foot_has_its_own_axes(yaw):
    model = mujoco.MjModel.from_xml_string(f"""<mujoco><worldbody><body name="foot" euler="0 0 {yaw}" pos="0 0 .03">
      <freejoint/><geom type="box" size=".1 .05 .03"/></body></worldbody></mujoco>""")
    feel = Skin(body="foot").bind(model)
    assert np.allclose(feel.rotation_to_body, np.eye(3), atol=1e-12)
    assert np.allclose(np.ptp(feel.layout.outline, axis=0), [0.2, 0.1])


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"outward": (1, 0, 0), "region": ((1, 1, 1), (2, 2, 2))}, "no surface lies there"),
        ({"outward": (0, 0, 1), "region": ((-1, -1, -1), (1, 1, 0))}, "no surface lies there"),
        ({"outward": (1, 0, 0), "region": ((-1, -1, 0), (1, 1, 0.002))}, "strip of 2.0 mm"),
        ({"around": (0, 0, 1), "region": ((-1, 0.0499, 0.02), (1, 1, 1)), "cell_area": 0.04}, "strip"),
        ({"region": ((0, 0, 0), (0, 1, 1))}, "is empty"),
        ({"outward": (1, 0, 0), "polygon": [(0, 0), (1, 1), (1, 0), (0, 1)]}, "crosses itself"),
        ({"outward": (1, 0, 0), "polygon": [(0.3, 0.3), (0.4, 0.3), (0.4, 0.4)]}, "no surface lies there"),
        ({"outward": (1, 0, 0), "polygon": [(-20, -30), (30, -30), (30, 30)]}, "reaches 30 m, .* 0.05 m; is it in m"),
        ({"outward": (1, 0, 0), "forward": (1, 0, 0)}, "given as forward"),
        ({"outward": (0, 0, 0)}, "not all 0"),
        ({"around": "z"}, "'around' is z"),
        ({"around": (0, 0, 1), "cell_area": 1e-7}, "give a larger cell_area"),
        ({"around": (0, 0, 1), "cell_area": 691.0}, r"a cell of 691 m\^2 is too large for its surface of 0.0[0-9]+ m"),
        ({"body": "probe", "geoms": ["other"], "around": (0, 0, 1)}, "no geom named 'other'"),
    ],
)
def test_wrong_patches_are_refused_in_one_line(options, words):
    model = scene(KINDS["box"], extra=PROBE.format(SPHERE))
    with pytest.raises(RobotError, match=words) as caught:
        Skin(**{"body": "body", **options}).bind(model)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("pitch", [36, 40, 50])
def test_a_sole_on_its_edge_is_refused(pitch):
    model = mujoco.MjModel.from_xml_string(f"""<mujoco><worldbody><body name="foot" euler="0 {pitch} 0" pos="0 0 .1">
      <freejoint/><geom type="box" size=".1 .05 .03"/></body></worldbody></mujoco>""")
    with pytest.raises(RobotError, match=f"turned by {min(pitch, 90 - pitch)} deg|turned by {pitch} deg"):
        Skin(body="foot").bind(model)


def test_arguments_that_exclude_each_other_are_refused(make_box):
    for options in (
        {"site": "a", "region": ((0, 0, 0), (1, 1, 1))},
        {"geoms": []},
        {"polygon": [(0, 0), (1, 0), (1, 1)]},
        {"outward": (1, 0, 0), "within": 0.0},
        {"outward": (1, 0, 0), "within": 181.0},
    ):
        with pytest.raises(InputError):
            Skin(body="foot", **options)


def test_a_second_skin_on_a_body_has_a_site_of_its_own(make_box):
    spec = mujoco.MjSpec.from_string(make_box())
    for k, skin in enumerate((Skin(body="foot"), Skin(body="foot", outward=(1, 0, 0)))):
        skin.edit(spec)
        assert spec.compile().nsite == k + 1
    with pytest.raises(RobotError, match="edit it once"):
        Skin(body="foot").edit(spec)
    Skin(body="foot", outward=(1, 0, 0), polygon=[(-0.01, -0.02), (0.01, -0.02), (0.0, 0.02)]).edit(spec)
    assert spec.compile().nsite == 2  # patches of one frame share its site
    assert spec.compile().site("foot_skin_2").pos == pytest.approx([0.12, 0.0, 0.0])


def test_a_patch_that_looks_to_all_sides_is_no_sole(make_box):
    model = mujoco.MjModel.from_xml_string(make_box())
    feel = Skin(body="foot", around=(0, 0, 1)).bind(model)
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 10)
    with pytest.raises(PlantarError, match="looks to all sides"):
        feel.percept(data)
    assert len(feel.patch) == len(feel)
    assert feel.patch.link == "foot"


def test_show_draws_what_is_bound_and_what_is_refused(tmp_path):
    model = scene(KINDS["two geoms"], extra=PROBE.format(SPHERE))
    bound = Skin(body="body", around=(0, 0, 1))
    figure = bound.show(model, tmp_path / "limb.png")
    assert (tmp_path / "limb.png").stat().st_size > 10_000
    assert f"{len(bound.bind(model))} taxels" in figure._suptitle.get_text()
    refused = Skin(body="body", region=((1, 1, 1), (2, 2, 2))).show(model)
    assert "no surface lies there" in refused._suptitle.get_text()
    assert len(refused.axes[0].patches) < len(figure.axes[0].patches)  # shapes alone
