"""Test the written-out step of the legs against a solve of all rows."""

from functools import cache
from pathlib import Path

import mujoco
import numpy as np
import pytest

from stepaside.core.errors import ReachError
from stepaside.core.poses import Array
from stepaside.robots.description import RobotDescription, load_robot
from stepaside.robots.ik_solver import move_within, solver_of
from stepaside.robots.ik_step import trace_step
from stepaside.robots.leg_kinematics import BodyReference, LegKinematics
from stepaside.robots.tree_cache import load_tree
from synthetic_humanoid import synthetic_humanoid

NAO = load_robot("nao")
TICK = 0.004
FREE = {"nao": 11, "synthetic": 12}  # leg joints that are unknown


@cache
def stranger() -> RobotDescription:
    from tempfile import mkdtemp

    return synthetic_humanoid(Path(mkdtemp()))


@cache
def seven() -> RobotDescription:
    from tempfile import mkdtemp

    return synthetic_humanoid(Path(mkdtemp()), twists=True)


def robot(name: str) -> RobotDescription:
    return NAO if name == "nao" else stranger()


STANCE = BodyReference(
    (0.03, 0.0, 0.6), (0.02, 0.1, 0.0, 0.1), (-0.02, -0.1, 0.0, -0.05)
)


def anywhere(name: str, seed: int) -> tuple[float, ...]:
    """Arguments of the solver near a bent posture, and a request."""
    random = np.random.default_rng(seed)
    description = robot(name)
    solver = solver_of(description, load_tree(description))
    bent = [description.standing.get(n, 0.0) for n in solver.legs.free]
    angles = np.array(bent) + random.uniform(-0.2, 0.2, len(bent))
    torso = random.uniform(-1.0, 1.0, 4)
    asked = random.uniform(-0.5, 0.5, 15)
    return (*angles.tolist(), *torso.tolist(), *asked.tolist())


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("name", FREE)
def test_the_step_solves_all_rows(name: str, seed: int) -> None:
    description = robot(name)
    solver = solver_of(description, load_tree(description))
    arguments = anywhere(name, seed)
    error, jacobian = solver.linearise(*arguments)
    count = 4 + FREE[name]
    assert jacobian.shape == (count, count)
    formula = trace_step(solver.legs, description.standing)
    step = np.array(formula.function()(*arguments))
    np.testing.assert_allclose(jacobian @ step[:count], error, atol=1e-9)
    free = np.array(arguments[: FREE[name]])
    after = free + step[4:count]
    np.testing.assert_allclose(step[count + 4 :], after, atol=1e-15)
    x, y, z, heading = arguments[FREE[name] : FREE[name] + 4]
    c, s = np.cos(heading), np.sin(heading)
    u, v, w, turn = step[:4]
    torso = (x + c * u - s * v, y + s * u + c * v, z + w, heading + turn)
    assert step[count : count + 4] == pytest.approx(torso)


@pytest.mark.parametrize("name", FREE)
def test_the_rows_are_the_derivative_of_their_errors(name: str) -> None:
    """By central differences in every unknown, where all errors are 0."""
    description = robot(name)
    legs = LegKinematics(description, tick=TICK)
    z = 0.26 if name == "nao" else 0.6
    stance = STANCE._replace(com=(0.01, 0.01, z))
    if name == "nao":
        stance = stance._replace(
            left_foot=(0.01, 0.05, 0.0, 0.1),
            right_foot=(-0.01, -0.05, 0.0, -0.05),
        )
    legs.stand(stance)
    legs.track(stance)
    posture = legs.state[: FREE[name] + 4]
    arguments = np.array([*posture, *stance.row()])
    solver = solver_of(description, load_tree(description))
    error, jacobian = solver.linearise(*arguments.tolist())
    assert np.abs(error).max() < 1e-8
    count = FREE[name]
    heading = arguments[count + 3]
    c, s = np.cos(heading), np.sin(heading)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    for unknown in range(4 + count):
        change = np.zeros(arguments.size)
        if unknown < 3:
            change[count : count + 3] = turn[:, unknown]
        else:
            at = count + 3 if unknown == 3 else unknown - 4
            change[at] = 1.0
        ahead, behind = (
            solver.linearise(*(arguments + h * change).tolist())[0]
            for h in (1e-6, -1e-6)
        )
        slope = (behind - ahead) / 2e-6
        np.testing.assert_allclose(slope, jacobian[:, unknown], atol=1e-7)


def heading_of(legs: LegKinematics) -> float:
    posture = legs.posture
    return float(2.0 * np.arctan2(posture[6], posture[3]))


def turning(turns: int) -> list[BodyReference]:
    """Feet that turn in place, one after the other, 0.2 rad at a time."""
    requests = []
    left = right = 0.0
    for turn in range(turns):
        for i in range(50):
            yaw = 0.2 * (turn + (i + 1) / 50)
            left, right = (yaw, right) if turn % 2 else (left, yaw)
            requests.append(
                BodyReference(
                    (0.02, 0.0, 0.6),
                    (-0.1 * np.sin(left), 0.1 * np.cos(left), 0.0, left),
                    (0.1 * np.sin(right), -0.1 * np.cos(right), 0.0, right),
                )
            )
    return requests


@pytest.mark.parametrize("joints", [6, 7])
def test_with_independent_hip_yaws_the_torso_heading_is_the_mean_of_the_feet(
    joints: int,
) -> None:
    """It does not drift, however far they turn: more than once round."""
    description = stranger() if joints == 6 else seven()
    legs = LegKinematics(description, tick=0.02)
    requests = turning(33)
    legs.stand(requests[0])
    for request in requests:
        legs.track(request)
        middle = request.heading
        gap = np.remainder(heading_of(legs) - middle + np.pi, 2 * np.pi)
        assert gap - np.pi == pytest.approx(0.0, abs=1e-3)
    assert requests[-1].left_foot[3] > 2.0 * np.pi


def test_with_a_heading_row_feet_and_com_are_reached() -> None:
    """In MuJoCo's eyes."""
    description = stranger()
    legs = LegKinematics(description, tick=TICK)
    legs.stand(STANCE)
    legs.track(STANCE)
    model = description.compile()
    data = mujoco.MjData(model)
    posture = legs.posture
    data.qpos[: posture.size] = posture
    mujoco.mj_forward(model, data)
    torso = data.body("trunk").id
    assert data.subtree_com[torso] == pytest.approx(STANCE.com, abs=1e-7)
    for site, foot in (
        ("l_sole", STANCE.left_foot),
        ("r_sole", STANCE.right_foot),
    ):
        assert data.site(site).xpos == pytest.approx(foot[:3], abs=1e-7)
        axes = data.site(site).xmat.reshape(3, 3)
        assert np.arctan2(axes[1, 0], axes[0, 0]) == pytest.approx(foot[3])
        assert axes[2, 2] == pytest.approx(1.0)


def test_legs_that_are_not_plain_use_the_damped_step() -> None:
    """Seven joints a leg: no step is written out, the solve has to do."""
    description = seven()
    solver = solver_of(description, load_tree(description))
    assert solver.track_rows is None
    assert not solver.legs.is_plain and solver.legs.holds_heading
    legs = LegKinematics(description, tick=TICK)
    targets = legs.stand(STANCE)
    assert targets.size == len(legs.joint_names) == 16
    near = STANCE._replace(com=(0.031, 0.001, 0.599))
    for _ in range(3):
        legs.track(near)
    assert np.abs(legs.error).max() < 1e-6


def test_a_jump_of_the_whole_body_is_refused() -> None:
    """No joint would have to move for it."""
    legs = LegKinematics(NAO, tick=TICK)
    stance = BodyReference(
        (0.02, 0.0, 0.26), (0.0, 0.05, 0.0, 0.0), (0.0, -0.05, 0.0, 0.0)
    )
    legs.stand(stance)
    jumped = BodyReference(
        (0.62, 0.0, 0.26), (0.6, 0.05, 0.0, 0.0), (0.6, -0.05, 0.0, 0.0)
    )
    with pytest.raises(ReachError, match="off by 0.600"):
        legs.track(jumped)


def test_nan_and_inf_in_a_reference_are_refused() -> None:
    legs = LegKinematics(NAO, tick=TICK)
    stance = BodyReference(
        (0.02, 0.0, 0.26), (0.0, 0.05, 0.0, 0.0), (0.0, -0.05, 0.0, 0.0)
    )
    legs.stand(stance)
    with pytest.raises(ReachError, match="off by nan"):
        legs.track(stance._replace(com=(float("nan"), 0.0, 0.26)))


LIMITS = np.array([0.1, 0.1])


def bounded(error: tuple[float, ...], low: Array, high: Array) -> Array:
    """Two joints that lift the torso together, and a row for each unknown."""
    jacobian = np.eye(6)
    jacobian[2, 4:] = 1.0
    return move_within(jacobian, np.array(error), low, high, np.ones(2))


def test_within_its_limits_a_move_is_the_solution() -> None:
    move = bounded((0, 0, 0.2, 0, 0.05, 0.02), -LIMITS, LIMITS)
    assert move == pytest.approx([0, 0, 0.13, 0, 0.05, 0.02])


def test_other_joints_are_optimal_with_one_at_its_limit() -> None:
    """The torso moves as far as it then has to, not as if it had moved."""
    move = bounded((0, 0, 0.2, 0, 0.3, 0.02), -LIMITS, LIMITS)
    assert move == pytest.approx([0, 0, 0.08, 0, 0.1, 0.02])
    move = bounded((0, 0, 0.2, 0, 0.3, -0.4), -LIMITS, LIMITS)
    assert move == pytest.approx([0, 0, 0.2, 0, 0.1, -0.1])
