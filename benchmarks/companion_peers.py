r"""One tick of whole-body control compared with mink (velocities) and tsid on pinocchio (accelerations and torques).

    OMP_NUM_THREADS=1 python benchmarks/companion_peers.py        (writes benchmarks/companion_peers.md)

mink is one of the project's tools. tsid gets its own environment:

    python3.11 -m venv /tmp/tsid-venv
    /tmp/tsid-venv/bin/pip install --only-binary :all: tsid==1.7.1 pin==3.4.0 "cmeel-urdfdom<5" "cmeel-tinyxml2<11" \
        mink mujoco numpy scipy daqp quadprog
    PYTHONPATH=. OMP_NUM_THREADS=1 /tmp/tsid-venv/bin/python benchmarks/companion_peers.py

(The wheels of tsid 1.10.0 and of pin 4.0.0 or 4.1.0 do not fit each other: a RobotWrapper ends in a MemoryError.)
"""

import importlib
import importlib.metadata
import warnings
from pathlib import Path

import mujoco
import numpy as np

from plantar.bench.comparison import time_routes
from plantar.bench.tables import markdown_table
from plantar.common.atomic import write_text
from plantar.sim.companion.dynamics import MujocoDynamics
from plantar.sim.companion.machine import load_machine
from plantar.wholebody.fusion.hierarchical_qp import HierarchicalQP, JointLimits
from plantar.wholebody.fusion.hierarchy import fuse
from plantar.wholebody.stack import TaskStack
from plantar.wholebody.tasks.cartesian_pose import CartesianPose, PoseGains
from plantar.wholebody.tasks.center_of_mass import CenterOfMass
from plantar.wholebody.tasks.posture import Posture
from plantar.wholebody.tasks.support import Standing, Support

STATES = 50
"""Random states that are compared."""

ROUNDS = 2000
"""Ticks that are timed of each, in turn."""

HANDS = {"mobile-arm": "hand", "h1-body": "left_hand"}
"""Machines, and the link whose pose is held."""

FEET = ("left_foot", "right_foot")
"""Links that h1 stands on."""


_INTRO = """# A tick of whole-body control compared with tsid and mink

The same robot, state and two strict levels of tasks for all. A tick is everything from joint states to torques:
kinematics, dynamics, tasks and fusion. Results are compared first, then times.
"""

_READING = """`python benchmarks/companion_peers.py` measures it; its docstring shows how tsid gets an environment.
Medians of ticks in turn on one core.

- tsid and pinocchio are C++; Plantar is Python except for MuJoCo and one kernel. On a 9-joint arm calls dominate and
  tsid is faster; on a whole body both take about as long.
- tsid has two levels. Each further level costs Plantar about 10 us on an arm.
- "With limits" is `hierarchical_qp`: first solved on every level although no limit acts, then with a torque limit a
  tenth below the demand. Its shortcut costs 10 us where no limit acts.
"""


def library(name):
    """A library, or None after a line on how to get it."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return importlib.import_module(name)
    except (ImportError, AttributeError):
        print(f"{name} is missing and left out; see the docstring of {Path(__file__).name}")
        return None


class Case:
    """A machine, its stack of tasks, and random states of it near its posture."""

    def __init__(self, name, feet=()):
        machine = load_machine(name)
        self.name, self.feet, self.hand = name, feet, HANDS[name]
        self.model = machine.spec().compile()
        self.robot = MujocoDynamics(self.model)
        self.free = self.model.nq != self.model.nv
        self.posture = machine.posture
        self.limits = machine.efforts
        self.at_posture = self.model.qpos0.copy()
        self.at_posture[self.robot._places] = self.posture
        self.set_state(self.at_posture, np.zeros(self.model.nv))
        self.pose = CartesianPose(self.hand, gains=PoseGains(speed=100.0))
        self.pose.target_position = self.robot.pose(self.hand)[0] + [0.03, -0.02, 0.04]
        self.pose.target_rotation = self.robot.pose(self.hand)[1]
        self.com = CenterOfMass(self.robot.com()[0] + [0.0, 0.01, -0.01])
        self.held = Posture(self.posture)
        support = Support({f: Standing(f, np.zeros(3)) for f in feet}) if feet else None
        self.stack = TaskStack([[self.pose, self.com] if feet else [self.pose], [self.held]], support)

    def set_state(self, qpos, qvel):
        self.qpos, self.qvel = qpos.copy(), qvel.copy()
        self.robot.update(qpos, qvel, 0.0)

    def states(self, rng, count):
        for _ in range(count):
            qpos = self.at_posture.copy()
            mujoco.mj_integratePos(self.model, qpos, rng.uniform(-0.1, 0.1, self.model.nv), 1.0)
            yield qpos, rng.uniform(-0.3, 0.3, self.model.nv)

    def tick(self):
        self.robot.update(self.qpos, self.qvel, 0.0)
        return self.stack.step(self.robot)


def pinocchio_model(pin, model):
    """The same robot for pinocchio, joint by joint and link by link from the compiled MuJoCo model."""
    found = pin.Model()
    found.gravity = pin.Motion(np.array(model.opt.gravity), np.zeros(3))

    def rotation(quaternion):
        turn = np.zeros(9)
        mujoco.mju_quat2Mat(turn, quaternion)
        return turn.reshape(3, 3)

    places = {0: (0, pin.SE3.Identity())}  # of each body: its joint, and where it is in that joint's frame
    for body in range(1, model.nbody):
        parent, inside = places[int(model.body_parentid[body])]
        place = inside * pin.SE3(rotation(model.body_quat[body]), np.array(model.body_pos[body]))
        first = int(model.body_jntadr[body])
        for joint in range(first, first + int(model.body_jntnum[body])):
            kind, axis, name = int(model.jnt_type[joint]), np.array(model.jnt_axis[joint]), model.joint(joint).name
            anchor = np.array(model.jnt_pos[joint])
            if kind == mujoco.mjtJoint.mjJNT_FREE:
                parent = found.addJoint(parent, pin.JointModelFreeFlyer(), pin.SE3.Identity(), name)
                place = pin.SE3.Identity()
                continue
            revolute = kind == mujoco.mjtJoint.mjJNT_HINGE
            moving = pin.JointModelRevoluteUnaligned(axis) if revolute else pin.JointModelPrismaticUnaligned(axis)
            parent = found.addJoint(parent, moving, place * pin.SE3(np.eye(3), anchor), name)
            place = pin.SE3(np.eye(3), -anchor)
        mass, turn = float(model.body_mass[body]), rotation(model.body_iquat[body])
        inertia = turn @ np.diag(model.body_inertia[body]) @ turn.T
        found.appendBodyToJoint(parent, pin.Inertia(mass, np.array(model.body_ipos[body]), inertia), place)
        found.addBodyFrame(model.body(body).name, parent, place, 0)
        places[body] = (parent, place)
    return found


class Tsid:
    def __init__(self, tsid, pin, case):
        self.tsid, self.case, model = tsid, case, case.model
        kind = tsid.FLOATING_BASE_SYSTEM if case.free else tsid.FIXED_BASE_SYSTEM
        made = pinocchio_model(pin, model)
        base = 6 if case.free else 0
        names = [model.joint(j).name for j in range(model.njnt)]
        self.order = [made.joints[made.getJointId(n)].idx_v for n in names[1 if case.free else 0 :]]
        made.armature = np.zeros(made.nv)
        armature = made.armature
        armature[self.order] = model.dof_armature[base:]
        made.armature = armature
        self.robot = tsid.RobotWrapper(made, kind, False)
        self.formulation = tsid.InverseDynamicsFormulationAccForce("tsid", self.robot, False)
        self.base = base
        q, v = self.state()
        self.formulation.computeProblemData(0.0, q, v)
        self._add_tasks(pin)
        self.solver = tsid.SolverHQuadProgFast("solver")
        f = self.formulation
        self.solver.resize(f.nVar, f.nEq, f.nIn)

    def _add_tasks(self, pin):
        tsid, case, f = self.tsid, self.case, self.formulation
        self.contacts = []
        for foot in case.feet:
            # So large that no limit of the contact acts: the companion's hierarchy knows none.
            corners = np.array([[10.0, 10.0, -10.0, -10.0], [10.0, -10.0, 10.0, -10.0], [0.0] * 4])
            up = np.array([0.0, 0.0, 1.0])
            contact = tsid.Contact6d(f"on_{foot}", self.robot, foot, corners, up, 1e4, -1e7, 1e7)
            contact.setKp(np.zeros(6))
            contact.setKd(np.zeros(6))
            f.addRigidContact(contact, 1e-12, 1.0, 0)
            contact.setReference(self.robot.framePosition(f.data(), self.robot.model().getFrameId(foot)))
            self.contacts.append(contact)
        self.pose = tsid.TaskSE3Equality("pose", self.robot, case.hand)
        self.pose.useLocalFrame(False)
        f.addMotionTask(self.pose, 1.0, 0, 0.0)
        self.com = tsid.TaskComEquality("com", self.robot)
        if case.feet:
            f.addMotionTask(self.com, 1.0, 0, 0.0)
        self.posture = tsid.TaskJointPosture("posture", self.robot)
        f.addMotionTask(self.posture, 1e4, 1, 0.0)
        self.samples = tsid.TrajectorySample(12, 6), tsid.TrajectorySample(3), tsid.TrajectorySample(len(self.order))
        self.gains(0.0)

    def gains(self, share):
        """Feedback of the tasks: zero where references are compared, full where time is."""
        kinds = (self.pose, 6, 100.0), (self.com, 3, 50.0), (self.posture, len(self.order), 50.0)
        for task, size, stiffness in kinds:
            task.setKp(np.full(size, share * stiffness))
            task.setKd(np.full(size, share * 2.0 * np.sqrt(stiffness)))

    def state(self):
        """The case's state as pinocchio has it: quaternion last, the base's velocity in its own frame."""
        q, v = np.zeros(self.robot.nq), np.zeros(self.robot.nv)
        case = self.case
        if case.free:
            w, x, y, z = case.qpos[3:7]
            turn = np.zeros(9)
            mujoco.mju_quat2Mat(turn, case.qpos[3:7])
            self.turn = turn.reshape(3, 3)
            q[:7] = *case.qpos[:3], x, y, z, w
            v[:6] = *(self.turn.T @ case.qvel[:3]), *case.qvel[3:6]
        for i, at in enumerate(self.order):
            q[at + (1 if case.free else 0)] = case.qpos[i + (7 if case.free else 0)]
            v[at] = case.qvel[i + self.base]
        return q, v

    def refer(self, pose, com, posture):
        """Set the wanted accelerations of the tasks."""
        at, second, joints = self.samples
        home = np.eye(3)
        at.value(np.hstack([np.zeros(3), home.flatten("F")]))
        at.second_derivative(pose)
        self.pose.setReference(at)
        second.value(np.zeros(3))
        second.second_derivative(com)
        self.com.setReference(second)
        ordered = np.zeros(len(self.order))
        ordered[np.array(self.order) - self.base] = posture
        joints.value(np.zeros(len(self.order)))
        joints.second_derivative(ordered)
        self.posture.setReference(joints)

    def tick(self, q, v):
        data = self.formulation.computeProblemData(0.0, q, v)
        solution = self.solver.solve(data)
        return self.formulation.getAccelerations(solution), self.formulation.getActuatorForces(solution), solution

    def accelerations(self, q, v):
        """In MuJoCo's coordinates: the base's in the world, with what turning adds."""
        acceleration, torque, solution = self.tick(q, v)
        assert solution.status == 0, f"tsid: {self.case.name} {len(self.case.feet)} {solution.status}"
        found = np.zeros(self.case.model.nv)
        found[self.base :] = acceleration[self.order]
        if self.case.free:
            found[:3] = self.turn @ (acceleration[:3] + np.cross(v[3:6], v[:3]))
            found[3:6] = acceleration[3:6]
        return found, torque[np.array(self.order) - self.base]


def alternating(*calls):
    """Median time in us of each call, timed in turn."""
    routes = {str(i): lambda _, call=call: call() for i, call in enumerate(calls)}
    found = time_routes(routes, {name: [None] for name in routes}, ROUNDS, most=10.0)
    return [1e6 * found[name].median for name in routes]


def against_tsid(case, tsid, pin):
    """Largest differences of accelerations and torques as shares of the largest one, and times of a tick in us."""
    peer = Tsid(tsid, pin, case)
    worst = np.zeros(2)
    for qpos, qvel in case.states(np.random.default_rng(0), STATES):
        case.set_state(qpos, qvel)
        own = case.tick()
        wanted = [t.demand(case.robot, None).acceleration for t in (case.pose, case.com, case.held)]
        q, v = peer.state()
        peer.refer(*wanted)
        found, torque = peer.accelerations(q, v)
        worst[0] = max(worst[0], np.abs(found - own.acceleration).max() / np.abs(own.acceleration).max())
        if len(case.feet) < 2:  # two feet share what they push against each other in many ways
            worst[1] = max(worst[1], np.abs(torque - own.torque).max() / np.abs(own.torque).max())
    peer.gains(1.0)
    qp = TaskStack(case.stack.levels, case.stack.support, HierarchicalQP(wide_limits(case), shortcut=False))
    hold = HierarchicalQP(tight_limits(case, own.torque))
    held = TaskStack(case.stack.levels, case.stack.support, hold)

    def with_limits(stack):
        case.robot.update(case.qpos, case.qvel, 0.0)
        return stack.step(case.robot)

    plain = alternating(case.tick, lambda: peer.tick(q, v))
    limited = alternating(lambda: with_limits(qp), lambda: with_limits(held))
    assert hold.limited
    return worst, (*plain, *limited)


def wide_limits(case):
    count = len(case.robot.joints)
    return JointLimits(*(np.full(count, v) for v in (1e7, 1e7, -1e7, 1e7)))


def tight_limits(case, torque):
    """Torques of which the largest is out of reach, a tenth below what the hierarchy needs."""
    limits = wide_limits(case)
    return JointLimits(np.full(len(torque), 0.9 * np.abs(torque).max()), limits.velocity, limits.low, limits.high)


class Kinematic:
    """A robot whose mass is 1 everywhere: the hierarchy of accelerations is one of velocities then."""

    def __init__(self, robot):
        self.robot, size = robot, robot.model.nv
        self.mass_matrix, self.bias, self.joints = np.eye(size), np.zeros(size), np.arange(size)


def against_mink(case, mink):
    """Largest difference of velocities as a share of the largest one, and times of a tick in us."""
    from plantar.wholebody.tasks.task import Demand

    step = 0.01
    kinematic = Kinematic(case.robot)
    configuration = mink.Configuration(case.model)
    hand = mink.FrameTask(case.hand, "body", position_cost=1.0, orientation_cost=1.0)
    com = mink.ComTask(cost=1.0)
    feet = [mink.FrameTask(f, "body", position_cost=1.0, orientation_cost=1.0) for f in case.feet]
    posture = mink.PostureTask(case.model, cost=1.0)
    posture.set_target(case.at_posture)
    above = [hand, *feet, *([com] if case.feet else [])]
    eye = np.eye(case.model.nv)[case.robot.joints]
    shift = np.array([0.004, -0.002, 0.003])

    def set_targets():
        configuration.update(case.qpos)
        for task in (hand, *feet):
            task.set_target_from_configuration(configuration)
        moved = mink.SE3.from_translation(shift) @ configuration.get_transform_frame_to_world(case.hand, "body")
        hand.set_target(moved)
        com.set_target(case.robot.com()[0] + 0.5 * shift)

    def own():
        robot = case.robot
        robot.update(case.qpos, case.qvel, 0.0)
        zero, still = np.zeros(3), np.zeros(6)
        first = [Demand(robot.jacobian(case.hand), acceleration=np.concatenate([shift, zero]) / step)]
        if case.feet:
            first.append(Demand(robot.com()[1], acceleration=0.5 * shift / step))
        first += [Demand(robot.jacobian(f), acceleration=still) for f in case.feet]
        home = (case.posture - robot.joint_positions) / step
        return fuse(kinematic, [first, [Demand(eye, acceleration=home)]]).acceleration

    def other(solver="daqp"):
        configuration.update(case.qpos)
        return mink.solve_ik(configuration, [posture], step, solver, limits=[], constraints=above)

    worst = 0.0
    for qpos, qvel in case.states(np.random.default_rng(0), STATES):
        case.set_state(qpos, qvel)
        set_targets()
        mine, found = own(), other("quadprog")
        worst = max(worst, np.abs(mine - found).max() / np.abs(mine).max())
    return worst, alternating(own, other)


def main():
    cases = [Case("mobile-arm"), Case("h1-body", FEET[:1]), Case("h1-body", FEET)]
    pin, mink = library("pinocchio"), library("mink")
    tsid = library("tsid.tsid_pywrap") if pin else None
    lines = [_INTRO]
    if tsid:
        lines += torque_table(cases, tsid, pin)
    if mink:
        lines += velocity_table(cases, mink)
    lines += [_READING]
    text = "\n".join(lines)
    print(text)
    if tsid and mink:
        write_text(Path(__file__).with_suffix(".md"), text + "\n")


def named(case):
    standing = f", on {len(case.feet)} feet" if len(case.feet) > 1 else ", on one foot" if case.feet else ""
    return f"{case.name} ({case.model.nv} coordinates{standing})"


def torque_table(cases, tsid, pin):
    version = f"tsid {importlib.metadata.version('tsid')}, pinocchio {pin.__version__}"
    head = ("robot", "accelerations differ by", "torques by", "tick", "tsid", "with limits, none acts", "one acts")
    lines = []
    for case in cases:
        (a, t), times = against_tsid(case, tsid, pin)
        torque = f"{t:.0e}" if len(case.feet) < 2 else "-"
        lines.append((named(case), f"{a:.0e}", torque, *(f"{taken:.0f} us" for taken in times)))
    return [f"## Torques: {version}", "", markdown_table(head, lines), ""]


def velocity_table(cases, mink):
    title = f"## Velocities: mink {importlib.metadata.version('mink')}, compared by quadprog, timed with daqp"
    lines = []
    for case in cases:
        worst, (own, peer) = against_mink(case, mink)
        lines.append((named(case), f"{worst:.0e}", f"{own:.0f} us", f"{peer:.0f} us"))
    return [title, "", markdown_table(("robot", "velocities differ by", "tick", "mink"), lines), ""]


if __name__ == "__main__":
    main()
