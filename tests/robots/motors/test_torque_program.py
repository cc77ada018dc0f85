from dataclasses import replace

import numpy as np
import pytest

from plantar.common.sides import SIDES, Side
from plantar.mechanics.lip import GRAVITY
from plantar.mechanics.wrench_cone import Rectangle, cone_rows
from plantar.robots.kinematics.robot_model import build_leg_model
from plantar.robots.motors.body_dynamics import BodyDynamics
from plantar.robots.motors.torque_program import Standing, Wish, torques_of
from plantar.robots.robot_file import load_robot


class Body:
    """A robot near its posture, which moves a little."""

    def __init__(self, name: str, seed: int, feet: tuple[Side, ...]) -> None:
        robot, self.rng = load_robot(name), np.random.default_rng(seed)
        model = build_leg_model(robot).model
        dofs = np.array([model.joint(n).dofadr[0] for s in SIDES for n in robot.legs[s].joints])
        sites: dict[Side, int] = {s: model.site(robot.legs[s].sole_site).id for s in SIDES}
        self.dynamics = BodyDynamics(model, dofs, sites)
        configuration = np.array([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, *robot.posture["left"], *robot.posture["right"]])
        configuration[3:] += 0.05 * self.rng.normal(size=len(configuration) - 3)
        configuration[3:7] /= np.linalg.norm(configuration[3:7])
        self.dynamics.place(configuration)
        self.dynamics.move(0.3 * self.rng.normal(size=18))
        standing: dict[Side, Standing] = {}
        for side in feet:
            (x, y), (length, width) = robot.sole_rectangle(side)
            rotation = self.dynamics.data.site_xmat[sites[side]].reshape(3, 3).copy()
            sole = Rectangle(x - length, x + length, y - width, y + width)
            preferred = np.array([0.0, 0.0, 800.0 / len(feet), 0.0, 0.0, 0.0])
            standing[side] = Standing(rotation, sole, 0.6, self.rng.normal(size=6), preferred, 2000.0)
        weights = np.concatenate([np.zeros(3), np.full(3, 0.1), np.full(12, 1e-3)])
        bound = np.full(12, 100.0)
        wished, com = 5.0 * self.rng.normal(size=18), 0.3 * self.rng.normal(size=3)
        self.wish = Wish(wished, weights, com, 1.0, np.full(12, 300.0), -bound, bound, standing)


@pytest.mark.parametrize("feet", [("left",), ("right",), SIDES])
@pytest.mark.parametrize("name", ["h1", "hrp2kai"])
def test_all_constraints_hold_in_random_states(name, feet):
    for seed in range(10):
        body = Body(name, seed, feet)
        dynamics, wish = body.dynamics, body.wish
        found = torques_of(dynamics, wish, GRAVITY)
        turned = {}
        for side, wrench in found.wrenches.items():
            sole = wish.standing[side]
            assert (cone_rows(sole.rectangle, 0.6) @ wrench).max() < 1e-6
            moved = dynamics.soles[side] @ found.acceleration + dynamics.drifts[side]
            assert moved == pytest.approx(sole.acceleration, abs=1e-8)
            turned[side] = np.concatenate([sole.rotation @ wrench[:3], sole.rotation @ wrench[3:]])
        forces = dynamics.mass @ found.acceleration + dynamics.bias - sum(turned[s] @ dynamics.soles[s] for s in turned)
        assert np.abs(forces[:6]).max() < 1e-9 * 1000.0
        assert forces[6:] == pytest.approx(found.torques, abs=1e-9)
        assert np.abs(found.torques).max() <= 300.0 + 1e-8
        assert np.abs(found.acceleration[6:]).max() <= 100.0 + 1e-6


def test_a_body_on_two_soles_does_what_it_should():
    body = Body("h1", 1, SIDES)
    found = torques_of(body.dynamics, replace(body.wish, com_weight=1e4), GRAVITY)
    total = body.dynamics.mass[0, 0]
    com = (body.dynamics.mass[:3] @ found.acceleration + body.dynamics.bias[:3]) / total - [0.0, 0.0, GRAVITY]
    assert com == pytest.approx(body.wish.com, abs=1e-3)


def test_a_tight_torque_limit_holds():
    body = Body("h1", 2, SIDES)
    free = torques_of(body.dynamics, body.wish, GRAVITY)
    limits = np.full(12, 0.9 * np.abs(free.torques).max())
    found = torques_of(body.dynamics, replace(body.wish, torque=limits), GRAVITY)
    assert np.abs(found.torques).max() == pytest.approx(limits[0])


def test_what_cannot_be_has_no_solution():
    body = Body("h1", 3, SIDES)
    sinking = {s: replace(foot, acceleration=np.full(6, -500.0)) for s, foot in body.wish.standing.items()}
    weak = replace(body.wish, torque=np.full(12, 0.1), standing=sinking)
    assert torques_of(body.dynamics, weak, GRAVITY) is None
    assert torques_of(body.dynamics, replace(body.wish, com=np.full(3, np.nan)), GRAVITY) is None
