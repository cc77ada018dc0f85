"""Placing a skin on a body: frames found from geometry, wrong set-ups refused, physics untouched."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest

from plantar import hex_layout, mirrored, write_layout
from plantar.errors import InputError, LayoutError, PlantarError, RobotError
from plantar.mujoco import Skin

OUTLINE = [[-0.08, -0.035], [0.16, -0.05], [0.17, 0.02], [0.1, 0.04], [-0.08, 0.03]]
SOLE = hex_layout(OUTLINE, name="shoe")


def two_feet(extra: str = "") -> mujoco.MjModel:
    """Two feet of the shape of the sole, the left one turned in its body's frame."""
    vertices = " ".join(f"{x} {y} {z}" for x, y in OUTLINE for z in (-0.03, 0.0))
    other = " ".join(f"{x} {-y} {z}" for x, y in OUTLINE for z in (-0.03, 0.0))
    return mujoco.MjModel.from_xml_string(f"""<mujoco><asset><mesh name="left" vertex="{vertices}"/>
      <mesh name="right" vertex="{other}"/></asset><worldbody><geom name="floor" type="plane" size="1 1 1"/>
      <body name="left_foot" pos="0 .1 .03"><freejoint/><geom name="left" type="mesh" mesh="left" mass="1"/>
        <geom name="looks" type="box" size=".2 .2 .2" contype="0" conaffinity="0" mass="0"/>
        <site name="good" pos="0 0 -.03"/><site name="upside_down" pos="0 0 -.03" euler="180 0 0"/>
        <site name="tilted" pos="0 0 -.03" euler="0 45 0"/><site name="turned" pos="0 0 -.03" euler="0 0 90"/>
        <site name="high" pos="0 0 0"/><site name="aside" pos=".1 .05 -.03"/></body>
      <body name="right_foot" pos="0 -.1 .03"><freejoint/><geom name="right" type="mesh" mesh="right" mass="1"/>
        <site name="others" pos="0 0 -.03"/>{extra}</body>
      <body name="pelvis" pos="0 0 1"><freejoint/><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/></body>
      </worldbody></mujoco>""")


def scaled(layout, factor):
    return replace(
        layout,
        positions=layout.positions * factor,
        vertices=layout.vertices * factor,
        outline=layout.outline * factor,
        areas=layout.areas * factor**2,
    )


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"body": "left_fot"}, "did you mean left_foot"),
        ({"body": "pelvis"}, "no geom that collides; bodies that have: left_foot, right_foot"),
        ({"body": "world"}, "fixed to the world"),
        ({"geoms": ["sole"]}, "no geom named 'sole'"),
        ({"geoms": ["right"]}, "is on body 'right_foot'"),
        ({"geoms": ["looks"]}, "collides with nothing"),
        ({"site": "missing"}, "no site named 'missing'"),
        ({"site": "others"}, "is on body 'right_foot'"),
        ({"site": "upside_down"}, "upside down"),
        ({"site": "tilted"}, "tilted by 45 deg"),
        ({"site": "turned"}, "turned by 270 deg"),
        ({"site": "high"}, "30 mm above the sole"),
        ({"site": "aside"}, "lie beside the sole|would fit"),
        ({"layout": scaled(SOLE, 4.0)}, "is its unit right"),
        ({"layout": scaled(SOLE, 1.3)}, "lie beside the sole"),
        ({"layout": scaled(SOLE, 0.5)}, "covers 2. % of the sole"),
        ({"layout": mirrored(SOLE)}, "is of the right foot"),
        ({"layout": replace(mirrored(SOLE), side="left")}, "would fit mirrored"),
        ({"body": "right_foot"}, "is of the left foot"),
        ({"forward": (-1, 0, 0)}, "turned by 180 deg"),
        ({"forward": (0, 0, 1)}, "faces the way"),
        ({"forward": (0, 0, 0)}, "not all 0"),
        ({"outward": "down"}, "'outward' is down; expected three numbers"),
    ],
)
def test_what_geometry_shows_to_be_wrong_is_refused_in_one_line(options, words):
    options = {"layout": SOLE, "body": "left_foot", **options}
    with pytest.raises(RobotError, match=words) as caught:
        Skin(**options).bind(two_feet())
    assert "\n" not in str(caught.value)


def test_bodies_that_sleep_have_no_contacts_to_read():
    spec = mujoco.MjSpec.from_string("""<mujoco><option><flag sleep="enable"/></option><worldbody>
      <geom type="plane" size="1 1 .1"/><body name="foot" pos="0 0 .02"><freejoint/>
      <geom type="box" size=".12 .05 .02"/></body></worldbody></mujoco>""")
    with pytest.raises(RobotError, match="lets bodies sleep"):
        Skin(body="foot").bind(spec.compile())


def test_arguments_are_checked_when_it_is_made(tmp_path):
    down = replace(SOLE, rotations=SOLE.rotations * [[1], [-1], [-1]])
    for options, error in [
        ({}, InputError),
        ({"body": "a", "geoms": "b"}, InputError),
        ({"body": "a", "geoms": 3}, InputError),
        ({"body": "a", "proximity": 0.0}, InputError),
        ({"body": "a", "proximity": True}, InputError),
        ({"body": "a", "layout": down}, LayoutError),
        ({"body": "a", "layout": tmp_path / "none.json"}, LayoutError),
        ({"body": "a", "layout": 3}, PlantarError),
        ({"body": "a", "reach": -1.0}, InputError),
    ]:
        with pytest.raises(error):
            Skin(**options)
    with pytest.raises(InputError, match=r"mujoco\.MjModel"):
        Skin(body="a").bind("model.xml")
    with pytest.raises(InputError, match="expected a MjSpec"):
        Skin(body="a").edit(two_feet())
    with pytest.raises(InputError, match="cell area"):
        Skin(body="left_foot", cell_area=0.0).bind(two_feet())


def test_a_right_layout_is_accepted_in_every_form(tmp_path):
    model = two_feet()
    for layout in (SOLE, write_layout(SOLE, tmp_path / "left.json"), str(tmp_path / "left.json")):
        assert len(Skin(layout, "left_foot").bind(model)) == len(SOLE)
    assert len(Skin(SOLE, "left_foot", site="good").bind(model)) == len(SOLE)
    assert len(Skin(mirrored(SOLE), "right_foot").bind(model)) == len(SOLE)
    half = hex_layout([[0.1, -0.04], [0.16, -0.05], [0.16, 0.02], [0.1, 0.02]], cell_area=2e-4)
    assert len(Skin(half, "left_foot", partial=True).bind(model)) == len(half)


@pytest.mark.parametrize("turn", [(0, 0, 0), (30, 40, 50), (180, 0, 0), (90, 0, 90)])
def test_the_frame_follows_the_shape_however_the_body_is_turned(turn):
    """The same foot with another frame of its body: the sole frame in the world is the same."""
    rotation, quat = np.empty(9), np.empty(4)
    mujoco.mju_euler2Quat(quat, np.radians(turn), "xyz")
    mujoco.mju_quat2Mat(rotation, quat)
    inverse = quat * [1, -1, -1, -1]
    model = mujoco.MjModel.from_xml_string(f"""<mujoco><worldbody><body name="foot" pos="0 0 .2"
      quat="{" ".join(map(str, quat))}"><freejoint/><geom type="box" size=".1 .05 .03" mass="1"
      quat="{" ".join(map(str, inverse))}"/></body></worldbody></mujoco>""")
    feel, data = Skin(body="foot").bind(model), mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    pose = feel.pose(data)
    assert np.allclose(pose.rotation_sole_to_world, np.eye(3), atol=1e-9)
    assert np.allclose(pose.position_in_world, [0.0, 0.0, 0.17], atol=1e-9)


def test_physics_are_the_same_to_the_last_bit(make_box):
    paths = []
    for skinned in (False, True):
        spec = mujoco.MjSpec.from_string(make_box(4, 'cone="elliptic"'))
        skin = Skin(body="foot", proximity=0.05)
        if skinned:
            skin.edit(spec)
        model = spec.compile()
        feel, data, path = skin.bind(model), mujoco.MjData(model), []
        for _ in range(200):
            mujoco.mj_step(model, data)
            path.append(np.concatenate([data.qpos, data.qvel, data.qacc]))
            if skinned:
                feel(data)
        paths.append(np.array(path))
    assert np.array_equal(*paths)


@pytest.mark.parametrize("defaults", ["", '<default><site euler="0 0 90"/></default>'])
def test_edit_shows_the_sole_frame(make_box, defaults):
    spec = mujoco.MjSpec.from_string(make_box().replace("<option", f"{defaults}<option"))
    skin = Skin(body="foot")
    skin.edit(spec)
    model = spec.compile()
    feel, data = skin.bind(model), mujoco.MjData(model)
    mujoco.mj_step(model, data, 10)
    assert np.allclose(data.site("foot_skin").xpos, feel.pose(data).position_in_world)
    assert np.allclose(data.site("foot_skin").xmat.reshape(3, 3), feel.pose(data).rotation_sole_to_world)
    with pytest.raises(RobotError, match="edit it once"):
        skin.edit(spec)


def test_outward_takes_another_face():
    model = mujoco.MjModel.from_xml_string("""<mujoco><worldbody><body name="pad"><freejoint/>
      <geom type="box" size=".01 .02 .03" mass="1"/></body></worldbody></mujoco>""")
    feel = Skin(body="pad", outward=(1, 0, 0)).bind(model)
    assert np.allclose(feel.position_in_body, [0.01, 0, 0])
    assert np.allclose(feel.rotation_to_body[:, 2], [-1, 0, 0])
    assert np.allclose(np.ptp(feel.layout.outline, axis=0), [0.06, 0.04])  # z of the world is forward here


def test_bodies_that_are_fixed_to_it_belong_to_it():
    model = mujoco.MjModel.from_xml_string("""<mujoco><worldbody><body name="foot"><freejoint/>
      <geom type="box" size=".1 .05 .03" mass="1"/><body name="toe" pos=".15 0 0" euler="0 0 90">
      <geom type="box" size=".05 .05 .03" mass="1"/><site name="sole" pos="0 .05 -.03" euler="0 0 -90"/></body></body>
      </worldbody></mujoco>""")
    feel = Skin(body="foot").bind(model)
    assert len(feel.geom_ids) == 2
    assert np.isclose(np.ptp(feel.layout.outline[:, 0]), 0.3)
    of_toe = Skin(body="foot", site="sole").bind(model)
    assert np.allclose(of_toe.position_in_body, [0.1, 0.0, -0.03])
    assert np.allclose(of_toe.rotation_to_body, np.eye(3))


def test_a_foot_has_the_side_of_its_name_or_else_of_its_place_on_its_robot():
    """Three robots, one of them right of the world's x axis and one that faces back."""
    robots = "".join(
        f'''<body name="{name}" pos="{at}" euler="0 0 {turn}"><freejoint/><geom size=".05"/>
        <body name="{name}/left_foot" pos="0 .1 -.4"><joint/><geom type="box" size=".1 .05 .02"/></body>
        <body name="{name}/paw" pos="0 -.1 -.4"><joint/><geom type="box" size=".1 .05 .02"/></body></body>'''
        for name, at, turn in (("r", "0 2 1", 0), ("s", "0 -2 1", 0), ("t", "0 0 1", 180))
    )
    model = mujoco.MjModel.from_xml_string(f"<mujoco><worldbody>{robots}</worldbody></mujoco>")
    for robot in "rst":
        assert Skin(body=f"{robot}/left_foot").bind(model).layout.side == "left"
        assert Skin(body=f"{robot}/paw", forward=(1, 0, 0)).bind(model).layout.side == "right"


@pytest.mark.parametrize("mass", [0.01, 1.0, 1e3])
def test_a_percept_counts_the_load_of_a_light_and_of_a_heavy_body(mass):
    model = mujoco.MjModel.from_xml_string(f"""<mujoco><worldbody><geom type="plane" size="1 1 .1"/>
      <body name="foot" pos="0 0 .02"><freejoint/><geom type="box" size=".12 .05 .02" mass="{mass}"/></body>
      </worldbody></mujoco>""")
    feel, data = Skin(body="foot").bind(model), mujoco.MjData(model)
    mujoco.mj_step(model, data, 500)
    assert feel.percept(data).vertical_force == pytest.approx(9.81 * mass, rel=1e-3)
    assert feel.layout.force_threshold <= 0.15 * 9.81


def test_a_model_without_a_body_that_collides_is_refused():
    spec = mujoco.MjSpec.from_string(
        '<mujoco><worldbody><body name="foot"><freejoint/><geom size=".1" contype="0" conaffinity="0"/></body>'
        "</worldbody></mujoco>"
    )
    with pytest.raises(RobotError, match="bodies that have: none"):
        Skin(body="foot").edit(spec)
